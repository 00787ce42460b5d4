/* The particles of a cantilever for the solver that takes its implicit steps exactly. */
#pragma once

#include "cantilever.h"
#include "implicit_step.h"

namespace loam::test {

inline reference::Vectors columns(const std::vector<float> &points) {
  return Eigen::Map<const Eigen::Matrix<float, 3, Eigen::Dynamic>>(points.data(), 3, Eigen::Index(points.size() / 3))
      .cast<double>();
}

/* Straight and at rest; the free particles first. */
inline reference::ImplicitStep exact_beam(const Cantilever &of, double gravity, double tolerance = 1e-6) {
  reference::ImplicitStep::Settings settings;
  settings.gravity = {0, -gravity, 0};
  settings.zero_energy_stiffness = double(of.zero_energy_stiffness);
  settings.tolerance = tolerance;
  reference::ImplicitStep beam(settings, reference::Material<double>::from(of.material()));
  const reference::Vectors free = columns(of.free_points()), held = columns(of.held_points());
  const double volume = std::pow(Cantilever::spacing, 3);
  beam.add_particles(free, reference::Vectors::Zero(3, free.cols()), volume);
  beam.add_particles(held, reference::Vectors::Zero(3, held.cols()), volume, true);
  return beam;
}

/* How far each free particle goes until the beam is in equilibrium. */
inline reference::Vectors settled(const Cantilever &of) {
  reference::ImplicitStep beam = exact_beam(of, of.gravity);
  beam.settle(3, 100);
  const reference::Vectors free = columns(of.free_points());
  return beam.positions_by_id().leftCols(free.cols()) - free;
}

inline double exact_drop(const Cantilever &of, const reference::Vectors &settled) {
  return of.at_end(-settled.row(1).rightCols(Eigen::Index(of.slice())).mean());
}

} // namespace loam::test
