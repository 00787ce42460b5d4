// The order in which the CPU visits particles, and the storage laid out in that order. See cpu_views.h for the layout.
#pragma once

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

  // Sorts out blocks, groups and batches, and gives each list its place. Returns the number of pair steps; make_room() must follow.
  std::int64_t arrange(Workers &workers, const CellTable &table);

  // Room for the lists and records of what was arranged. If memory is refused nothing has changed.
  void make_room();

  // From the lists as they were found to lists interleaved lane by lane, the particle itself behind each list's end. Writing them so at once would touch a
  // cache line per neighbour.
  // `lists` is what CpuCandidates::lists was.
  void interleave_lists(const int *lists, int first_batch, int last_batch);

  // Calls f(first, last) for the runs of particles, contiguous in memory, that make up a group, where all particles are of one material. The lists of
  // a group share cache lines, so whoever fills them does well to go group by group.
  template <class F> void for_each_run_of_group(int group, F &&f) const;
  int group_count() const { return group_count_; }
  int group_material(int group) const {
    return passes_[static_cast<std::size_t>(group_pass_[static_cast<std::size_t>(group)])].material;
  }

  CpuPairs pairs(Row *velocities);
  const int *slots() const { return slots_.data(); }
  const int *offsets() const { return offsets_.data(); }
  // Where lists are put as they are found, see CpuCandidates: for all batches, the memory of the gradients, before those are computed; for one group, a
  // scratch that stays in a thread's cache.
  int *lists_of_all() { return reinterpret_cast<int *>(gradients_.data()); }
  int *lists_of_group(int group, unsigned thread) {
    return &scratch_[static_cast<std::size_t>(thread) * scratch_size_] -
           3 * static_cast<std::ptrdiff_t>(width_) * offsets_[static_cast<std::size_t>(group_begin(group))];
  }
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
  void fill_group(const CellTable &table, int group, int pass_index);

  int width_;
  int record_size_ = 0;
  unsigned threads_;
  CellTable table_{};
  int batch_count_ = 0;
  std::int64_t steps_ = 0;
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
  HostArray<int> ids_, active_, offsets_, close_steps_, slots_;
  HostArray<int> indices_;
  HostArray<float> gradients_, records_;
  HostArray<int> scratch_; // of each thread
  std::size_t scratch_size_ = 0;
};

// Calls f(first, last) for each run of particles in a block of cells: its columns along z.
template <class F> void for_each_run(const CellTable &table, int block, F &&f) {
  const int w = table.colouring.block_width;
  const int ny = table.grid.size[1], nz = table.grid.size[2], by = ny / w, bz = nz / w;
  const int z = block % bz * w, y = block / bz % by * w, x = block / bz / by * w;
  for (int dx = 0; dx < w; ++dx)
    for (int dy = 0; dy < w; ++dy) {
      const int cell = ((x + dx) * ny + y + dy) * nz + z;
      if (table.starts[cell] != table.starts[cell + w]) f(table.starts[cell], table.starts[cell + w]);
    }
}

template <class F> void VisitOrder::for_each_run_of_group(int group, F &&f) const {
  const auto g = static_cast<std::size_t>(group);
  for (int e = group_first_entry_[g]; e < group_first_entry_[g + 1]; ++e)
    for_each_run(table_, entries_[static_cast<std::size_t>(e)].block, f);
}

} // namespace loam
