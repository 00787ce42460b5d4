// Points of cloth sorted into cells, over any executor.
#pragma once

#include <algorithm>

#include "kernels/neighbours/sort_stages.h"

namespace loam {

template <class Executor> class ClothGrid {
public:
  explicit ClothGrid(Executor &executor)
      : keys_(executor.template array<std::uint32_t>()), order_(executor.template array<std::uint32_t>()),
        starts_(executor.template array<int>()) {}

  std::uint64_t bytes() const { return keys_.bytes() + order_.bytes() + starts_.bytes(); }
  // For so many points; `particles` are those that the same sort serves. Throws Error if memory is refused.
  void reserve(Executor &ex, std::size_t points, std::size_t particles) {
    keys_.reserve(points);
    order_.reserve(points);
    if (sorted_ >= points) return;
    ex.reserve_sort(std::max(points, particles));
    sorted_ = points;
  }
  // Sorts points by cells of this width. Throws Error if memory is refused.
  void sort(Executor &ex, const Row *points, int count, float width) {
    grid.inverse_cell = 1.0f / (width * 1.0001f);
    const CellBounds::Value cells = ex.reduce(count, CellBounds{points, grid.inverse_cell});
    std::int64_t size[3];
    for (int k = 0; k < 3; ++k) {
      lower[k] = cells.lower[k];
      upper[k] = cells.upper[k];
      grid.origin[k] = cells.lower[k];
      // The three cells around a point along an axis must not be one.
      size[k] = std::max<std::int64_t>(3, static_cast<std::int64_t>(cells.upper[k]) - cells.lower[k] + 1);
    }
    const std::int64_t most = std::max<std::int64_t>(32768, 4 * static_cast<std::int64_t>(count));
    while (size[0] * size[1] > most || size[0] * size[1] * size[2] > most) {
      std::int64_t *widest = std::max_element(size, size + 3);
      *widest = std::max<std::int64_t>(3, *widest / 2);
    }
    for (int k = 0; k < 3; ++k) grid.size[k] = static_cast<int>(size[k]);
    const int cell_count = grid.cell_count();
    const auto entries = static_cast<std::size_t>(cell_count) + 1;
    if (entries > starts_.capacity()) starts_.reserve(entries + entries / 4);
    int key_bits = 1;
    while (((cell_count - 1) >> key_bits) != 0) ++key_bits;
    ex.for_each(count, AssignCells{grid, points, keys_.data(), order_.data()});
    ex.sort(keys_.data(), order_.data(), count, key_bits);
    ex.for_each(count, MarkCells{keys_.data(), starts_.data(), count, cell_count});
  }

  // The points of cell c are order()[starts()[c]] up to order()[starts()[c + 1]].
  CellGrid grid{};
  int lower[3] = {}, upper[3] = {}; // the cells that hold points
  const int *starts() const { return starts_.data(); }
  const std::uint32_t *order() const { return order_.data(); }

private:
  template <class T> using Array = typename Executor::template Array<T>;
  Array<std::uint32_t> keys_, order_;
  Array<int> starts_;
  std::size_t sorted_ = 0; // so many points at most the sort has room for
};

} // namespace loam
