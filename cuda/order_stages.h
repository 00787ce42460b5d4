// The per-item stages that put the visits in order. See visit_order.h for how they follow each other.
#pragma once

#include <cstdint>

#include "math/qualifiers.h"
#include "solver/cell_table.h"
#include "tile_views.h"

namespace loam {

// What is counted along the visits. As an exclusive prefix sum: how many there are before a visit.
struct VisitSums {
  int entries; // blocks with particles of one material
  int passes;
  int lines;
};

struct AddVisitSums {
  LOAM_FN VisitSums operator()(const VisitSums &a, const VisitSums &b) const {
    return {a.entries + b.entries, a.passes + b.passes, a.lines + b.lines};
  }
};

// Where a pass begins. After the last pass comes a row with the totals, whose number is `end`.
struct PassRow {
  static constexpr int end = -1;
  int number; // material * colours + colour
  int first_entry;
  int first_visit;
  int first_line;
};

// For each particle the key that the visits are sorted by, from the top bits down: material, colour, block, and within a block particles
// with many neighbours first. That is the CPU's order too, so both solve the same sequence of constraints and differ by rounding alone.
struct AssignVisits {
  static constexpr int count_bits = 7, greatest_count = 95;
  CellTable table;
  int block_bits;
  std::uint64_t *keys;
  std::uint32_t *particles;

  LOAM_FN void operator()(int i) const {
    const int w = table.colouring.block_width, n = table.colouring.colours_per_axis;
    const int ny = table.grid.size[1], nz = table.grid.size[2], cell = static_cast<int>(table.keys[i]);
    const int x = cell / nz / ny / w, y = cell / nz % ny / w, z = cell % nz / w;
    const int colour = (x % n * n + y % n) * n + z % n;
    const int block = (x * (ny / w) + y) * (nz / w) + z;
    const std::uint64_t material =
        table.only_material >= 0 ? static_cast<std::uint64_t>(table.only_material) : table.materials[i];
    const std::uint64_t pass = material * static_cast<std::uint64_t>(n * n * n) + static_cast<std::uint64_t>(colour);
    const int count = table.neighbour_counts[i];
    const int rank = count < greatest_count ? greatest_count - count : 0;
    particles[i] = static_cast<std::uint32_t>(i);
    if (table.active_cells != nullptr && table.active_cells[cell] == 0) { // not visited: behind all others
      keys[i] = ~static_cast<std::uint64_t>(0);
      return;
    }
    keys[i] = (((pass << block_bits) | static_cast<std::uint64_t>(block)) << count_bits) | static_cast<std::uint64_t>(rank);
  }
};

struct CountVisited {
  using Value = long long;
  const std::uint32_t *keys;
  const std::uint8_t *active_cells;
  LOAM_FN static Value identity() { return 0; }
  LOAM_FN Value operator()(int i) const { return active_cells[keys[i]]; }
  LOAM_FN static Value combine(Value a, Value b) { return a + b; }
};

// What the stages over sorted visits have in common.
struct SortedVisits {
  const std::uint64_t *keys;
  const std::uint32_t *particles;
  const int *neighbour_counts;
  int block_bits;

  LOAM_FN std::uint64_t entry_key(int visit) const { return keys[visit] >> AssignVisits::count_bits; }
  LOAM_FN std::uint64_t pass_number(int visit) const { return entry_key(visit) >> block_bits; }
  LOAM_FN VisitSums own(int visit) const {
    const bool first = visit == 0;
    const bool entry = first || entry_key(visit) != entry_key(visit - 1);
    const bool pass = first || pass_number(visit) != pass_number(visit - 1);
    const int count = neighbour_counts[particles[visit]];
    return {entry ? 1 : 0, pass ? 1 : 0, (count + TilePairs::line - 1) / TilePairs::line};
  }
};

struct CountVisits {
  SortedVisits sorted;
  VisitSums *sums;
  LOAM_FN void operator()(int visit) const { sums[visit] = sorted.own(visit); }
};

// Writes the visits, and where entries and passes begin. The last visit also writes the ends.
struct PlaceVisits {
  SortedVisits sorted;
  const VisitSums *sums; // exclusive
  const int *close_counts;
  int visit_count;
  Visit *visits;
  int *entry_starts; // one more than entries
  int *entry_passes;
  PassRow *passes; // one more than passes

  LOAM_FN void operator()(int visit) const {
    const VisitSums before = sums[visit], own = sorted.own(visit);
    const int particle = static_cast<int>(sorted.particles[visit]);
    visits[visit] = {particle, before.lines, sorted.neighbour_counts[particle], close_counts[particle]};
    if (own.entries > 0) {
      entry_starts[before.entries] = visit;
      entry_passes[before.entries] = before.passes + own.passes - 1;
    }
    if (own.passes > 0)
      passes[before.passes] = {static_cast<int>(sorted.pass_number(visit)), before.entries, visit, before.lines};
    if (visit == visit_count - 1) {
      const VisitSums total = AddVisitSums()(before, own);
      passes[total.passes] = {PassRow::end, total.entries, visit_count, total.lines};
      entry_starts[total.entries] = visit_count;
    }
  }
};

// Keys that sort the entries of each pass from large to small: the longest chains begin first, and neighbouring tiles end together.
struct RankEntries {
  static constexpr int size_bits = 12, greatest_size = (1 << size_bits) - 1;
  const int *entry_starts;
  const int *entry_passes;
  std::uint32_t *keys;
  std::uint32_t *order;

  LOAM_FN void operator()(int entry) const {
    const int size = entry_starts[entry + 1] - entry_starts[entry];
    const int rank = size < greatest_size ? greatest_size - size : 0;
    keys[entry] = (static_cast<std::uint32_t>(entry_passes[entry]) << size_bits) | static_cast<std::uint32_t>(rank);
    order[entry] = static_cast<std::uint32_t>(entry);
  }
};

} // namespace loam
