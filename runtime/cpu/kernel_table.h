// The launches of all stages for one instruction set, as plain function pointers.
#pragma once

#include "cpu/cpu_views.h"
#include "solver/stages.h"

namespace loam {

struct KernelTable {
  using TeamLaunch = void (*)(const void *stage, const CpuPairs &pairs, int first_batch, int last_batch);
  using SearchLaunch = void (*)(const FindNeighbours &stage, const CpuCandidates &candidates, const int *particles,
                                int count);
  using InterleaveLaunch = void (*)(const CpuInterleaving &views, int first_batch, int last_batch);
  using ConstraintLaunch = void (*)(const void *stage, int first_batch, int last_batch);
  int width;
  TeamLaunch team[Length<TeamStages>::value];
  SearchLaunch search;
  InterleaveLaunch interleave;
  static constexpr int constraint_stages = Length<ConstraintStages>::value;
  ConstraintLaunch constraint[constraint_stages > 0 ? constraint_stages : 1];
};

// Null where the instruction set is not part of this build or not of this machine. `instruction_set` is a LOAM_INSTRUCTION_SET_* other than
// AUTO.
const KernelTable *kernel_table(unsigned instruction_set);

// The widest that this machine has.
unsigned best_instruction_set();
const char *instruction_set_name(unsigned instruction_set);

} // namespace loam
