// The Machine of a TileExecutor without a GPU: host memory, plain loops, and a check that blocks which a GPU works on at once stay apart.
#pragma once

#include <algorithm>
#include <chrono>
#include <stdexcept>
#include <vector>

#include "../../cuda/tile_executor.h"
#include "../../cuda/tile_loops.h"
#include "emulated_tile.h"
#include "scene/memory.h"

namespace loam::emulation {

// What happened since the last reset; for one test at a time.
struct Report {
  long ordered_visits = 0; // in blocks
  long conflicts = 0;      // particles that two blocks of one pass would touch
};
inline Report report;

class Machine {
public:
  template <class T> using Array = HostArray<T>;
  static constexpr std::uint32_t memory_kind = LOAM_MEMORY_HOST;

  // With a `thread_count` of 2, whatever a GPU does at once is done in the opposite order.
  explicit Machine(const ExecutionSettings &settings)
      : allocator_(settings.allocator), backwards_(settings.thread_count == 2) {}

  template <class T> Array<T> array() { return Array<T>(allocator_); }
  void reserve(std::size_t particle_capacity) { owners_.resize(particle_capacity); }
  std::size_t work_bytes() const { return 0; }
  template <class Body> void session(Body &&body) { body(); }

  template <class Stage> void for_each(int count, const Stage &stage) {
    at_once(count, [&](int i) { stage(i); });
  }
  template <class Reduction> typename Reduction::Value reduce(int count, const Reduction &reduction) {
    auto total = Reduction::identity();
    for (int i = 0; i < count; ++i) total = Reduction::combine(total, reduction(i));
    return total;
  }
  template <class Key> void sort(Key *keys, std::uint32_t *values, int count, int key_bits) {
    std::vector<std::pair<Key, std::uint32_t>> pairs(static_cast<std::size_t>(count));
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      pairs[i] = {keys[i], values[i]};
      if (key_bits < static_cast<int>(8 * sizeof(Key)) && keys[i] >> key_bits != 0)
        throw std::logic_error("a key has more bits than the sort was told");
    }
    std::stable_sort(pairs.begin(), pairs.end(), [](const auto &a, const auto &b) { return a.first < b.first; });
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      keys[i] = pairs[i].first;
      values[i] = pairs[i].second;
    }
  }
  void exclusive_sum(VisitSums *values, int count) {
    VisitSums sum = {0, 0, 0};
    for (int i = 0; i < count; ++i) sum = AddVisitSums()(std::exchange(values[i], sum), sum);
  }
  template <class T> void set(T *values, int count, T value) { std::fill(values, values + count, value); }
  template <class T> void upload(T *to, const T *from, std::size_t count) { std::copy(from, from + count, to); }
  template <class T> void download(T *to, const T *from, std::size_t count) { std::copy(from, from + count, to); }
  template <class T> void copy(T *to, const T *from, std::size_t count) { std::copy(from, from + count, to); }

  template <class Stage> void search(const Stage &stage, const TileCandidates &candidates, int count) {
    at_once(count, [&](int i) {
      TeamOverCandidates<Tile<search_tile_width>> team(candidates, {});
      search_one(stage, team, i);
    });
  }
  template <class Stage> void visit_all(const Stage &stage, const TilePairs &pairs, int first, int count) {
    at_once(count, [&](int i) {
      TeamOverNeighbours<Tile<tile_width<Stage>>> team(pairs, {});
      visit_one(stage, team, first + i);
    });
  }
  template <class Stage> void visit_blocks(const Stage &stage, const TilePairs &pairs, const TileBlocks &blocks) {
    find_conflicts(pairs, blocks);
    at_once(blocks.count, [&](int k) {
      TeamOverNeighbours<Tile<tile_width<Stage>>> team(pairs, {});
      visit_block(stage, team, blocks, k);
    });
  }

  double lap() {
    const auto now = std::chrono::steady_clock::now();
    return std::chrono::duration<double>(now - std::exchange(lap_, now)).count();
  }
  void lap(Schedule &schedule, int stage, std::uint64_t items) { schedule.record(stage, lap(), items); }

private:
  template <class F> void at_once(int count, F &&f) {
    for (int i = 0; i < count; ++i) f(backwards_ ? count - 1 - i : i);
  }
  // Every particle that a block reads or writes must be that block's alone.
  void find_conflicts(const TilePairs &pairs, const TileBlocks &blocks) {
    ++pass_;
    for (int k = 0; k < blocks.count; ++k) {
      const int entry = blocks.order[k];
      for (int v = blocks.starts[entry]; v < blocks.starts[entry + 1]; ++v) {
        const Visit &visit = pairs.visits[v];
        ++report.ordered_visits;
        const int *list = pairs.indices + static_cast<long>(visit.first_line) * TilePairs::line;
        for (int j = -1; j < visit.count; ++j) {
          Owner &owner = owners_[static_cast<std::size_t>(j < 0 ? visit.particle : list[j])];
          if (owner.pass == pass_ && owner.block != k) ++report.conflicts;
          owner = {pass_, k};
        }
      }
    }
  }

  struct Owner {
    long pass;
    int block;
  };
  HostAllocator allocator_;
  bool backwards_;
  std::vector<Owner> owners_;
  long pass_ = 0;
  std::chrono::steady_clock::time_point lap_ = std::chrono::steady_clock::now();
};

} // namespace loam::emulation
