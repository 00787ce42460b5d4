// The order in which the CPU visits particles, and the storage laid out in that order. See cpu_views.h for the layout.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <vector>

#include "cpu/cpu_views.h"
#include "cpu/workers.h"
#include "scene/memory.h"
#include "solver/cell_table.h"

namespace loam {

class VisitOrder {
public:
  // Visits that may run at once: blocks of one colour, particles of one material.
  struct Pass {
    int material, colour;
    int first_group, last_group; // a group: W lanes, each a few blocks, worked through in lockstep
    std::int64_t particles;
  };

  VisitOrder(const HostAllocator &allocator, int width, unsigned threads);

  // Room for a world's particles and their records of so many fields; called again when these become more.
  void reserve(std::size_t particle_capacity, int material_count, int record_size);

  // Sorts out blocks, groups and batches. Lists follow, group by group, between begin_lists() and finish_lists().
  void arrange(Workers &workers, const CellTable &table);

  void begin_lists();
  // For one group, by thread number `thread`: find(particles, count, lists) finds the lists of its particles, which are then ordered by their lengths, and
  // interleave(views, first batch, last batch) makes the visits' lists of them. All that stays in the thread's cache.
  template <class Find, class Interleave> void make_lists(int group, unsigned thread, Find &&find, Interleave &&interleave);
  // False if there was not enough room. Then lists are not to be used but all counts are right, make_room() makes enough, and the lists must be made again.
  // If memory is refused nothing has changed.
  bool lists_are_complete() const;
  std::int64_t pair_count() const { return pair_count_.load(std::memory_order_relaxed); }
  void make_room();
  int group_count() const { return group_count_; }
  int group_material(int group) const {
    return passes_[static_cast<std::size_t>(group_pass_[static_cast<std::size_t>(group)])].material;
  }

  CpuPairs pairs(Row *velocities);
  // Where each particle's list begins in the thread's scratch; for who finds them.
  int *list_starts() { return list_starts_.data(); }
  const std::vector<Pass> &passes() const { return passes_; }
  // The first group of a part, or the end of the last one. A pass is cut into a part for each thread, all passes near the same places: a thread that works
  // on the same part of all of them finds in its cache what it wrote.
  int part_begin(int pass, unsigned part) const {
    return parts_[static_cast<std::size_t>(pass) * (threads_ + 1) + part].first_group;
  }
  int batch_count() const { return batch_count_; }
  // The groups of a part in all passes: group_of_part(i) for groups_of_part(part) <= i < groups_of_part(part + 1).
  int groups_of_part(unsigned part) const { return groups_of_part_[part]; }
  int group_of_part(int i) const { return group_of_part_[static_cast<std::size_t>(i)]; }
  int group_begin(int group) const { return group_first_batch_[static_cast<std::size_t>(group)]; }
  // Rows beyond the particles that idle lanes may write.
  static constexpr int spare_rows_per_part = 16;

  std::size_t list_bytes() const { return indices_.bytes() + gradients_.bytes(); }
  std::size_t record_bytes() const { return records_.bytes(); }
  std::size_t order_bytes() const;

private:
  struct Entry {
    std::uint64_t key; // pass, part, size descending
    int block, material, size, lane;
  };
  struct Part {
    std::size_t first_entry, last_entry;
    int first_group;
  };
  struct PassSize {
    int blocks;
    std::int64_t particles, so_far;
  };
  void list_entries(const CellTable &table);
  void make_groups(Workers &workers, const CellTable &table);
  void fill_lanes(std::size_t part);
  int list_particles(int group, int *particles) const;
  std::int64_t fill_group(int group, const int *particles);
  // Pair steps that there is room for.
  std::int64_t step_capacity() const {
    const auto W = static_cast<std::size_t>(width_);
    return static_cast<std::int64_t>(std::min(indices_.capacity() / W, gradients_.capacity() / (3 * W)));
  }
  CpuInterleaving interleaving(const FoundLists &lists);

