#include "tile_launches.h"

#include "device.h"
#include "tile.cuh"
#include "tile_loops.h"
#include "tile_width.h"

namespace loam {

namespace {

constexpr int threads = 128;

template <int W> __device__ __forceinline__ int tile_index() {
  return static_cast<int>(blockIdx.x * (threads / W) + threadIdx.x / W);
}

template <class Stage>
__global__ void __launch_bounds__(threads) all_visits(const Stage stage, const TilePairs pairs, int first, int count) {
  constexpr int W = tile_width<Stage>;
  const int k = tile_index<W>();
  if (k >= count) return; // whole tiles
  TeamOverNeighbours<Tile<W>> team(pairs, Tile<W>::of_this_thread());
  visit_one(stage, team, first + k);
}

template <class Stage>
__global__ void __launch_bounds__(threads)
    blocks_in_turn(const Stage stage, const TilePairs pairs, const TileBlocks blocks) {
  constexpr int W = tile_width<Stage>;
  const int k = tile_index<W>();
  if (k >= blocks.count) return;
  TeamOverNeighbours<Tile<W>> team(pairs, Tile<W>::of_this_thread());
  visit_block(stage, team, blocks, k);
}

template <class Stage>
__global__ void __launch_bounds__(threads) over_candidates(const Stage stage, const TileCandidates candidates, int count) {
  constexpr int W = search_tile_width;
  const int k = tile_index<W>();
  if (k >= count) return;
  TeamOverCandidates<Tile<W>> team(candidates, Tile<W>::of_this_thread());
  search_one(stage, team, k);
}

unsigned grid_for(int tiles, int width) {
  const int per_group = threads / width;
  return static_cast<unsigned>((tiles + per_group - 1) / per_group);
}

template <class Stage>
void launch_team(const void *data, const TilePairs &pairs, const TileWork &work, cudaStream_t stream) {
  if (work.count == 0) return;
  const Stage &stage = *static_cast<const Stage *>(data);
  const unsigned grid = grid_for(work.count, tile_width<Stage>);
  if constexpr (InTurn<Stage>::value)
    blocks_in_turn<<<grid, threads, 0, stream>>>(stage, pairs, work.blocks);
  else
    all_visits<<<grid, threads, 0, stream>>>(stage, pairs, work.first, work.count);
  check_cuda(cudaGetLastError(), "launching a stage over neighbours");
}

template <class Stage>
void launch_candidates(const void *data, const TileCandidates &candidates, int count, cudaStream_t stream) {
  if (count == 0) return;
  over_candidates<<<grid_for(count, search_tile_width), threads, 0, stream>>>(*static_cast<const Stage *>(data), candidates,
                                                                              count);
  check_cuda(cudaGetLastError(), "launching a stage over candidates");
}

template <class... T, class... C> TileLaunches make_launches(TypeList<T...>, TypeList<C...>) {
  TileLaunches launches = {};
  int team = 0, candidate = 0;
  ((launches.team[team++] = &launch_team<T>), ...);
  ((launches.candidate[candidate++] = &launch_candidates<C>), ...);
  return launches;
}

} // namespace

const TileLaunches tile_launches = make_launches(TeamStages(), CandidateStages());

} // namespace loam
