// All stages over neighbours, for one instruction set. The build compiles this file once for each, with LOAM_INSTRUCTION_SET naming the
// namespace, LOAM_PACK_WIDTH the lanes, and the compiler flags to match. Nothing here may leave a symbol that another copy could share.
#include "cpu/kernel_table.h"
#include "cpu/team_over_candidates.h"
#include "cpu/team_over_cells.h"

namespace loam::LOAM_INSTRUCTION_SET {

namespace {

template <class Stage> void launch_team(const void *stage, const CpuPairs &pairs, int first, int last) {
  const Stage kernel = *static_cast<const Stage *>(stage);
  TeamOverCells team{pairs};
  for (int b = first; b < last; ++b) kernel(team, b);
}

template <class Stage> void launch_candidates(const void *stage, const CpuCandidates &candidates, int first, int last) {
  const Stage kernel = *static_cast<const Stage *>(stage);
  TeamOverCandidates team(candidates);
  for (int i = first; i < last; ++i) kernel(team, i);
}

template <class... T, class... C> constexpr KernelTable make_table(TypeList<T...>, TypeList<C...>) {
  return {LOAM_PACK_WIDTH, {&launch_team<T>...}, {&launch_candidates<C>...}};
}

constexpr KernelTable table = make_table(TeamStages(), CandidateStages());

} // namespace

const KernelTable *get_table();
const KernelTable *get_table() { return &table; }

} // namespace loam::LOAM_INSTRUCTION_SET