  int width_;
  int record_size_ = 0;
  unsigned threads_;
  CellTable table_{};
  int batch_count_ = 0;
  int largest_group_ = 0;                                   // particles
  std::atomic<std::int64_t> step_count_{0}, pair_count_{0}; // of all lists so far
  std::atomic<std::int64_t> largest_lists_{0};              // room for those of a group, in entries
  std::vector<Pass> passes_;
  std::vector<Part> parts_; // of each pass: one a thread, and an end
  std::vector<int> groups_of_part_;
  std::vector<PassSize> pass_sizes_; // of all colours and materials
  std::vector<int> material_sizes_;
  HostArray<Entry> entries_;
  std::size_t entry_count_ = 0;
  HostArray<int> group_first_batch_, group_first_entry_, group_pass_, group_of_part_;
  int group_count_ = 0;
  HostArray<std::uint64_t> lane_loads_; // of each group
  HostArray<int> lane_ranks_;
  HostArray<int> ids_, active_, offsets_, step_counts_, close_steps_, list_starts_;
  HostArray<int> indices_;
  HostArray<float> gradients_, records_;
  HostArray<int> group_particles_, found_lists_; // of each thread
  std::int64_t found_lists_size_ = 0;
};

// Calls f(first, last) for each run of particles that are visited in a block of cells: its columns along z.
template <class F> void for_each_run(const CellTable &table, int block, F &&f) {
  const int w = table.colouring.block_width;
  const int ny = table.grid.size[1], nz = table.grid.size[2], by = ny / w, bz = nz / w;
  const int z = block % bz * w, y = block / bz % by * w, x = block / bz / by * w;
  for (int dx = 0; dx < w; ++dx)
    for (int dy = 0; dy < w; ++dy) {
      const int cell = ((x + dx) * ny + y + dy) * nz + z;
      if (table.active_cells == nullptr) {
        if (table.starts[cell] != table.starts[cell + w]) f(table.starts[cell], table.starts[cell + w]);
      } else {
        for (int c = cell; c < cell + w; ++c)
          if (table.active_cells[c] != 0) f(table.starts[c], table.starts[c + 1]);
      }
    }
}

template <class Find, class Interleave>
void VisitOrder::make_lists(int group, unsigned thread, Find &&find, Interleave &&interleave) {
  int *const particles = &group_particles_[static_cast<std::size_t>(thread) * static_cast<std::size_t>(largest_group_)];
  FoundLists lists = {found_lists_.data() + static_cast<std::size_t>(thread) * static_cast<std::size_t>(found_lists_size_),
                      found_lists_size_, 0, 0};
  const int count = list_particles(group, particles);
  find(particles, count, lists);
  pair_count_.fetch_add(lists.needed, std::memory_order_relaxed);

  // Where a group's lists lie depends on which thread came first; what is in them does not.
  const std::int64_t steps = fill_group(group, particles);
  const std::int64_t first = step_count_.fetch_add(steps, std::memory_order_relaxed);
  // Interleaving reads as far past each list as the longest one beside it reaches.
  int longest = 0;
  for (int batch = group_begin(group); batch < group_begin(group + 1); ++batch)
    longest = std::max(longest, step_counts_[static_cast<std::size_t>(batch)]);
  const std::int64_t room = lists.needed + longest + width_;
  std::int64_t most = largest_lists_.load(std::memory_order_relaxed);
  while (room > most && !largest_lists_.compare_exchange_weak(most, room, std::memory_order_relaxed)) {
  }
  if (room > lists.capacity || first + steps > step_capacity()) return;
  int offset = static_cast<int>(first);
  for (int batch = group_begin(group); batch < group_begin(group + 1); ++batch) {
    offsets_[static_cast<std::size_t>(batch)] = offset;
    offset += step_counts_[static_cast<std::size_t>(batch)];
  }
  interleave(interleaving(lists), group_begin(group), group_begin(group + 1));
}

} // namespace loam
