#include "tile_launches.h"

#include "device.h"
#include "tile.cuh"
#include "tile_loops.h"
#include "tile_width.h"

namespace loam {

namespace {

// Threads of a group. Blocks of one colour are few: small groups spread them over all multiprocessors.
constexpr int search_threads = 128;
template <class Stage> constexpr int stage_threads = !InTurn<Stage>::value ? 128 : tile_width<Stage> > 1 ? 64 : 32;

template <int Threads, int W> __device__ __forceinline__ int tile_index() {
  return static_cast<int>(blockIdx.x * (Threads / W) + threadIdx.x / W);
}
template <int Threads, int W> unsigned groups_for(int tiles) {
  constexpr int per_group = Threads / W;
  return static_cast<unsigned>((tiles + per_group - 1) / per_group);
}

template <class Stage>
__global__ void __launch_bounds__(stage_threads<Stage>)
    all_visits(const Stage stage, const TilePairs pairs, int first, int count) {
  constexpr int W = tile_width<Stage>;
  const int k = tile_index<stage_threads<Stage>, W>();
  if (k >= count) return; // whole tiles
  TeamOverNeighbours<Tile<W>> team(pairs, Tile<W>::of_this_thread());
  visit_one(stage, team, first + k);
}

template <class Stage>
__global__ void __launch_bounds__(stage_threads<Stage>, 1)
    blocks_in_turn(const Stage stage, const TilePairs pairs, const TileBlocks blocks) {
  constexpr int W = tile_width<Stage>;
  const int k = tile_index<stage_threads<Stage>, W>();
  if (k >= blocks.count) return;
  TeamOverNeighbours<Tile<W>> team(pairs, Tile<W>::of_this_thread());
  visit_block(stage, team, blocks, k);
}

template <class Stage>
__global__ void __launch_bounds__(search_threads)
    over_candidates(const Stage stage, const TileCandidates candidates, int count) {
  constexpr int W = search_tile_width;
  const int k = tile_index<search_threads, W>();
  if (k >= count) return;
  TeamOverCandidates<Tile<W>> team(candidates, Tile<W>::of_this_thread());
  search_one(stage, team, k);
}

template <class Stage>
void launch_team(const void *data, const TilePairs &pairs, const TileWork &work, cudaStream_t stream) {
  if (work.count == 0) return;
  constexpr int threads = stage_threads<Stage>;
  const Stage &stage = *static_cast<const Stage *>(data);
  const unsigned groups = groups_for<threads, tile_width<Stage>>(work.count);
  if constexpr (InTurn<Stage>::value)
    blocks_in_turn<<<groups, threads, 0, stream>>>(stage, pairs, work.blocks);
  else
    all_visits<<<groups, threads, 0, stream>>>(stage, pairs, work.first, work.count);
  check_cuda(cudaGetLastError(), "launching a stage over neighbours");
}

template <class Stage>
void launch_candidates(const void *data, const TileCandidates &candidates, int count, cudaStream_t stream) {
  if (count == 0) return;
  const unsigned groups = groups_for<search_threads, search_tile_width>(count);
  over_candidates<<<groups, search_threads, 0, stream>>>(*static_cast<const Stage *>(data), candidates, count);
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
