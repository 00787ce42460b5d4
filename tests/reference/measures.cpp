#include "measures.h"

#include <limits>
#include <numeric>

namespace loam::reference {

template <typename Real> double run_out(const ScalarSolver<Real> &solver, double initial_radius, bool planar, double share) {
  std::vector<double> distances;
  for (const Vector3<Real> &position : solver.particles().positions)
    distances.push_back(planar ? double(position[0]) : std::hypot(double(position[0]), double(position[2])));
  const std::size_t rank = std::min(distances.size() - 1, std::size_t(share * double(distances.size())));
  std::nth_element(distances.begin(), distances.begin() + std::ptrdiff_t(rank), distances.end());
  return (distances[rank] - initial_radius) / initial_radius;
}

template <typename Real> NearestNeighbours nearest_neighbours(const ScalarSolver<Real> &solver) {
  const WendlandKernel<Real> kernel(Real(solver.settings().kernel_radius));
  Particles<Real> particles = solver.particles();
  Neighbourhoods<Real> neighbourhoods;
  const CellGrid<Real> grid = sort_by_cell(particles, kernel.support());
  find_neighbours(particles, grid, kernel, Real(0), neighbourhoods);

  NearestNeighbours result;
  result.least = std::numeric_limits<double>::max();
  double count = 0, sum = 0, squares = 0;
  for (std::size_t particle = 0; particle < particles.size(); ++particle) {
    double nearest = std::numeric_limits<double>::max();
    for (std::uint32_t pair = neighbourhoods.first_pair[particle]; pair < neighbourhoods.first_pair[particle + 1]; ++pair)
      nearest = std::min(
          nearest, double((particles.positions[neighbourhoods.neighbour[pair]] - particles.positions[particle]).norm()));
    if (neighbourhoods.count(particle) == 0) continue;
    result.least = std::min(result.least, nearest);
    count += 1;
    sum += nearest;
    squares += nearest * nearest;
  }
  if (count == 0) return {};
  result.mean = sum / count;
  result.deviation = std::sqrt(std::max(0.0, squares / count - result.mean * result.mean));
  return result;
}

template <typename Real> double virial(const ScalarSolver<Real> &solver) {
  const Particles<Real> &particles = solver.particles();
  const Vector3<Real> gravity(Real(solver.settings().gravity[0]), Real(solver.settings().gravity[1]),
                              Real(solver.settings().gravity[2]));
  const double strength = double(gravity.norm());
  if (strength == 0 || solver.last_step() == 0) return 0;
  const Vector3<Real> up = -gravity.normalized();

  double stress = solver.correction_virial() / (strength * strength * solver.last_step());
  double weight = 0, weight_moment = 0, support = 0, support_moment = 0;
  for (std::size_t particle = 0; particle < particles.size(); ++particle) {
    if (particles.motions[particle].inverse_mass == 0) continue;
    const double mass = 1 / double(particles.motions[particle].inverse_mass);
    const double height = double(up.dot(particles.positions[particle]));
    const PrincipalStrain<Real> principal =
        principal_hencky_strain(particles.strains[particle], Real(solver.settings().hencky_bound));
    const Vector3<Real> tau = solver.material().kirchhoff_stress(principal.strain);
    const Vector3<Real> along = principal.directions.transpose() * up;
    stress -= double(particles.rest_volumes[particle]) * double(tau.dot(along.cwiseAbs2()));
    weight += mass * strength;
    weight_moment += mass * strength * height;
    for (std::size_t plane = 0; plane < solver.contacts().planes().size(); ++plane) {
      const ContactImpulse<Real> &impulse = solver.contacts().impulse(particle, plane);
      const double lift =
          mass * double(up.dot(impulse.normal * solver.contacts().planes()[plane].normal + impulse.friction));
      support += lift;
      support_moment += lift * height;
    }
  }
  if (support <= 0) return 0;
  const double moment = weight_moment - weight * support_moment / support;
  return moment > 0 ? stress / moment : 0;
}

template <typename Real> double mean_log_volume_change(const ScalarSolver<Real> &solver) {
  const std::vector<Real> &changes = solver.particles().log_volume_changes;
  return changes.empty() ? 0 : std::accumulate(changes.begin(), changes.end(), 0.0) / double(changes.size());
}

#define LOAM_REFERENCE_INSTANTIATE(Real)                                                                                    \
  template double run_out(const ScalarSolver<Real> &, double, bool, double);                                                \
  template NearestNeighbours nearest_neighbours(const ScalarSolver<Real> &);                                                \
  template double virial(const ScalarSolver<Real> &);                                                                       \
  template double mean_log_volume_change(const ScalarSolver<Real> &);
LOAM_REFERENCE_INSTANTIATE(float)
LOAM_REFERENCE_INSTANTIATE(double)

} // namespace loam::reference
