/* The reference solver with a scene in it: the very particles, planes and material that scenes::World gives to the library. */
#pragma once

#include "../support/scenes.h"
#include "scalar_solver.h"

namespace loam::reference {

/* Settings whose kernel radius is the scene's spacing; the rest are the library's defaults. */
inline Settings settings_for(const scenes::Scene &scene) {
  Settings settings;
  settings.kernel_radius = double(scene.spacing);
  return settings;
}

template <typename Real> ScalarSolver<Real> solver_for(const scenes::Scene &scene, const Settings &settings) {
  ScalarSolver<Real> solver(settings, Material<Real>::from(scene.material));
  solver.add_particles(scene.positions.data(), scene.velocities.empty() ? nullptr : scene.velocities.data(), scene.count(),
                       double(scene.volume()));
  for (const scenes::Plane &plane : scene.planes) solver.add_plane(plane.point, plane.normal, double(plane.friction));
  return solver;
}

/* Positions in the order of the ids, x, y, z one after the other, as in scenes::Snapshot. */
template <typename Real> std::vector<float> positions_by_id(const ScalarSolver<Real> &solver) {
  const Particles<Real> &particles = solver.particles();
  std::vector<float> positions(3 * particles.size());
  for (std::size_t place = 0; place < particles.size(); ++place)
    for (int axis = 0; axis < 3; ++axis)
      positions[3 * std::size_t(particles.ids[place]) + std::size_t(axis)] = float(particles.positions[place][axis]);
  return positions;
}

} // namespace loam::reference
