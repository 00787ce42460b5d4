// Neighbour search, in two passes over the candidates of the 27 cells around a particle: count, then (when the lists have their places)
// fill. Nothing is written before it is known that it fits.
//
// Close pairs, which position correction looks at, stand first in a list. In turn-by-turn solving each close pair has one owner: the lower index
// where the indices' sum is even, the higher one where it is odd, which spreads the work evenly.
#pragma once

#include "math/vector.h"

namespace loam {

struct CandidateTest {
  float support_squared;
  float close_squared; // 0: no position correction
  bool shared;         // close pairs stand in both lists

  template <class Team, class K> LOAM_FN auto near(Team &team, K k, typename Team::Lane squared) const {
    return both(squared < typename Team::Lane(support_squared), team.other(k));
  }
  template <class Team, class K, class M> LOAM_FN auto close(Team &team, K k, typename Team::Lane squared, M near) const {
    const auto pair = both(near, squared < typename Team::Lane(close_squared));
    return shared ? pair : both(pair, team.owned(k));
  }
};

struct CountNeighbours {
  CandidateTest test;
  int *neighbour_counts;
  int *close_counts;

  template <class Team> LOAM_FN void operator()(Team &team, int i) const {
    int total = 0, close = 0;
    for (auto k : team.candidates(i)) {
      const auto squared = team.distance_squared(k);
      const auto near = test.near(team, k, squared);
      total += team.count(near);
      close += team.count(test.close(team, k, squared, near));
    }
    team.store(neighbour_counts, i, total);
    team.store(close_counts, i, close);
  }
};

struct FillNeighbours {
  CandidateTest test;
  const int *neighbour_counts;
  const int *close_counts;

  template <class Team> LOAM_FN void operator()(Team &team, int i) const {
    team.open_list(i, neighbour_counts[i], close_counts[i]);
    for (auto k : team.candidates(i)) {
      const auto squared = team.distance_squared(k);
      const auto near = test.near(team, k, squared);
      if (!any(near)) continue;
      const auto close = test.close(team, k, squared, near);
      team.append(k, near, close);
    }
    team.close_list(i);
  }
};

} // namespace loam
