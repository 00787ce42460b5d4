/* What is read off a state: how far it ran, how evenly its particles lie, whether its stress carries its weight. */
#pragma once

#include "scalar_solver.h"

namespace loam::reference {

/* The distance from the axis (vertical, through the origin) within which `share` of the particles lie, less `initial_radius`, over it.
 * `planar`: the distance along x instead, for a slab beside a wall at x = 0. */
template <typename Real>
double run_out(const ScalarSolver<Real> &solver, double initial_radius, bool planar = false, double share = 0.995);

struct NearestNeighbours {
  double least = 0, mean = 0, deviation = 0; // metres; particles without neighbours are left out
};

/* Of the positions now. */
template <typename Real> NearestNeighbours nearest_neighbours(const ScalarSolver<Real> &solver);

/* -sum V0 tau : (g g^T) / |g|^2, with the pairs of position correction, over the moment of the weight above the supports: 1 in equilibrium
 * at rest, lower where the solve left the matter too soft. */
template <typename Real> double virial(const ScalarSolver<Real> &solver);

/* The mean of log J, the true volume change. */
template <typename Real> double mean_log_volume_change(const ScalarSolver<Real> &solver);

} // namespace loam::reference
