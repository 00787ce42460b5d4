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
    int first_group, last_group; // a group: W blocks worked through in lockstep
    std::int64_t particles;
  };

  VisitOrder(const HostAllocator &allocator, int width);

  // Room for a world's particles; called once.
  void reserve(std::size_t particle_capacity, int material_count);

  // Sorts out blocks, groups and batches, and gives each list its place. Returns the number of pair steps; make_room() must follow.
  std::int64_t arrange(Workers &workers, const CellTable &table);

  // Room for the lists and records of what was arranged. If memory is refused nothing has changed.
  void make_room();

  // Points the lanes that have no list of their own at a harmless row.
  void fill_idle_lanes(Workers &workers);

  CpuPairs pairs(Row *velocities);
  const int *slots() const { return slots_.data(); }
  const int *offsets() const { return offsets_.data(); }
  int *indices() { return indices_.data(); }
  const std::vector<Pass> &passes() const { return passes_; }
  int batch_count() const { return batch_count_; }
  int group_begin(int group) const { return group_first_batch_[static_cast<std::size_t>(group)]; }
  // Rows beyond the particles that idle lanes may write.
  static constexpr int spare_rows_per_pass = 16;

  std::size_t list_bytes() const { return indices_.bytes() + gradients_.bytes(); }
  std::size_t record_bytes() const { return records_.bytes(); }
  std::size_t order_bytes() const;

private:
  struct Entry {
    std::uint64_t key; // pass, size descending, block
    int block, material, size;
  };
  void list_entries(const CellTable &table);
  void make_groups(const CellTable &table);
  void fill_group(const CellTable &table, int group, int pass_index);

  int width_;
  int batch_count_ = 0;
  std::int64_t steps_ = 0;
  std::vector<Pass> passes_;
  std::vector<int> material_sizes_;
  HostArray<Entry> entries_;
  std::size_t entry_count_ = 0;
  HostArray<int> group_first_batch_, group_first_entry_, group_pass_;
  int group_count_ = 0;
  HostArray<int> ids_, active_, offsets_, close_steps_, slots_;
  HostArray<int> indices_;
  HostArray<float> gradients_, records_;
};

} // namespace loam
