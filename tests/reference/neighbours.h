/* Who is near whom, and how a velocity gradient is taken from it.
 *
 * A particle p sees its neighbours b within the kernel's support. With the corrected gradients
 *   G_b = V_b L_p gradW_b,   L_p = pinv( sum_b V_b gradW_b (x_b - x_p)^T ),
 * grad v = sum_b (v_b - v_p) G_b^T is exact for every linear velocity field, wherever the neighbourhood spans space (Bonet and Lok 1999).
 * Singular values under an absolute share of a full neighbourhood's value, which is 1, are cut off: sparse neighbourhoods (a
 * surface, a lone pair, neighbours in a plane) then see only the directions that they can resolve. */
#pragma once

#include "particles.h"
#include "wendland_kernel.h"

namespace loam::reference {

/* Two particles near enough that position correction might have to push them apart. */
struct ClosePair {
  std::uint32_t first, second;
};

template <typename Real> struct Neighbourhoods {
  /* Per particle; its pairs are first_pair[p] to first_pair[p + 1]. */
  std::vector<std::uint32_t> first_pair;
  std::vector<Vector3<Real>> gradient_sum;    // s = sum_b G_b
  std::vector<Matrix3<Real>> gradient_moment; // M = sum_b w_b G_b G_b^T

  /* Per pair. */
  std::vector<std::uint32_t> neighbour;
  std::vector<Vector3<Real>> gradient; // G_b
  std::vector<Real> kernel_value;      // W_b

  std::vector<ClosePair> close_pairs;

  std::size_t pair_count() const { return neighbour.size(); }
  std::size_t count(std::size_t particle) const { return first_pair[particle + 1] - first_pair[particle]; }
};

/* A grid of cells as wide as the support over the particles' bounding box. */
template <typename Real> struct CellGrid {
  Vector3<Real> lowest;
  Real width;
  int cells[3];
  std::vector<std::uint32_t> first_particle; // of each cell, once the particles are sorted

  int coordinate(const Vector3<Real> &position, int axis) const;
  std::size_t index(int x, int y, int z) const { return (std::size_t(x) * cells[1] + y) * cells[2] + z; }
};

/* Sorts the particles by cell (stable) and returns the grid. Throws std::runtime_error on a position that is not finite. */
template <typename Real> CellGrid<Real> sort_by_cell(Particles<Real> &particles, Real cell_width);

/* Finds the neighbours of sorted particles; close pairs are those under `close_distance`. Gradients are left empty. */
template <typename Real>
void find_neighbours(const Particles<Real> &particles, const CellGrid<Real> &grid, const WendlandKernel<Real> &kernel,
                     Real close_distance, Neighbourhoods<Real> &neighbourhoods);

/* Fills in corrected gradients, their sums and moments. */
template <typename Real>
void compute_gradients(const Particles<Real> &particles, const WendlandKernel<Real> &kernel, Real cutoff,
                       Neighbourhoods<Real> &neighbourhoods);

} // namespace loam::reference
