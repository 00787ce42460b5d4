// The CUDA device as the Machine of a TileExecutor. For .cu files only: it launches kernels.
#pragma once

#include "device_array.h"
#include "item_kernels.cuh"
#include "solver/execution_settings.h"
#include "sort.h"
#include "tile_launches.h"
#include "timeline.h"

namespace loam {

class CudaMachine {
public:
  template <class T> using Array = DeviceArray<T>;
  static constexpr std::uint32_t memory_kind = LOAM_MEMORY_CUDA_DEVICE;

  // The settings are the CPU's: the allocator hook, for one, gives host memory.
  explicit CudaMachine(const ExecutionSettings &) : timeline_(device_.stream()), sort_(device_), results_(device_) {}

  template <class T> Array<T> array() { return Array<T>(device_); }
  void reserve(std::size_t particle_capacity) { sort_.reserve(particle_capacity); }
  std::size_t work_bytes() const { return sort_.bytes() + results_.bytes(); }

  // At its end all work is done, so that the host may use mapped memory in any stream and failures of the device belong to the call.
  template <class Body> void session(Body &&body) {
    const CurrentDevice current(device_.number());
    body();
    device_.synchronize();
    timeline_.finish();
  }

  // ------------------------------------------------------------------------------------------------ per item ---

  template <class Stage> void for_each(int count, const Stage &stage) {
    if (count == 0) return;
    each_item<<<groups_for(count, item_threads), item_threads, 0, device_.stream()>>>(stage, count);
    check_cuda(cudaGetLastError(), "launching a stage over items");
  }
  template <class Reduction> typename Reduction::Value reduce(int count, const Reduction &reduction) {
    using Value = typename Reduction::Value;
    if (count == 0) return Reduction::identity();
    constexpr int chunk = 4096;
    const unsigned chunks = groups_for(count, chunk);
    // The results of the chunks, then the result of all.
    results_.reserve(((chunks + 1) * sizeof(Value) + sizeof(std::uint64_t) - 1) / sizeof(std::uint64_t));
    Value *results = reinterpret_cast<Value *>(results_.data()), *total = results + chunks;
    reduce_chunks<<<chunks, item_threads, 0, device_.stream()>>>(reduction, count, chunk, results);
    const int left = static_cast<int>(chunks);
    reduce_chunks<<<1, item_threads, 0, device_.stream()>>>(CombineResults<Reduction>{results}, left, left, total);
    check_cuda(cudaGetLastError(), "launching a reduction");
    Value value;
    download(&value, total, 1);
    return value;
  }
  template <class Key> void sort(Key *keys, std::uint32_t *values, int count, int key_bits) {
    sort_.sort(keys, values, count, key_bits);
  }
  void exclusive_sum(VisitSums *values, int count) { sort_.exclusive_sum(values, count); }
  template <class T> void set(T *values, int count, T value) {
    const CurrentDevice current(device_.number());
    for_each(count, SetValue<T>{values, value});
  }

  // -------------------------------------------------------------------------------------------------- copies ---

  template <class T> void upload(T *to, const T *from, std::size_t count) { device_.upload(to, from, count * sizeof(T)); }
  template <class T> void download(T *to, const T *from, std::size_t count) {
    device_.download(to, from, count * sizeof(T));
  }
  template <class T> void copy(T *to, const T *from, std::size_t count) { device_.copy(to, from, count * sizeof(T)); }

  // ----------------------------------------------------------------------------------------- over neighbours ---

  template <class Stage> void search(const Stage &stage, const TileCandidates &candidates, int count) {
    tile_launches.candidate[IndexOf<Stage, CandidateStages>::value](&stage, candidates, count, device_.stream());
  }
  template <class Stage> void visit_all(const Stage &stage, const TilePairs &pairs, int first, int count) {
    launch(stage, pairs, {{}, first, count});
  }
  template <class Stage> void visit_blocks(const Stage &stage, const TilePairs &pairs, const TileBlocks &blocks) {
    launch(stage, pairs, {blocks, 0, blocks.count});
  }

  // ---------------------------------------------------------------------------------------------------- time ---

  double lap() {
    const CurrentDevice current(device_.number());
    timeline_.begin();
    return 0;
  }
  void lap(Schedule &schedule, int stage, std::uint64_t items) { timeline_.mark(schedule, stage, items); }

private:
  static unsigned groups_for(int count, int size) {
    return (static_cast<unsigned>(count) + static_cast<unsigned>(size) - 1) / static_cast<unsigned>(size);
  }
  template <class Stage> void launch(const Stage &stage, const TilePairs &pairs, const TileWork &work) {
    tile_launches.team[IndexOf<Stage, TeamStages>::value](&stage, pairs, work, device_.stream());
  }

  CudaDevice device_;
  Timeline timeline_;
  DeviceSort sort_;
  DeviceArray<std::uint64_t> results_; // of reductions
};

} // namespace loam
