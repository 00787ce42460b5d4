// The grid of cells, 2r wide, that neighbours are searched in.
//
// The grid is a torus: cell coordinates are taken modulo its size. Where matter fits into it nothing wraps. Where matter is scattered so
// widely that a table of all cells would be too large, far-apart cells share an entry, and only the distance test tells them apart: memory
// stays bounded and no particle is ever outside. Sizes are multiples of the colouring's period, so colours stay right across the seam.
#pragma once

#include "math/vector.h"

namespace loam {

struct CellGrid {
  int origin[3]; // cell coordinates of the torus' first cell
  int size[3];
  float inverse_cell;

  // Absolute cell coordinate along one axis; far positions share the outermost cells.
  LOAM_FN int coordinate(float x) const {
    const float c = floorf(x * inverse_cell);
    return static_cast<int>(minimum(maximum(c, -1e9f), 1e9f));
  }
  LOAM_FN int wrap(int c, int axis) const {
    const int local = c - origin[axis];
    if (static_cast<unsigned>(local) < static_cast<unsigned>(size[axis])) return local;
    const int remainder = local % size[axis];
    return remainder < 0 ? remainder + size[axis] : remainder;
  }
  LOAM_FN int index(int x, int y, int z) const { return (x * size[1] + y) * size[2] + z; }
  LOAM_FN int index(Vec3<float> x) const {
    return index(wrap(coordinate(x.x), 0), wrap(coordinate(x.y), 1), wrap(coordinate(x.z), 2));
  }
  LOAM_FN int cell_count() const { return size[0] * size[1] * size[2]; }
};

// The cells that hold particles, for making a grid: a reduction over particles.
struct CellBounds {
  struct Value {
    int lower[3], upper[3];
  };
  const Row *positions;
  float inverse_cell;

  LOAM_FN static Value identity() { return {{2000000000, 2000000000, 2000000000}, {-2000000000, -2000000000, -2000000000}}; }
  LOAM_FN Value operator()(int i) const {
    const CellGrid grid = {{0, 0, 0}, {1, 1, 1}, inverse_cell};
    const int x = grid.coordinate(positions[i].x), y = grid.coordinate(positions[i].y), z = grid.coordinate(positions[i].z);
    return {{x, y, z}, {x, y, z}};
  }
  LOAM_FN static Value combine(const Value &a, const Value &b) {
    Value c = a;
    for (int k = 0; k < 3; ++k) {
      if (b.lower[k] < c.lower[k]) c.lower[k] = b.lower[k];
      if (b.upper[k] > c.upper[k]) c.upper[k] = b.upper[k];
    }
    return c;
  }
};

} // namespace loam
