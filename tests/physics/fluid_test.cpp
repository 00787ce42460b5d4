/* Water at rest, a dam that breaks, and water against sand. */
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

#include "dam.h"

namespace loam {
namespace {

using namespace test;

class Water : public testing::TestWithParam<std::uint32_t> {};
INSTANTIATE_TEST_SUITE_P(Solvers, Water, testing::Values(LOAM_SOLVER_GAUSS_SEIDEL, LOAM_SOLVER_JACOBI),
                         [](const auto &info) { return info.param == LOAM_SOLVER_JACOBI ? "Jacobi" : "GaussSeidel"; });

/* The greatest deviation of the mean pressure of a layer from rho g (H - y), over that of the ground. */
double pressure_error(const Tank &tank, double height) {
  constexpr int layers = 6;
  double sums[layers] = {}, counts[layers] = {}, depths[layers] = {};
  for (const Tank::Drop &drop : tank.drops()) {
    const int layer = std::min(layers - 1, int(double(drop.height) / height * layers));
    sums[layer] += double(drop.pressure);
    depths[layer] += height - double(drop.height);
    ++counts[layer];
  }
  double error = 0;
  for (int k = 0; k < layers - 1; ++k) // in the highest one the surface is
    error = std::max(error, std::abs(sums[k] / counts[k] - 9810 * depths[k] / counts[k]) / (9810 * height));
  return error;
}

TEST_P(Water, AtRestKeepsItsVolumeItsDensityAndItsPressure) {
  Tank tank({8, 12, 8, 8}, GetParam(), 4);
  tank.world.step(1.0f / 120);
  EXPECT_GT(pressure_error(tank, 0.12), 0.05); // it takes a few steps
  for (int k = 0; k < 90; ++k) tank.world.step(1.0f / 120);
  const double height = 2 * tank.mean_height();
  RecordProperty("height", std::to_string(height));
  EXPECT_NEAR(height, 0.12, 0.0024);
  const double low = tank.density(0.02), high = tank.density(0.98);
  RecordProperty("low", std::to_string(low));
  RecordProperty("high", std::to_string(high));
  EXPECT_GT(low, 980);
  EXPECT_LT(high, 1020);
  RecordProperty("pressure_error", std::to_string(pressure_error(tank, height)));
  EXPECT_LT(pressure_error(tank, height), 0.05);
  EXPECT_EQ(tank.world.statistics().non_finite, 0u);
  EXPECT_EQ(tank.world.statistics().speed_limited, 0u);
}

/* Made too dense it parts without taking up speed: it rises to what it is at rest and stays there, and the energy is that of the start or, as it rises, of
 * rest at its density. */
TEST_P(Water, MadeTooDenseRisesToItsDensityAndGainsNoEnergy) {
  for (const float compression : {0.2f, 0.5f})
    for (const float substep : {1e-4f, 1.0f / 960, 1.0f / 480}) {
      if (compression < 0.5f && substep != 1.0f / 960) continue;
      const Block block = {6, 8, 6, 6, compression};
      Tank tank(block, GetParam(), 4);
      const double start = tank.energy(), rest = start / double(1 - compression);
      double most = 0, highest = 0, lost = 0;
      for (int k = 0; k < (substep < 5e-4f ? 200 : int(0.4f / (4 * substep))); ++k) {
        tank.world.step(4 * substep);
        most = std::max(most, tank.energy());
        const double height = tank.mean_height();
        highest = std::max(highest, height);
        lost = std::max(lost, highest - height);
      }
      const std::string which = std::to_string(int(100 * compression)) + "_" + std::to_string(int(1e6f * substep));
      RecordProperty("most_" + which, std::to_string(most / rest));
      RecordProperty("lost_" + which, std::to_string(lost / rest));
      RecordProperty("height_" + which, std::to_string(tank.mean_height() / rest));
      EXPECT_LT(most, 1.02 * rest) << which;
      EXPECT_LT(lost, 0.02 * rest) << which;
      EXPECT_NEAR(tank.mean_height(), rest, 0.02 * rest) << which;
      EXPECT_LT(tank.density(0.98), 1020) << which;
    }
}

TEST_P(Water, ADamBreaksAsMeasured) {
  const Front front = break_dam(LOAM_LAW_FLUID, GetParam());
  RecordProperty("error", std::to_string(greatest_error(front, measured)));
  RecordProperty("error_again", std::to_string(greatest_error(front, measured_again)));
  RecordProperty("shift", std::to_string(measured[0].first - time_of(front, measured[0].second)));
  EXPECT_LT(greatest_error(front, measured), 0.1);
  EXPECT_LT(greatest_error(front, measured_again), 0.1);
}
TEST(Sand, IsNoWater) {
  const Front front = break_dam(LOAM_LAW_DRUCKER_PRAGER, LOAM_SOLVER_GAUSS_SEIDEL);
  EXPECT_GT(greatest_error(front, measured), 0.1);
  EXPECT_GT(greatest_error(front, measured_again), 0.1);
}

/* Water with sand in it, and a jet of both against each other, without gravity or colliders. */
TEST_P(Water, AndSandKeepTheirMomentum) {
  for (const float density : {160.0f, 16000.0f}) {
    scenes::Scene sand = scenes::drop_block(scenes::sand(), 5, 0);
    sand.material.density = density;
    sand.planes.clear();
    scenes::Scene water;
    scenes::require(loam_material_def_default(LOAM_LAW_FLUID, &water.material, sizeof water.material), "default");
    water.spacing = Tank::radius;
    for (std::size_t i = 0; i < sand.positions.size(); i += 3) {
      const float *x = sand.positions.data() + i;
      water.positions.insert(water.positions.end(), {x[0] + 0.055f, x[1] + 0.003f, x[2] + 0.004f});
      water.velocities.insert(water.velocities.end(), {-2, 0.5f, 0.1f});
    }
    loam_world_def def = scenes::world_def(sand);
    def.particle_capacity = sand.count() + water.count();
    def.solver = GetParam();
    def.substeps = 8;
    def.gravity[1] = 0;
    scenes::World world(def, sand);
    world.add(water);
    world.step(1e-6f);
    const loam_statistics before = world.statistics();
    double scale = 0;
    for (const double p : before.momentum) scale = std::max(scale, std::abs(p));
    for (int k = 0; k < 15; ++k) world.step(1.0f / 240);
    const loam_statistics after = world.statistics();
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(after.momentum[k], before.momentum[k], 1e-5 * scale) << density;
    EXPECT_EQ(after.speed_limited, 0u) << density;
    EXPECT_LE(after.kinetic_energy, 1.01 * before.kinetic_energy) << density;
    // and they did meet
    const scenes::Snapshot now = world.snapshot();
    double sand_speed = 0;
    for (std::size_t i = 0; i < sand.count(); ++i) sand_speed += double(now.velocities[3 * i]) / double(sand.count());
    RecordProperty("sand_" + std::to_string(int(density)), std::to_string(sand_speed));
    EXPECT_LT(sand_speed, -0.02) << density;
  }
}

/* What a world without fluid has of it: nothing. */
TEST(NoWater, NoStageAndNoMemory) {
  const auto stages_of = [](const scenes::World &world) {
    std::size_t count = 0;
    for (const loam_stage &stage : world.stages())
      count += std::string(stage.name).find("fluid") != std::string::npos ? 1 : 0;
    return count;
  };
  const scenes::Scene sand = scenes::drop_block(scenes::sand(), 5, 0);
  loam_world_def def = scenes::world_def(sand);
  def.particle_capacity += 1;
  scenes::World world(def, sand);
  world.step(1e-3f);
  EXPECT_EQ(stages_of(world), 0u);
  const std::uint64_t without = world.memory_bytes();
  scenes::Scene water = sand;
  scenes::require(loam_material_def_default(LOAM_LAW_FLUID, &water.material, sizeof water.material), "default");
  water.planes.clear();
  water.positions = {0, 1, 0};
  world.add(water);
  world.step(1e-3f);
  EXPECT_EQ(stages_of(world), 2u);
  EXPECT_GT(world.memory_bytes(), without);
  const std::uint32_t id = std::uint32_t(sand.count());
  scenes::require(loam_particles_remove(world.get(), &id, 1), "remove");
  world.step(1e-3f);
  EXPECT_EQ(stages_of(world), 0u);
}

} // namespace
} // namespace loam
