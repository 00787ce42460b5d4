/* Random particles sorted by cell, with their true neighbours, for tests of the search and of the order of visits. */
#pragma once

#include <algorithm>
#include <random>
#include <vector>

#include "cpu/visit_order.h"
#include "kernels/neighbours/sort_stages.h"

namespace loam::test {

inline constexpr float r = 0.01f;

struct SortedParticles {
  std::vector<float> x, y, z;
  std::vector<std::uint32_t> keys, materials;
  std::vector<int> starts, neighbour_counts, close_counts;
  std::vector<std::vector<int>> neighbours;
  CellTable table{};

  SortedParticles(int count, Colouring colouring, int material_count, float extent) {
    const CellGrid grid = make_grid(colouring, extent);
    std::mt19937 random(3);
    std::vector<Row> rows;
    for (int i = 0; i < count; ++i) {
      const auto next = [&] { return extent * float(random()) * 0x1p-32f; };
      const float a = next(), b = next(), c = next();
      rows.push_back({a, b * b / extent, c, 1}); // denser at one side, so that cells differ in size
    }
    const auto cell = [&](const Row &row) { return grid.index(xyz(row)); };
    std::stable_sort(rows.begin(), rows.end(), [&](const Row &a, const Row &b) { return cell(a) < cell(b); });
    starts.resize(std::size_t(grid.cell_count()) + 1);
    for (const Row &row : rows) {
      x.push_back(row.x);
      y.push_back(row.y);
      z.push_back(row.z);
      keys.push_back(std::uint32_t(cell(row)));
      materials.push_back(random() % unsigned(material_count));
    }
    for (int i = 0; i < count; ++i) MarkCells{keys.data(), starts.data(), count, grid.cell_count()}(i);
    neighbours.resize(rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i)
      for (std::size_t j = 0; j < rows.size(); ++j)
        if (i != j && length(xyz(rows[i]) - xyz(rows[j])) < 2 * r) neighbours[i].push_back(int(j));
    for (const std::vector<int> &list : neighbours) neighbour_counts.push_back(int(list.size()));
    close_counts.assign(rows.size(), 0);
    table.grid = grid;
    table.colouring = colouring;
    table.particle_count = table.spare_rows = count;
    table.material_count = material_count;
    table.only_material = material_count == 1 ? 0 : -1;
    table.keys = keys.data();
    table.starts = starts.data();
    table.x = x.data();
    table.y = y.data();
    table.z = z.data();
    table.materials = materials.data();
    table.neighbour_counts = neighbour_counts.data();
    table.close_counts = close_counts.data();
  }
  static CellGrid make_grid(Colouring colouring, float extent) {
    CellGrid grid = {{0, 0, 0}, {0, 0, 0}, 1 / (2 * r * 1.0001f)};
    const int cells = int(extent * grid.inverse_cell) + 1;
    for (int &size : grid.size) size = (cells + colouring.period() - 1) / colouring.period() * colouring.period();
    return grid;
  }
};

/* Arranges the visits and makes their lists as an executor does, on one thread: find() and interleave() as VisitOrder::make_lists() has them. */
template <class Find, class Interleave>
void make_all_lists(VisitOrder &order, Workers &workers, const CellTable &table, Find &&find, Interleave &&interleave) {
  order.arrange(workers, table);
  for (int attempt = 0; attempt < 2; ++attempt) {
    order.begin_lists();
    for (int group = 0; group < order.group_count(); ++group) order.make_lists(group, 0, find, interleave);
    if (order.lists_are_complete()) break;
    order.make_room();
  }
}

} // namespace loam::test
