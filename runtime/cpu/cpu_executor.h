// The CPU executor: launches stages over items, particles and colours with threads x SIMD, in host memory.
//
// An executor is what the solver is written against; the CUDA one (cuda/cuda_executor.h) offers the same names.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <vector>

#include "cpu/kernel_table.h"
#include "cpu/radix_sort.h"
#include "cpu/visit_order.h"
#include "cpu/workers.h"
#include "scene/memory.h"
#include "schedule/schedule.h"
#include "solver/cell_table.h"
#include "solver/execution_settings.h"

namespace loam {

class CpuExecutor {
public:
  template <class T> using Array = HostArray<T>;
  static constexpr std::uint32_t memory_kind = LOAM_MEMORY_HOST;

  explicit CpuExecutor(const ExecutionSettings &settings)
      : allocator_(settings.allocator), workers_(settings.thread_count, settings.job_system),
        table_(kernel_table(settings.instruction_set)), sort_(allocator_),
        order_(allocator_, table_->width, workers_.thread_count()), next_of_part_(workers_.thread_count()) {}

  template <class T> Array<T> array() { return Array<T>(allocator_); }
  void reserve(std::size_t particle_capacity, int material_count, int record_size) {
    sort_.reserve(particle_capacity);
    order_.reserve(particle_capacity, material_count, record_size);
  }
  // Rows that the particle arrays need beyond the particles.
  std::size_t spare_rows() const {
    return static_cast<std::size_t>(workers_.thread_count()) * VisitOrder::spare_rows_per_part + 16;
  }

  template <class Body> void session(Body &&body) { workers_.session(body); }

  // ------------------------------------------------------------------------------------------------ per item ---

  template <class Stage> void for_each(int count, const Stage &stage) {
    in_chunks(count, 1024, [&](int first, int last) {
      for (int i = first; i < last; ++i) stage(i);
    });
  }
  // Chunks have a fixed size and are combined in order: the same bits for any number of threads.
  template <class Reduction> typename Reduction::Value reduce(int count, const Reduction &reduction) {
    using Value = typename Reduction::Value;
    constexpr int chunk_size = 8192, most = 64;
    Value total = Reduction::identity();
    for (int base = 0; base < count; base += chunk_size * most) {
      Value partial[most];
      const int chunks = std::min(most, (count - base + chunk_size - 1) / chunk_size);
      workers_.loop(chunks, [&](int c) {
        Value value = Reduction::identity();
        const int first = base + c * chunk_size, last = std::min(count, first + chunk_size);
        for (int i = first; i < last; ++i) value = Reduction::combine(value, reduction(i));
        partial[c] = value;
      });
      for (int c = 0; c < chunks; ++c) total = Reduction::combine(total, partial[c]);
    }
    return total;
  }
  // Room for a sort of more than the particles.
  void reserve_sort(std::size_t count) { sort_.reserve(count); }
  void sort(std::uint32_t *keys, std::uint32_t *values, int count, int key_bits) {
    sort_.sort(workers_, keys, values, count, key_bits);
  }
  template <class T> void set(T *values, int count, T value) { std::fill(values, values + count, value); }
  template <class T> T read(const T *value) const { return *value; }
  template <class T> void upload(T *to, const T *from, std::size_t count) { std::copy(from, from + count, to); }
  template <class T> void copy(T *to, const T *from, std::size_t count) { std::copy(from, from + count, to); }
  template <class T> void download(T *to, const T *from, std::size_t count) const { std::copy(from, from + count, to); }

  // ---------------------------------------------------------------------------------------------- neighbours ---

  // Finds the lists and orders the visits. `check` is told the number of pairs before memory is taken for them, and may throw.
  template <class Check>
  void find_neighbours(const CellTable &table, const CandidateTest &test, int *neighbour_counts, int *close_counts,
                       Check &&check, Schedule &schedule) {
    order_.arrange(workers_, table);
    lap(schedule, schedule.order, static_cast<std::uint64_t>(table.particle_count));
    const FindNeighbours stage = {test, neighbour_counts, close_counts};
    const auto find_all = [&] {
      order_.begin_lists();
      for_each_group([&](int group) {
        order_.make_lists(
            group, Workers::current(),
            [&](const int *particles, int count, FoundLists &lists) {
              table_->search(stage, candidates(table, lists), particles, count);
            },
            table_->interleave);
      });
      check(static_cast<std::uint64_t>(order_.pair_count()));
    };
    find_all();
    if (!order_.lists_are_complete()) {
      order_.make_room();
      find_all();
    }
    lap(schedule, schedule.search, static_cast<std::uint64_t>(order_.pair_count()));
  }
  std::size_t list_bytes() const { return order_.list_bytes(); }
  std::size_t record_bytes() const { return order_.record_bytes(); }
  std::size_t order_bytes() const { return order_.order_bytes() + sort_.bytes(); }

  // --------------------------------------------------------------------------------------- over neighbours ---

