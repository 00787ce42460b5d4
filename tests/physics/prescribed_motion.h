/* A cloud whose every particle is pinned and moves as x = F(t) X prescribes: what its strains become is the law's doing and nothing else's. */
#pragma once

#include <cmath>
#include <gtest/gtest.h>

#include "support/scenes.h"
#include "support/tensors.h"

namespace loam::test {

/* Particles in a jittered cube around the origin, `edge` to a side. */
inline scenes::Scene centred_cloud(const loam_material_def &material, int edge, float jitter = 0.25f) {
  scenes::Lattice lattice;
  lattice.jitter = jitter;
  scenes::Scene scene = scenes::drop_block(material, edge, 1, 0, lattice);
  scene.planes.clear();
  for (std::size_t i = 1; i < scene.positions.size(); i += 3) scene.positions[i] -= 1 + 0.5f * float(edge) * scene.spacing;
  return scene;
}

/* The world of a cloud that moves at v = A x, A in 1/s: after t seconds F = I + t A. */
inline scenes::World prescribed(const scenes::Scene &cloud, const Matrix &A, std::uint32_t substeps = 1) {
  loam_world_def def = scenes::world_def(cloud);
  def.substeps = substeps;
  def.gradient_cutoff = 0.02f; // trust the corners
  for (float &component : def.gravity) component = 0;
  scenes::World world(def);
  loam_material_id material = 0;
  scenes::require(loam_material_create(world.get(), &cloud.material, &material), "material");
  std::vector<float> velocities;
  for (std::size_t i = 0; i < cloud.positions.size(); i += 3) {
    const Vector v = A * Vector(cloud.positions[i], cloud.positions[i + 1], cloud.positions[i + 2]);
    for (int k = 0; k < 3; ++k) velocities.push_back(float(v[k]));
  }
  loam_particles_def particles;
  scenes::require(loam_particles_def_default(&particles, sizeof particles), "default");
  particles.material = material;
  particles.count = cloud.count();
  particles.positions = cloud.positions.data();
  particles.velocities = velocities.data();
  particles.pinned = 1;
  scenes::require(loam_particles_add(world.get(), &particles, nullptr), "add");
  return world;
}

/* b - I of one particle. */
inline Matrix strain_of(const scenes::Snapshot &snapshot, std::size_t i) {
  const float *s = &snapshot.strains[6 * i];
  return widen(Sym3<float>{s[0], s[1], s[2], s[3], s[4], s[5]});
}

/* The Kirchhoff stress of a particle from its strain, in double. */
inline Matrix kirchhoff_stress(const loam_material_def &def, const Matrix &strain) {
  const double E = double(def.youngs_modulus), nu = double(def.poissons_ratio);
  const double mu = E / (2 * (1 + nu)), lambda = E * nu / ((1 + nu) * (1 - 2 * nu));
  const Matrix e = apply(strain, [](double x) { return 0.5 * std::log1p(x); });
  return 2 * mu * e + lambda * e.trace() * Matrix::Identity();
}

} // namespace loam::test
