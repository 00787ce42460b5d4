// All stages over neighbours, for one instruction set. The build compiles this file once for each, with LOAM_INSTRUCTION_SET naming the
// namespace, LOAM_PACK_WIDTH the lanes, and the compiler flags to match. Nothing here may leave a symbol that another copy could share.
#include "cpu/interleave_lists.h"
#include "cpu/kernel_table.h"
#include "cpu/team_over_candidates.h"
#include "cpu/team_over_cells.h"
#include "cpu/team_over_constraints.h"

namespace loam::LOAM_INSTRUCTION_SET {

namespace {

template <class Stage> void launch_team(const void *stage, const CpuPairs &pairs, int first, int last) {
  const Stage kernel = *static_cast<const Stage *>(stage);
  TeamOverCells team{pairs};
  for (int b = first; b < last; ++b) kernel(team, b);
}

void launch_search(const FindNeighbours &stage, const CpuCandidates &candidates, const int *particles, int count) {
  const FindNeighbours kernel = stage;
  TeamOverCandidates team(candidates);
  for (int i = 0; i < count; ++i) kernel(team, particles[i]);
}

void launch_interleave(const CpuInterleaving &views, int first_batch, int last_batch) {
  interleave_lists(views, first_batch, last_batch);
}

template <class Stage> void launch_constraints(const void *stage, int first, int last) {
  const Stage kernel = *static_cast<const Stage *>(stage);
  TeamOverConstraints team;
  for (int b = first; b < last; ++b) kernel(team, b);
}

template <class... T, class... S> constexpr KernelTable make_table(TypeList<T...>, TypeList<S...>) {
  return {LOAM_PACK_WIDTH, {&launch_team<T>...}, &launch_search, &launch_interleave, {&launch_constraints<S>...}};
}

constexpr KernelTable table = make_table(TeamStages(), ConstraintStages());

} // namespace

const KernelTable *get_table();
const KernelTable *get_table() { return &table; }

} // namespace loam::LOAM_INSTRUCTION_SET
