/* Cloth against closed forms, and its independence of iterations and substeps. */
#include <gtest/gtest.h>

#include "hanging_cloth.h"
#include "support/meshes.h"

namespace loam {
namespace {

using namespace test;

/* The corners, and what lies between. */
constexpr Accuracy accuracies[] = {{5, 1}, {100, 1}, {20, 3}, {5, 10}, {100, 10}};

/* rho g L^2 / (2 k), and the shear that the free edges add nothing to. */
TEST(ClothPhysics, AHangingSheetStretchesByItsWeight) {
  const double expected = 0.15 * 9.81 / (2 * 30.0);
  const double stretched = hanging_length({20, 16}, 30, 0) - 1;
  EXPECT_NEAR(stretched / expected, 1, 0.02);
  EXPECT_GT(std::fabs((hanging_length({20, 16}, 33, 0) - 1) / expected - 1), 0.05); // a stiffness 10 % off shows
}

TEST(ClothPhysics, AHangingSheetIsIndependentOfIterationsAndSubsteps) {
  for (const Accuracy &accuracy : accuracies) {
    const double hanging = hanging_length(accuracy, 3000, 0.005f);
    EXPECT_NEAR(hanging, 1, 0.0075) << accuracy.iterations << " iterations, " << accuracy.substeps << " substeps";
    RecordProperty(std::to_string(accuracy.iterations) + "x" + std::to_string(accuracy.substeps), std::to_string(hanging));
  }
  EXPECT_GT(hanging_length({5, 1}, 3000, 0), 1.03); // without threads
}

TEST(ClothPhysics, AStripHangsInACatenary) {
  for (const Accuracy &accuracy : accuracies) {
    const double measured = sag(accuracy);
    EXPECT_NEAR(measured / 0.3196, 1, 0.03) << accuracy.iterations << " iterations, " << accuracy.substeps << " substeps";
    RecordProperty(std::to_string(accuracy.iterations) + "x" + std::to_string(accuracy.substeps), std::to_string(measured));
  }
}

/* It is greatest in the row of triangles that all others hang on: (1 - 1/32) of weight over stiffness. */
TEST(ClothPhysics, TheStatisticsTellTheGreatestStretch) {
  double stretch = 0;
  Course course;
  course.step = [&](scenes::World &world, float seconds) {
    world.step(seconds);
    stretch = world.statistics().stretch;
  };
  (void)hanging_length({20, 16}, 30, 0, course);
  EXPECT_NEAR(stretch, (1 - 1.0 / 32) * 0.15 * 9.81 / 30, 0.002);
}

/* A strip clamped at one end, q L^3 / B = 1: the elastica's tip drops by .123 L, the chain of 16 hinges that it is here by .139 L. The grid's hinges give way to twisting
 * too, which makes it softer by up to a sixth. */
double tip_drop(float bending) {
  const Grid grid(17, 2, 0.01f);
  scenes::World world(cloths::world_def(30, 64));
  loam_cloth_def def = cloths::definition(grid);
  def.bending_stiffness = bending;
  const Cloth cloth(world.get(), def);
  std::vector<std::uint32_t> held = column(grid, 0), second = column(grid, 1);
  held.insert(held.end(), second.begin(), second.end());
  cloth.attach(held);
  cloth.set_wind(0, 0, 0, 20, 0);
  run(world, 0.5f);
  double sum = 0; // over the last half second, for it swings
  for (int frame = 0; frame < 30; ++frame) {
    scenes::require(loam_world_step(world.get(), 1.0f / 60), "loam_world_step");
    const Cloth::Vertices now = cloth.vertices();
    for (const std::uint32_t v : column(grid, grid.columns)) sum -= double(now.positions[3 * v + 1]);
  }
  return sum / (30 * 3);
}

TEST(ClothPhysics, AStripClampedAtOneEndBends) {
  const double length = 0.16, moment = 0.15 * 9.81 * length * length * length;
  EXPECT_NEAR(tip_drop(static_cast<float>(moment)) / length, 0.15, 0.02);
}

/* m g = 1/2 rho C_D A v^2 */
TEST(ClothPhysics, ASheetFallsAtTheSpeedThatItsDragAllows) {
  const Grid grid(8, 8, 0.05f);
  scenes::World world(cloths::world_def(5, 4));
  const Cloth cloth(world.get(), cloths::definition(grid));
  cloth.set_wind(0, 0, 0, 1.2f, 0);
  run(world, 3);
  const Cloth::Vertices now = cloth.vertices();
  EXPECT_NEAR(double(now.fastest()), std::sqrt(2 * 0.15 * 9.81 / (1.2 * 1.2)), 0.02);
}

/* A sheet of 1 m over a round bar of radius R: its ends hang 0.5 m - (R + thickness) pi / 2 below the bar's middle. */
struct Drape {
  double end, nearest;
};
Drape drape(const Accuracy &accuracy) {
  const Grid grid(32, 8, 1.0f / 32);
  scenes::World world(cloths::world_def(accuracy.iterations, accuracy.substeps));
  const meshes::Mesh bar = meshes::revolution({{0.0f, -0.5f}, {0.15f, -0.5f}, {0.15f, 0.5f}, {0.0f, 0.5f}}, 48);
  loam_collider_def collider;
  scenes::require(loam_collider_def_default(&collider, sizeof collider), "loam_collider_def_default");
  collider.kind = LOAM_COLLIDER_MESH;
  collider.mesh = bar.view();
  collider.rotation[0] = collider.rotation[3] = 0.70710678f; // its axis along z
  loam_collider_id id;
  scenes::require(loam_collider_create(world.get(), &collider, &id), "loam_collider_create");
  loam_cloth_def def = cloths::definition(grid);
  def.position[1] = 0.161f;
  def.thickness = 0.01f;
  const Cloth cloth(world.get(), def);
  cloth.set_wind(0, 0, 0, 2, 0);
  run(world, 3);
  const Cloth::Vertices now = cloth.vertices();
  Drape result = {0, 1};
  for (std::uint32_t j = 0; j <= grid.rows; ++j)
    for (const std::uint32_t i : {0u, grid.columns})
      result.end += double(now.positions[3 * grid.at(i, j) + 1]) / (2 * (grid.rows + 1));
  for (std::size_t i = 0; i < now.count(); ++i) {
    const double x = double(now.positions[3 * i]), y = double(now.positions[3 * i + 1]);
    result.nearest = std::min(result.nearest, std::sqrt(x * x + y * y));
  }
  return result;
}

TEST(ClothPhysics, ADrapeIsIndependentOfIterationsAndSubsteps) {
  const double expected = 0.5 - 0.16 * 1.5707963;
  for (const Accuracy &accuracy : accuracies) {
    const Drape measured = drape(accuracy);
    EXPECT_NEAR(-measured.end / expected, 1, 0.03)
        << accuracy.iterations << " iterations, " << accuracy.substeps << " substeps";
    EXPECT_GT(measured.nearest, 0.155) << accuracy.iterations << " iterations, " << accuracy.substeps << " substeps";
    RecordProperty(std::to_string(accuracy.iterations) + "x" + std::to_string(accuracy.substeps),
                   std::to_string(-measured.end));
  }
}

TEST(ClothPhysics, AFreeClothKeepsItsMomentum) {
  const Grid grid(12, 12, 0.02f);
  loam_world_def world_def = cloths::world_def(10, 4);
  world_def.gravity[1] = 0;
  scenes::World world(world_def);
  loam_cloth_def def = cloths::definition(grid);
  def.velocity[0] = 1;
  const Cloth cloth(world.get(), def);
  const std::vector<std::uint32_t> corner = {grid.at(0, 0)};
  cloth.attach(corner); // a jerk, so that there is something to conserve
  run(world, 0.1f);
  scenes::require(loam_cloth_release(world.get(), cloth.id, corner.data(), 1), "loam_cloth_release");
  const auto momentum = [&](double sum[3]) {
    const Cloth::Vertices now = cloth.vertices();
    double size = 0;
    for (std::size_t i = 0; i < now.count(); ++i)
      for (std::size_t k = 0; k < 3; ++k) {
        const double p = double(now.velocities[3 * i + k]) / double(now.inverse_masses[i]);
        sum[k] += p;
        size += std::fabs(p);
      }
    return size;
  };
  double before[3] = {}, after[3] = {};
  const double size = momentum(before);
  ASSERT_GT(size, 1e-4);
  run(world, 0.5f);
  momentum(after);
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(after[k], before[k], 1e-5 * size);
}

} // namespace
} // namespace loam
