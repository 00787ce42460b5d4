#include "neighbours.h"

#include <stdexcept>

namespace loam::reference {

namespace {

/* Particles that flew off must not cost memory: cells beyond this many along an axis are merged into the last one, which keeps every
 * neighbour within one cell. */
constexpr int most_cells = 512;

/* The inverse of a nearly symmetric 3x3 matrix on the directions whose eigenvalue passes the cut-off, 0 on the others. */
template <typename Real> Matrix3<Real> pseudo_inverse(const Matrix3<Real> &matrix, Real cutoff) {
  Eigen::SelfAdjointEigenSolver<Matrix3<Real>> solver;
  solver.computeDirect(matrix);
  const Vector3<Real> &values = solver.eigenvalues();
  const Matrix3<Real> &directions = solver.eigenvectors();
  Matrix3<Real> inverse = Matrix3<Real>::Zero();
  for (int axis = 0; axis < 3; ++axis)
    if (values[axis] > cutoff) inverse += directions.col(axis) * (directions.col(axis) / values[axis]).transpose();
  return inverse;
}

} // namespace

template <typename Real> int CellGrid<Real>::coordinate(const Vector3<Real> &position, int axis) const {
  const Real cell = std::floor((position[axis] - lowest[axis]) / width);
  return int(std::clamp(cell, Real(0), Real(cells[axis] - 1)));
}

template <typename Real> CellGrid<Real> sort_by_cell(Particles<Real> &particles, Real cell_width) {
  CellGrid<Real> grid;
  grid.width = cell_width;
  grid.lowest = Vector3<Real>::Zero();
  Vector3<Real> highest = Vector3<Real>::Zero();
  for (std::size_t particle = 0; particle < particles.size(); ++particle) {
    const Vector3<Real> &position = particles.positions[particle];
    if (!position.allFinite()) throw std::runtime_error("reference solver: a position is not finite");
    grid.lowest = particle == 0 ? position : grid.lowest.cwiseMin(position);
    highest = particle == 0 ? position : highest.cwiseMax(position);
  }
  for (int axis = 0; axis < 3; ++axis)
    grid.cells[axis] = 1 + int(std::min((highest[axis] - grid.lowest[axis]) / cell_width, Real(most_cells - 1)));

  std::vector<std::size_t> cell_of(particles.size());
  grid.first_particle.assign(grid.index(grid.cells[0] - 1, grid.cells[1] - 1, grid.cells[2] - 1) + 2, 0);
  for (std::size_t particle = 0; particle < particles.size(); ++particle) {
    const Vector3<Real> &position = particles.positions[particle];
    cell_of[particle] = grid.index(grid.coordinate(position, 0), grid.coordinate(position, 1), grid.coordinate(position, 2));
    ++grid.first_particle[cell_of[particle] + 1];
  }
  for (std::size_t cell = 1; cell < grid.first_particle.size(); ++cell)
    grid.first_particle[cell] += grid.first_particle[cell - 1];

  std::vector<std::uint32_t> next(grid.first_particle.begin(), grid.first_particle.end() - 1);
  std::vector<std::uint32_t> order(particles.size());
  for (std::size_t particle = 0; particle < particles.size(); ++particle)
    order[next[cell_of[particle]]++] = std::uint32_t(particle);
  particles.reorder(order);
  return grid;
}

template <typename Real>
void find_neighbours(const Particles<Real> &particles, const CellGrid<Real> &grid, const WendlandKernel<Real> &kernel,
                     Real close_distance, Neighbourhoods<Real> &neighbourhoods) {
  const std::vector<Vector3<Real>> &positions = particles.positions;
  neighbourhoods.first_pair.assign(1, 0);
  neighbourhoods.neighbour.clear();
  neighbourhoods.kernel_value.clear();
  neighbourhoods.close_pairs.clear();
  for (std::uint32_t particle = 0; particle < positions.size(); ++particle) {
    const Vector3<Real> position = positions[particle];
    const int x = grid.coordinate(position, 0), y = grid.coordinate(position, 1), z = grid.coordinate(position, 2);
    const int lowest_z = std::max(z - 1, 0), highest_z = std::min(z + 1, grid.cells[2] - 1);
    for (int near_x = std::max(x - 1, 0); near_x <= std::min(x + 1, grid.cells[0] - 1); ++near_x)
      for (int near_y = std::max(y - 1, 0); near_y <= std::min(y + 1, grid.cells[1] - 1); ++near_y) {
        // Cells next to each other along z hold consecutive particles.
        const std::uint32_t first = grid.first_particle[grid.index(near_x, near_y, lowest_z)];
        const std::uint32_t last = grid.first_particle[grid.index(near_x, near_y, highest_z) + 1];
        for (std::uint32_t other = first; other < last; ++other) {
          const Real squared_distance = (positions[other] - position).squaredNorm();
          if (squared_distance >= kernel.support() * kernel.support() || other == particle) continue;
          const Real distance = std::sqrt(squared_distance);
          neighbourhoods.neighbour.push_back(other);
          neighbourhoods.kernel_value.push_back(kernel.value(distance));
          if (distance < close_distance && particle < other) neighbourhoods.close_pairs.push_back({particle, other});
        }
      }
    neighbourhoods.first_pair.push_back(std::uint32_t(neighbourhoods.neighbour.size()));
  }
}

template <typename Real>
void compute_gradients(const Particles<Real> &particles, const WendlandKernel<Real> &kernel, Real cutoff,
                       Neighbourhoods<Real> &neighbourhoods) {
  const std::size_t count = particles.size();
  std::vector<Real> volumes(count);
  for (std::size_t particle = 0; particle < count; ++particle) volumes[particle] = particles.volume(particle);
  neighbourhoods.gradient.resize(neighbourhoods.pair_count());
  neighbourhoods.gradient_sum.resize(count);
  neighbourhoods.gradient_moment.resize(count);
  for (std::size_t particle = 0; particle < count; ++particle) {
    const std::uint32_t first = neighbourhoods.first_pair[particle], last = neighbourhoods.first_pair[particle + 1];
    Matrix3<Real> shape = Matrix3<Real>::Zero();
    for (std::uint32_t pair = first; pair < last; ++pair) {
      const std::uint32_t other = neighbourhoods.neighbour[pair];
      const Vector3<Real> offset = particles.positions[other] - particles.positions[particle];
      const Real distance = offset.norm();
      const Real weight = distance > 0 ? volumes[other] * kernel.steepness(distance) / distance : Real(0);
      neighbourhoods.gradient[pair] = weight * offset;
      shape += neighbourhoods.gradient[pair] * offset.transpose();
    }
    const Matrix3<Real> correction = pseudo_inverse(shape, cutoff);
    Vector3<Real> sum = Vector3<Real>::Zero();
    Matrix3<Real> moment = Matrix3<Real>::Zero();
    for (std::uint32_t pair = first; pair < last; ++pair) {
      const Vector3<Real> gradient = correction * neighbourhoods.gradient[pair];
      neighbourhoods.gradient[pair] = gradient;
      sum += gradient;
      moment += particles.motions[neighbourhoods.neighbour[pair]].inverse_mass * gradient * gradient.transpose();
    }
    neighbourhoods.gradient_sum[particle] = sum;
    neighbourhoods.gradient_moment[particle] = moment;
  }
}

#define LOAM_REFERENCE_INSTANTIATE(Real)                                                                                    \
  template struct CellGrid<Real>;                                                                                           \
  template CellGrid<Real> sort_by_cell(Particles<Real> &, Real);                                                            \
  template void find_neighbours(const Particles<Real> &, const CellGrid<Real> &, const WendlandKernel<Real> &, Real,        \
                                Neighbourhoods<Real> &);                                                                    \
  template void compute_gradients(const Particles<Real> &, const WendlandKernel<Real> &, Real, Neighbourhoods<Real> &);
LOAM_REFERENCE_INSTANTIATE(float)
LOAM_REFERENCE_INSTANTIATE(double)

} // namespace loam::reference
