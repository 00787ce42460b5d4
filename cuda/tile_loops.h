// What one tile does, for each kind of launch.
#pragma once

#include "kernels/neighbours/search_neighbours.h"
#include "team_over_candidates.h"
#include "team_over_neighbours.h"

namespace loam {

template <class Stage, class Team> LOAM_FN void visit_one(const Stage &stage, Team &team, int visit) {
  team.open(visit);
  stage(team, visit);
  team.close();
}

template <class Stage, class Team>
LOAM_FN void visit_block(const Stage &stage, Team &team, const TileBlocks &blocks, int k) {
  const int entry = blocks.order[k], last = blocks.starts[entry + 1];
  for (int visit = blocks.starts[entry]; visit < last; ++visit) visit_one(stage, team, visit);
}

template <class Team> LOAM_FN void search_one(const CountNeighbours &stage, Team &team, int particle) {
  stage(team, particle);
}
template <class Team> LOAM_FN void search_one(const FillNeighbours &stage, Team &team, int v) {
  const Visit visit = team.d.visits[v];
  team.open_visit(visit);
  stage(team, visit.particle);
}

} // namespace loam
