/* A block of Von Mises matter between two platens without friction, the upper one moving down. */
#pragma once

#include "solid.h"

namespace loam::test {

struct Press {
  int edge = 8; // spacings
  float jitter = 0.2f, zero_energy_stiffness = 10;
  float minimum_distance = 0; // so that all stress is in the strains
  std::uint32_t iterations = 5;
  double step = 5e-4, rate = 2; // logarithmic strain per second
  float yield_stress = 1000, youngs_modulus = 1e6f;
  unsigned seed = 1;

  /* The platens act on the centres of the outermost layers, so it is their distance d that counts: the imposed strain is log(d0 / d), and force times d over the
   * volume is the lid's stress, by the rate of its work. The virial theorem gives force times d, whatever has converged, as the moment of the particles'
   * stress over the virial of the statistics. */
  struct Reading {
    double strain;    // imposed
    double lid;       // Pa
    double particles; // mean of the particles' own von Mises stress, Pa
    double rate;      // mean D_yy that particles in the middle see, over the imposed one
  };

  /* At each of the ascending strains. */
  std::vector<Reading> run(const std::vector<double> &strains) const {
    Points points = {0.01f, jitter, seed};
    points.flush[1] = true;
    loam_material_def material = scenes::plasticine(yield_stress, youngs_modulus);
    material.density = 1000;
    Solid block(material, points.box({0, 0, 0}, {edge, edge, edge}));
    block.scene.planes = {{{0, 0, 0}, {0, 1, 0}, 0}};
    block.def.iterations = iterations;
    block.def.substeps = 10;
    block.def.minimum_distance = minimum_distance;
    block.def.zero_energy_stiffness = zero_energy_stiffness;
    block.def.gravity[1] = -1e-3f; // too small to matter; the virial is taken along it
    const double height = 0.01 * edge, frame = step * block.def.substeps;
    // Matter starts with the velocity that it is going to have.
    for (std::size_t i = 0; i < block.scene.positions.size(); i += 3) {
      const auto relative = [&](std::size_t axis) { return double(block.scene.positions[i + axis]) - height / 2; };
      for (const double v : {rate / 2 * relative(0), -rate * (relative(1) + height / 2 - 0.005), rate / 2 * relative(2)})
        block.scene.velocities.push_back(float(v));
    }
    scenes::World world = block.make();
    loam_collider_def lid;
    scenes::require(loam_collider_def_default(&lid, sizeof lid), "loam_collider_def_default");
    lid.kind = LOAM_COLLIDER_PLANE;
    lid.friction = 0;
    lid.position[1] = float(height);
    lid.rotation[0] = 1; // a half turn about x: solid above
    lid.rotation[3] = 0;
    loam_collider_id id = 0;
    scenes::require(loam_collider_create(world.get(), &lid, &id), "loam_collider_create");

    std::vector<Reading> readings;
    double strain = 0;
    for (const double target : strains) {
      Reading mean = {};
      int samples = 0;
      while (strain < target - 1e-9) {
        strain += rate * frame;
        const double between = (height - 0.01) * std::exp(-strain);
        lid.position[1] = float(between + 0.01);
        scenes::require(loam_collider_move(world.get(), id, lid.position, lid.rotation), "loam_collider_move");
        world.step(float(frame));
        if (strain < target - 0.1) continue; // averages over the last tenth
        const scenes::Snapshot now = world.snapshot();
        double stress = 0, own = 0, seen = 0, middle = 0;
        for (std::size_t i = 0; i < now.count(); ++i) {
          const Matrix tau = kirchhoff_stress(material, now, i);
          stress -= tau(1, 1) / double(now.count());
          own += std::sqrt(1.5) * deviator(tau).norm() / double(now.count());
          const double y = (double(now.positions[3 * i + 1]) - 0.005) / between;
          if (y < 0.25 || y > 0.75) continue;
          seen -= velocity_gradient(now, i, 0.01)(1, 1) / rate;
          middle += 1;
        }
        mean.lid += stress / world.statistics().virial;
        mean.particles += own;
        mean.rate += seen / middle;
        ++samples;
      }
      readings.push_back({strain, mean.lid / samples, mean.particles / samples, mean.rate / samples});
    }
    return readings;
  }
};

} // namespace loam::test
