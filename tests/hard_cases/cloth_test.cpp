/* What cloth must survive: finite, above the floor, and without more energy than it was given. */
#include <numeric>

#include <gtest/gtest.h>

#include "support/cloths.h"
#include "support/meshes.h"

namespace loam {
namespace {

using cloths::Cloth;
using cloths::Grid;

loam_collider_id add_floor(loam_world *world) {
  loam_collider_def floor;
  scenes::require(loam_collider_def_default(&floor, sizeof floor), "loam_collider_def_default");
  loam_collider_id id;
  scenes::require(loam_collider_create(world, &floor, &id), "loam_collider_create");
  return id;
}

/* J, with the height above y = 0 */
double energy(const Cloth::Vertices &now) {
  double sum = 0;
  for (std::size_t i = 0; i < now.count(); ++i) {
    if (now.inverse_masses[i] == 0) continue;
    const float *v = &now.velocities[3 * i];
    sum += (0.5 * double(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) + 9.81 * double(now.positions[3 * i + 1])) /
           double(now.inverse_masses[i]);
  }
  return sum;
}

TEST(ClothHardCases, AnImpactAtAHundredMetresASecondInOneLongSubstep) {
  for (const std::uint32_t substeps : {1u, 16u}) {
    const Grid grid(20, 20, 0.02f);
    scenes::World world(cloths::world_def(5, substeps));
    add_floor(world.get());
    loam_cloth_def def = cloths::definition(grid);
    def.position[1] = 0.5f;
    def.velocity[1] = -100;
    const Cloth cloth(world.get(), def);
    const double before = energy(cloth.vertices());
    for (int frame = 0; frame < 60; ++frame) {
      world.step(1.0f / 60);
      const Cloth::Vertices now = cloth.vertices();
      ASSERT_TRUE(now.finite()) << substeps << ", frame " << frame;
      ASSERT_GT(now.lowest(), 0) << substeps << ", frame " << frame;
      ASSERT_LT(energy(now), before) << substeps << ", frame " << frame;
    }
    EXPECT_LT(cloth.vertices().fastest(), 2) << substeps;
  }
}

/* Every stiffness at the end of its range, and the shortest and the longest step. */
TEST(ClothHardCases, AnyMaterialInAnyStep) {
  const Grid grid(8, 8, 0.02f);
  for (const float stiffness : {1e-3f, 1e3f, 1e9f})
    for (const float damping : {0.0f, 10.0f})
      for (const float seconds : {1e-5f, 1.0f / 60, 1.0f}) {
        scenes::World world(cloths::world_def(5, 1));
        add_floor(world.get());
        loam_cloth_def def = cloths::definition(grid);
        def.position[1] = 0.1f;
        def.stretch_stiffness = def.shear_stiffness = stiffness;
        def.bending_stiffness = std::min(stiffness, 1e6f);
        def.damping = damping;
        def.greatest_stretch = stiffness < 1 ? 0.0f : 0.01f;
        const Cloth cloth(world.get(), def);
        cloth.attach({0, 8});
        for (int frame = 0; frame < 20; ++frame) world.step(seconds);
        const Cloth::Vertices now = cloth.vertices();
        EXPECT_TRUE(now.finite()) << stiffness << " N/m, " << damping << " s, step " << seconds;
        EXPECT_LT(now.fastest(), 40) << stiffness << " N/m, " << damping << " s, step " << seconds;
      }
}

/* Attached farther apart than it can be long; all vertices at one point; two cloths in one place. */
TEST(ClothHardCases, ImpossibleAttachments) {
  const Grid grid(10, 10, 0.02f);
  scenes::World world(cloths::world_def(5, 2));
  const Cloth torn(world.get(), cloths::definition(grid)), crushed(world.get(), cloths::definition(grid));
  torn.attach({grid.at(0, 5), grid.at(10, 5)}, {-0.5f, 0, 0, 0.5f, 0, 0});
  std::vector<std::uint32_t> all;
  for (std::uint32_t i = 0; i < 121; ++i) all.push_back(i);
  crushed.attach(all, std::vector<float>(3 * 121, 0.1f));
  for (int frame = 0; frame < 120; ++frame) world.step(1.0f / 60);
  EXPECT_TRUE(torn.vertices().finite());
  EXPECT_LT(torn.vertices().fastest(), 20);
  scenes::require(loam_cloth_release(world.get(), crushed.id, all.data(), 121), "loam_cloth_release");
  for (int frame = 0; frame < 30; ++frame) world.step(1.0f / 60);
  EXPECT_TRUE(crushed.vertices().finite());
  EXPECT_LT(crushed.vertices().fastest(), 40);
}

/* A step that failed for want of room leaves lists half made. Without particles there is nobody whom they may be asked about. */
TEST(ClothHardCases, AloneAfterAStepThatFailedAndAllParticlesAreGone) {
  const scenes::Scene sand = scenes::jittered_block(scenes::sand(), 500);
  loam_world_def def = scenes::world_def(sand);
  def.pair_capacity = 32;
  def.sleep_speed = 0.1f;
  scenes::World world(def, sand);
  EXPECT_EQ(loam_world_step(world.get(), 1.0f / 60), LOAM_ERROR_CAPACITY);
  std::vector<std::uint32_t> ids(sand.count());
  std::iota(ids.begin(), ids.end(), 0u);
  scenes::require(loam_particles_remove(world.get(), ids.data(), ids.size()), "loam_particles_remove");
  const Grid grid(8, 8, 0.02f);
  loam_cloth_def sheet = cloths::definition(grid);
  sheet.position[1] = 0.5f;
  const Cloth cloth(world.get(), sheet);
  for (int frame = 0; frame < 3; ++frame) world.step(1.0f / 60);
  EXPECT_TRUE(cloth.vertices().finite());
  EXPECT_LT(cloth.vertices().lowest(), 0.49); // it falls
}

/* A collider that is driven through a hanging sheet takes it along; nothing passes. */
TEST(ClothHardCases, ABallDrivenIntoASheet) {
  const Grid grid(24, 24, 1.0f / 24, true);
  scenes::World world(cloths::world_def(5, 8));
  const meshes::Mesh ball = meshes::icosphere(0.15f, 2);
  loam_collider_def collider;
  scenes::require(loam_collider_def_default(&collider, sizeof collider), "loam_collider_def_default");
  collider.kind = LOAM_COLLIDER_MESH;
  collider.mesh = ball.view();
  collider.position[1] = -0.6f;
  collider.position[2] = -0.3f;
  loam_collider_id id;
  scenes::require(loam_collider_create(world.get(), &collider, &id), "loam_collider_create");
  loam_cloth_def def = cloths::definition(grid);
  def.thickness = 0.01f;
  const Cloth cloth(world.get(), def);
  std::vector<std::uint32_t> top;
  for (std::uint32_t i = 0; i <= 24; ++i) top.push_back(i);
  cloth.attach(top);
  for (int frame = 0; frame < 40; ++frame) { // 1.5 m/s
    const float position[] = {0, -0.6f, -0.3f + 0.025f * static_cast<float>(frame)}, rotation[] = {0, 0, 0, 1};
    scenes::require(loam_collider_move(world.get(), id, position, rotation), "loam_collider_move");
    world.step(1.0f / 60);
    const Cloth::Vertices now = cloth.vertices();
    ASSERT_TRUE(now.finite());
    for (std::size_t i = 0; i < now.count(); ++i) {
      const float *x = &now.positions[3 * i];
      const double distance =
          std::sqrt(double(x[0]) * x[0] + std::pow(double(x[1] - position[1]), 2) + std::pow(double(x[2] - position[2]), 2));
      ASSERT_GT(distance, 0.138) << "frame " << frame << ", vertex " << i; // the ball's facets lie up to 0.012 inside it
    }
  }
}

} // namespace
} // namespace loam
