// The launches of all stages over neighbours, as plain function pointers: their kernels are compiled by themselves, in tile_launches.cu.
#pragma once

#include <cuda_runtime_api.h>

#include "solver/stages.h"
#include "tile_views.h"

namespace loam {

// Which visits: those from `first` on, or, for stages whose visits are ordered, those of `blocks`.
struct TileWork {
  TileBlocks blocks;
  int first;
  int count; // visits or blocks
};

struct TileLaunches {
  using TeamLaunch = void (*)(const void *stage, const TilePairs &pairs, const TileWork &work, cudaStream_t stream);
  using CandidateLaunch = void (*)(const void *stage, const TileCandidates &candidates, int count, cudaStream_t stream);
  TeamLaunch team[Length<TeamStages>::value];
  CandidateLaunch candidate[Length<CandidateStages>::value];
};

extern const TileLaunches tile_launches;

} // namespace loam
