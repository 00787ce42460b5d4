/* A poured heap is the steeper the greater its friction angle. */
#include "granular.h"

#include <gtest/gtest.h>
#include <string>

namespace loam {
namespace {

using test::degree;

/* Poured from a disc onto rough ground: the slope, in degrees, from the heights of rings. */
double slope_of_heap(float friction_angle, std::uint32_t plasticity = LOAM_PLASTICITY_IMPLICIT) {
  const float spacing = 0.01f;
  loam_material_def sand = scenes::sand(friction_angle);
  scenes::Scene ground;
  ground.material = sand;
  ground.spacing = spacing;
  ground.planes = {{{0, 0, 0}, {0, 1, 0}, 1}};
  loam_world_def def = scenes::world_def(ground);
  def.particle_capacity = 2000;
  def.substeps = 10;
  def.plasticity = plasticity;
  scenes::World world(def);
  const loam_material_id material = world.add(ground);
  std::uint32_t state = 7;
  const auto jitter = [&] { return 0.1f * spacing * (float((state = state * 1664525u + 1013904223u) >> 8) * 0x1p-23f - 1); };
  for (int layer = 0; layer < 50; ++layer) {
    std::vector<float> positions, velocities;
    for (int x = -2; x <= 1; ++x)
      for (int z = -2; z <= 1; ++z) {
        positions.insert(positions.end(),
                         {(float(x) + 0.5f) * spacing + jitter(), 0.16f + jitter(), (float(z) + 0.5f) * spacing + jitter()});
        velocities.insert(velocities.end(), {0, -1, 0});
      }
    loam_particles_def particles;
    scenes::require(loam_particles_def_default(&particles, sizeof particles), "default");
    particles.material = material;
    particles.count = positions.size() / 3;
    particles.positions = positions.data();
    particles.velocities = velocities.data();
    std::uint32_t first = 0;
    scenes::require(loam_particles_add(world.get(), &particles, &first), "add");
    for (int k = 0; k < 5; ++k) world.step(5e-3f);
  }
  for (int k = 0; k < 60; ++k) world.step(5e-3f);
  const auto now = world.snapshot();
  const double radius = test::quantile(now.positions, 3, 0.97), top = test::quantile(now.positions, 1, 0.995);
  return std::atan2(top, radius) / degree;
}

TEST(PouredHeap, IsSteeperTheGreaterTheFrictionAngle) {
  double before = 0;
  for (const float phi : {20.0f, 30.0f, 40.0f}) {
    const double slope = slope_of_heap(phi);
    RecordProperty("phi_" + std::to_string(int(phi)), std::to_string(slope));
    EXPECT_GT(slope, before + 2) << phi;
    before = slope;
  }
  // The control: with semi-implicit plasticity the smoothest sand stands steeper than the roughest should.
  const double jelly = slope_of_heap(20, LOAM_PLASTICITY_SEMI_IMPLICIT);
  RecordProperty("semi_implicit_20", std::to_string(jelly));
  EXPECT_GT(jelly, before);
}

} // namespace
} // namespace loam
