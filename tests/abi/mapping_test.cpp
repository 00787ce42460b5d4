/* Mapped buffers: what they hold, and what is refused while they are out. */
#include <set>

#include "small_world.h"

namespace loam {
namespace {

using test::SmallWorld;

loam_particle_view empty_view() {
  loam_particle_view view = {};
  view.struct_size = sizeof view;
  return view;
}

TEST_F(SmallWorld, AViewShowsTheParticles) {
  loam_particle_view view = empty_view();
  ASSERT_EQ(loam_particles_map(world(), &view), LOAM_OK);
  EXPECT_EQ(view.count, 64u);
  EXPECT_EQ(view.memory, unsigned(LOAM_MEMORY_HOST));
  std::set<std::uint32_t> ids;
  for (std::uint64_t i = 0; i < view.count; ++i) {
    ids.insert(view.ids[i]);
    EXPECT_EQ(view.materials[i], 0u); // the first material of the world
    const float volume = view.positions[4 * i + 3], inverse_mass = view.velocities[4 * i + 3];
    EXPECT_NEAR(view.densities[i] * volume * inverse_mass, 1, 1e-6);
    EXPECT_NEAR(view.densities[i], 1600, 160);
  }
  EXPECT_EQ(ids.size(), 64u);
  EXPECT_EQ(*ids.rbegin(), 63u);
  EXPECT_EQ(loam_particles_unmap(world()), LOAM_OK);
}

TEST_F(SmallWorld, WhatWouldChangeTheParticlesIsRefusedWhileTheyAreMapped) {
  loam_particle_view view = empty_view(), second = empty_view();
  ASSERT_EQ(loam_particles_map(world(), &view), LOAM_OK);
  loam_particles_def add;
  loam_fill_def fill;
  ASSERT_EQ(loam_particles_def_default(&add, sizeof add), LOAM_OK);
  ASSERT_EQ(loam_fill_def_default(&fill, sizeof fill), LOAM_OK);
  const float place[3] = {0, 1, 0};
  add.count = 1;
  add.positions = place;
  add.material = fill.material = material_;
  fill.region.kind = LOAM_REGION_SPHERE;
  fill.region.radius = 0.01f;
  const auto in_use = [&](auto &&call) { refused(LOAM_ERROR_IN_USE, {"map"}, call); };
  in_use([&] { return loam_world_step(world(), 0.01f); });
  in_use([&] { return loam_particles_add(world(), &add, nullptr); });
  in_use([&] { return loam_particles_fill(world(), &fill, nullptr); });
  in_use([&] { return loam_particles_map(world(), &second); });

  // Asking is allowed.
  EXPECT_EQ(world_.statistics().particles, 64u);
  EXPECT_GT(world_.stages().size(), 0u);

  EXPECT_EQ(loam_particles_unmap(world()), LOAM_OK);
  invalid({"mapped"}, [&] { return loam_particles_unmap(world()); });
  EXPECT_EQ(loam_world_step(world(), 0.01f), LOAM_OK);
  EXPECT_EQ(loam_particles_add(world(), &add, nullptr), LOAM_OK);
}

TEST_F(SmallWorld, AnEmptyWorldMapsToNothing) {
  const scenes::World empty(definition(scene_));
  loam_particle_view view = empty_view();
  ASSERT_EQ(loam_particles_map(empty.get(), &view), LOAM_OK);
  EXPECT_EQ(view.count, 0u);
  EXPECT_EQ(loam_particles_unmap(empty.get()), LOAM_OK);
  EXPECT_EQ(loam_world_step(empty.get(), 0.01f), LOAM_OK);
}

TEST_F(SmallWorld, AWorldMayBeDestroyedWhileItIsMapped) {
  scenes::World other(definition(scene_), scene_);
  loam_particle_view view = empty_view();
  EXPECT_EQ(loam_particles_map(other.get(), &view), LOAM_OK);
}

} // namespace
} // namespace loam
