// How neighbour lists and constraint records lie in memory on CUDA.
//
// A visit is one particle's turn. Visits are stored by material, then colour, then block of cells, and within a block in their order; so a tile
// that walks through its block reads forward. A visit's list takes whole lines of 16 pairs:
//
//   index[line][16]         the neighbours; close ones, which position correction looks at, first
//   gradient[line][3][16]
//   record[visit][stride]   the constraint's record, see Record: whole 32-byte sectors
//
// What stands in a list's last line beyond its end is never read.
#pragma once

#include <cstdint>

#include "kernels/inelastic/record.h"
#include "math/vector.h"

namespace loam {

struct alignas(16) Visit {
  int particle;
  int first_line;
  int count; // neighbours
  int close_count;
};

struct TilePairs {
  static constexpr int line = 16;  // pairs
  static constexpr int sector = 8; // floats
  static constexpr int most_fields = Record::field_count;
  static_assert(most_fields % 4 == 0);

  Row *velocities;
  const Visit *visits;
  int *indices;
  float *gradients;
  float *records;
  int record_stride;
};

// Blocks of cells to be worked through at once: block k of them is `order[k]`, and its visits are starts[order[k]] up to starts[order[k] + 1].
struct TileBlocks {
  const int *order;
  const int *starts;
  int count;
};

// What the candidate search reads and writes.
struct TileCandidates {
  const float *x, *y, *z;
  const std::uint32_t *keys; // cell of each particle
  const int *starts;
  int size[3];
  // filling only
  const Visit *visits;
  int *indices;
};

} // namespace loam
