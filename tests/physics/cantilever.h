/* Cantilevers under their own weight, and the elastica that they are to follow. */
#pragma once

#include "elastica.h"
#include "solid.h"
#include "support/course.h"

namespace loam::test {

using reference::elastica;

/* A square beam of unit density 1000 kg/m^3 along x, held at x < 0, slowly loaded; the drop of its end over its length, averaged over a period. */
struct Cantilever {
  int layers = 4, length = 32, width = 4; // in spacings
  double load = 1;
  double gravity = 9.8;
  double step = 1e-3;                          // seconds of a substep
  std::uint32_t iterations = 5, substeps = 10; // of a frame, in which gravity does not change
  float jitter = 0.12f, zero_energy_stiffness = 10;
  std::uint32_t multiplier = LOAM_MULTIPLIER_PROJECTED_TENSOR;
  unsigned seed = 1;

  static constexpr double spacing = 0.01, density = 1000;
  double metres() const { return length * spacing; }
  double youngs_modulus() const {
    return 12 * density * gravity * std::pow(metres(), 3) / (load * std::pow(layers * spacing, 2));
  }

  /* Over its length. */
  struct Bent {
    double drop, shortening;
  };

  loam_material_def material() const {
    loam_material_def material = scenes::rubber(float(youngs_modulus()));
    material.density = float(density);
    return material;
  }
  std::vector<float> free_points() const {
    return Points{float(spacing), jitter, seed}.box({0, 0, 0}, {length, layers, width});
  }
  std::vector<float> held_points() const {
    return Points{float(spacing), jitter, seed + 100}.box({-3, 0, 0}, {0, layers, width});
  }

  /* The particles of the last slice are the last of the free ones. */
  std::size_t slice() const { return std::size_t(layers * width); }
  /* From the last slice, which lies half a spacing before the end, on a line that is nearly straight there. */
  double at_end(double of_last_slice) const { return of_last_slice * length / (length - 0.5) / metres(); }

  Bent run(const Course &course = {}) const {
    Solid beam(material(), free_points());
    beam.held = held_points();
    beam.def.iterations = iterations;
    beam.def.substeps = substeps;
    beam.def.zero_energy_stiffness = zero_energy_stiffness;
    beam.def.multiplier = multiplier;
    course.change(beam.def);
    scenes::World world = beam.make();
    // The lowest natural period is 2 pi / 3.516 sqrt(rho A L^4 / (E I)).
    const double period = 2 * pi / 3.516 * std::sqrt(load * metres() / gravity), ramp = 2 * period, end = ramp + period;
    const double frame = step * beam.def.substeps;
    double drop = 0, shortening = 0, samples = 0;
    for (double t = 0; t < end; t += frame) {
      const double s = std::min(1.0, t / ramp);
      const float g[3] = {0, float(-gravity * s * s * (3 - 2 * s)), 0};
      scenes::require(loam_world_set_gravity(world.get(), g), "loam_world_set_gravity");
      course.step(world, float(frame));
      if (t < ramp) continue;
      const scenes::Snapshot now = world.snapshot();
      const std::size_t free = beam.scene.count();
      for (std::size_t i = 3 * (free - slice()); i < 3 * free; i += 3) {
        drop -= double(now.positions[i + 1] - beam.scene.positions[i + 1]);
        shortening -= double(now.positions[i] - beam.scene.positions[i]);
        samples += 1;
      }
    }
    return {at_end(drop / samples), at_end(shortening / samples)};
  }
};

} // namespace loam::test