  // All particles at once: the stage writes its own particle only.
  template <class Stage> void for_each_particle(Row *velocities, const Stage &stage) {
    const CpuPairs pairs = order_.pairs(velocities);
    const auto launch = table_->team[IndexOf<Stage, TeamStages>::value];
    for_each_group([&](int group) { launch(&stage, pairs, order_.group_begin(group), order_.group_begin(group + 1)); });
  }
  template <class Stage> void for_each_particle_of(int material, Row *velocities, const Stage &stage) {
    const CpuPairs pairs = order_.pairs(velocities);
    const auto launch = table_->team[IndexOf<Stage, TeamStages>::value];
    for_each_group([&](int group) {
      if (order_.group_material(group) == material)
        launch(&stage, pairs, order_.group_begin(group), order_.group_begin(group + 1));
    });
  }
  // The passes in turn; within a pass, blocks at once and the particles of a block in turn.
  int pass_count() const { return static_cast<int>(order_.passes().size()); }
  int pass_material(int pass) const { return order_.passes()[static_cast<std::size_t>(pass)].material; }
  std::int64_t pass_particles(int pass) const { return order_.passes()[static_cast<std::size_t>(pass)].particles; }
  template <class Stage> void for_each_block(int pass_index, Row *velocities, const Stage &stage) {
    const VisitOrder::Pass &pass = order_.passes()[static_cast<std::size_t>(pass_index)];
    const CpuPairs pairs = order_.pairs(velocities);
    const auto launch = table_->team[IndexOf<Stage, TeamStages>::value];
    by_part(
        pass.last_group - pass.first_group, [&](unsigned part) { return order_.part_begin(pass_index, part); },
        [&](int group) { launch(&stage, pairs, order_.group_begin(group), order_.group_begin(group + 1)); });
  }

  // ----------------------------------------------------------------------------------------- over constraints ---

  // Constraints of a batch.
  int constraint_width() const { return table_->width; }
  // The batches of one colour at once.
  template <class Stage> void for_each_constraint(int first_batch, int last_batch, const Stage &stage) {
    const auto launch = table_->constraint[IndexOf<Stage, ConstraintStages>::value];
    const int count = last_batch - first_batch, parts = static_cast<int>(workers_.thread_count());
    // A part of every colour is in about the same place of the cloth.
    const int per_chunk = std::max(1, count / (4 * parts)), chunks = (count + per_chunk - 1) / per_chunk;
    by_part(
        chunks, [&](unsigned part) { return static_cast<int>(part) * chunks / parts; },
        [&](int c) { launch(&stage, first_batch + c * per_chunk, first_batch + std::min(count, (c + 1) * per_chunk)); });
  }

  // ---------------------------------------------------------------------------------------------------- time ---

  // Seconds since the previous call.
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    const double seconds = std::chrono::duration<double>(now - lap_).count();
    lap_ = now;
    return seconds;
  }
  // Tells a schedule what passed since the previous call. An executor that runs behind its caller may do so later, at the end of the session.
  void lap(Schedule &schedule, int stage, std::uint64_t items) { schedule.record(stage, lap(), items); }

private:
  // function(i) for all i of the parts, which are begin(part) <= i < begin(part + 1). A thread works through its own part, where its cache has most of what
  // it needs, then helps with the others.
  template <class Begin, class F> void by_part(int count, Begin &&begin, F &&function) {
    const unsigned parts = workers_.thread_count();
    for (unsigned part = 0; part < parts; ++part) next_of_part_[part].value.store(begin(part), std::memory_order_relaxed);
    workers_.loop(count, [&](int) {
      for (unsigned i = 0, part = Workers::current(); i < parts; ++i, ++part) {
        if (part >= parts) part = 0;
        const int next = next_of_part_[part].value.fetch_add(1, std::memory_order_relaxed);
        if (next >= begin(part + 1)) continue;
        function(next);
        return;
      }
    });
  }
  // All groups, each by the thread that has it in every stage; never cut, for idle lanes read the particles that they stand in for.
  template <class F> void for_each_group(F &&function) {
    by_part(
        order_.group_count(), [&](unsigned part) { return order_.groups_of_part(part); },
        [&](int place) { function(order_.group_of_part(place)); });
  }
  template <class F> void in_chunks(int count, int least, F &&function) {
    const int per_chunk = std::max(least, count / (8 * static_cast<int>(workers_.thread_count())));
    workers_.loop((count + per_chunk - 1) / per_chunk,
                  [&](int c) { function(c * per_chunk, std::min(count, (c + 1) * per_chunk)); });
  }
  CpuCandidates candidates(const CellTable &table, FoundLists &lists) {
    return {table.x,      table.y,
            table.z,      table.keys,
            table.starts, {table.grid.size[0], table.grid.size[1], table.grid.size[2]},
            &lists,       order_.list_starts()};
  }

  HostAllocator allocator_;
  Workers workers_;
  const KernelTable *table_;
  RadixSort sort_;
  VisitOrder order_;
  struct alignas(64) NextOfPart {
    std::atomic<int> value{0};
  };
  std::vector<NextOfPart> next_of_part_; // of each part
  std::chrono::steady_clock::time_point lap_ = std::chrono::steady_clock::now();
};

} // namespace loam
