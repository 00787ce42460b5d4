// What an executor needs to know of the sorted particles to order its visits, and what it answers.
#pragma once

#include <cstdint>

#include "kernels/neighbours/cell_grid.h"

namespace loam {

// How cells are grouped into blocks and coloured. Blocks of one colour may be worked on at once: the particles that they write, up to 2r beyond the block,
// never overlap. The paper's 2r cells with 2r between them do overlap; these two do not:
//
//   27 colours of blocks of one cell     short chains, for small scenes
//    8 colours of blocks of 2x2x2 cells  fewer passes and better use of caches, for large ones
struct Colouring {
  int block_width; // cells
  int colours_per_axis;
  int period() const { return block_width * colours_per_axis; }
  int colours() const { return colours_per_axis * colours_per_axis * colours_per_axis; }

  static Colouring choose(int particle_count) {
    // measured on two AVX-512 cores: the larger blocks win above about 30 K particles
    return particle_count < 30000 ? Colouring{1, 3} : Colouring{2, 2};
  }
};

struct CellTable {
  CellGrid grid;
  Colouring colouring;
  int particle_count;
  int material_count;
  int only_material; // the one that all particles are of, so that `materials` need not be looked at; -1 if there are several
  const std::uint32_t *keys;
  const int *starts;
  const float *x, *y, *z;
  const std::uint32_t *materials;
  const int *neighbour_counts;
  const int *close_counts;
  int spare_rows;                   // index of the first row that belongs to no particle
  const std::uint8_t *active_cells; // whose particles are visited; null: all
};

} // namespace loam
