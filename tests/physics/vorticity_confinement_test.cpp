/* Vorticity confinement: eddies last longer, on what the motion has lost; and what it leaves alone. */
#include <algorithm>
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

#include "support/scenes.h"

namespace loam {
namespace {

constexpr float r = 0.01f;
constexpr float pi = std::numbers::pi_v<float>;

class VorticityConfinement : public testing::TestWithParam<std::uint32_t> {};
INSTANTIATE_TEST_SUITE_P(Solvers, VorticityConfinement, testing::Values(LOAM_SOLVER_GAUSS_SEIDEL, LOAM_SOLVER_JACOBI),
                         [](const auto &info) { return info.param == LOAM_SOLVER_JACOBI ? "Jacobi" : "GaussSeidel"; });

/* Water of nx x ny x nz particles from the origin on, moved at random a little, with a velocity for each place. */
template <class F> scenes::Scene block(float confinement, int nx, int ny, int nz, F &&velocity) {
  scenes::Scene water;
  scenes::require(loam_material_def_default(LOAM_LAW_FLUID, &water.material, sizeof water.material), "default");
  water.material.vorticity_confinement = confinement;
  water.spacing = r;
  for (int i = 0; i < nx; ++i)
    for (int j = 0; j < ny; ++j)
      for (int k = 0; k < nz; ++k) {
        const float n = float((i * ny + j) * nz + k);
        const std::array<float, 3> x = {r * (float(i) + 0.5f + 0.1f * std::sin(1e3f * n)),
                                        r * (float(j) + 0.5f + 0.1f * std::sin(2e3f * n)),
                                        r * (float(k) + 0.5f + 0.1f * std::sin(3e3f * n))};
        const std::array<float, 3> v = velocity(x);
        water.positions.insert(water.positions.end(), x.begin(), x.end());
        water.velocities.insert(water.velocities.end(), v.begin(), v.end());
      }
  return water;
}

scenes::World world_of(const scenes::Scene &scene, std::uint32_t solver, std::uint32_t substeps, float gravity = 0) {
  loam_world_def def = scenes::world_def(scene);
  def.solver = solver;
  def.substeps = substeps;
  def.gravity[0] = def.gravity[2] = 0;
  def.gravity[1] = -gravity;
  return scenes::World(def, scene);
}

/* One eddy of Taylor and Green's in a closed box whose walls have no friction, of n x n x 4 particles. */
constexpr int across = 14;
constexpr float width = across * r;
std::array<float, 3> eddy(const std::array<float, 3> &x, float speed) {
  const float a = pi * x[0] / width, b = pi * x[1] / width;
  return {speed * std::sin(a) * std::cos(b), -speed * std::cos(a) * std::sin(b), 0};
}
scenes::Scene box_with_an_eddy(float confinement, float speed) {
  scenes::Scene scene = block(confinement, across, across, 4, [&](const std::array<float, 3> &x) { return eddy(x, speed); });
  scene.planes = {{{0, 0, 0}, {1, 0, 0}, 0},      {{width, 0, 0}, {-1, 0, 0}, 0}, {{0, 0, 0}, {0, 1, 0}, 0},
                  {{0, width, 0}, {0, -1, 0}, 0}, {{0, 0, 0}, {0, 0, 1}, 0},      {{0, 0, 4 * r}, {0, 0, -1}, 0}};
  return scene;
}

/* How much of the eddy there is. */
double swirl(const scenes::World &world) {
  const scenes::Snapshot now = world.snapshot();
  double sum = 0, squares = 0;
  for (std::size_t i = 0; i < now.positions.size(); i += 3) {
    const std::array<float, 3> v = eddy({now.positions[i], now.positions[i + 1], now.positions[i + 2]}, 1);
    for (std::size_t k = 0; k < 2; ++k) {
      sum += double(v[k] * now.velocities[i + k]);
      squares += double(v[k] * v[k]);
    }
  }
  return sum / squares;
}

/* Half a second of an eddy, in which it turns about once. */
TEST_P(VorticityConfinement, AnEddyLastsLonger) {
  double swirls[3], energies[3];
  for (int i = 0; i < 3; ++i) {
    scenes::World world = world_of(box_with_an_eddy(0.5f * float(i), 0.5f), GetParam(), 4);
    const double before = swirl(world);
    for (int step = 0; step < 60; ++step) world.step(1.0f / 120);
    swirls[i] = swirl(world) / before;
    energies[i] = world.statistics().kinetic_energy;
    RecordProperty("swirl_" + std::to_string(i), std::to_string(swirls[i]));
    RecordProperty("energy_" + std::to_string(i), std::to_string(energies[i]));
    EXPECT_EQ(world.statistics().non_finite, 0u);
  }
  EXPECT_GT(swirls[1], swirls[0]);
  EXPECT_GT(swirls[2], 1.1 * swirls[0]);
  EXPECT_GT(energies[1], 1.02 * energies[0]);
  EXPECT_GT(energies[2], 1.2 * energies[0]);
  EXPECT_LT(swirls[2], 1);
}

/* All of what is lost given back, from the longest step to short ones, and faster than particles can go: energy does not grow. */
TEST_P(VorticityConfinement, GainsNoEnergy) {
  for (const auto &[seconds, substeps, speed] : {std::tuple(1.0f / 60, 1u, 0.5f), std::tuple(1.0f / 60, 1u, 5.0f),
                                                 std::tuple(1.0f / 60, 16u, 1.0f), std::tuple(1e-3f, 1u, 0.05f)}) {
    scenes::World world = world_of(box_with_an_eddy(1, speed), GetParam(), substeps);
    for (int step = 0; step < 2; ++step) world.step(seconds); // what was compressed at the start lets go
    double energy = world.statistics().kinetic_energy, most = 0;
    for (int step = 0; step < 12; ++step) {
      world.step(seconds);
      const double now = world.statistics().kinetic_energy;
      most = std::max(most, now / energy);
      energy = now;
      EXPECT_EQ(world.statistics().non_finite, 0u);
    }
    RecordProperty("most_" + std::to_string(substeps) + "_" + std::to_string(speed), std::to_string(most));
    EXPECT_LT(most, 1.001) << seconds << " " << substeps << " " << speed;
  }
}

/* Two blocks that meet off their centres, without walls. */
TEST_P(VorticityConfinement, KeepsMomentumInACollision) {
  struct Motion {
    std::array<double, 3> momentum = {}, angular = {};
    double size = 0, energy = 0;
  };
  Motion last[2];
  for (int i = 0; i < 2; ++i) {
    const scenes::Scene one = block(float(i), 6, 8, 6, [](const auto &) { return std::array<float, 3>{1, 0.2f, 0}; });
    scenes::Scene water = one;
    for (std::size_t k = 0; k < one.positions.size(); k += 3) {
      water.positions.insert(water.positions.end(),
                             {one.positions[k] + 6.5f * r, one.positions[k + 1] + 4 * r, one.positions[k + 2]});
      water.velocities.insert(water.velocities.end(), {-0.8f, 0, 0});
    }
    scenes::World world = world_of(water, GetParam(), 4);
    const auto motion = [&] {
      const scenes::Snapshot now = world.snapshot();
      Motion all;
      for (std::size_t p = 0; p < now.count(); ++p) {
        const float *x = &now.positions[3 * p], *v = &now.velocities[3 * p];
        const double mass = 1 / double(now.inverse_masses[p]);
        for (std::size_t k = 0; k < 3; ++k) {
          const std::size_t l = (k + 1) % 3, m = (k + 2) % 3;
          all.momentum[k] += mass * double(v[k]);
          all.angular[k] += mass * (double(x[l]) * double(v[m]) - double(x[m]) * double(v[l]));
          all.size += mass * std::fabs(double(v[k]));
          all.energy += 0.5 * mass * double(v[k]) * double(v[k]);
        }
      }
      return all;
    };
    const Motion before = motion();
    for (int step = 0; step < 20; ++step) world.step(1.0f / 240);
    last[i] = motion();
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(last[i].momentum[k], before.momentum[k], 1e-5 * before.size) << k;
    RecordProperty("angular_" + std::to_string(i), std::to_string(last[i].angular[2] / before.angular[2]));
    EXPECT_NEAR(last[i].angular[2], before.angular[2], 0.03 * std::fabs(before.angular[2]));
  }
  EXPECT_GT(last[1].energy, 1.001 * last[0].energy) << "it has done something";
}

/* The greatest difference that it makes to a velocity in the middle. */
double difference(std::uint32_t solver, const scenes::Scene &scene, int steps, float gravity) {
  std::vector<float> velocities[2];
  std::vector<float> positions;
  for (int i = 0; i < 2; ++i) {
    scenes::Scene water = scene;
    water.material.vorticity_confinement = float(i);
    scenes::World world = world_of(water, solver, 4, gravity);
    for (int step = 0; step < steps; ++step) world.step(1.0f / 120);
    const scenes::Snapshot now = world.snapshot();
    velocities[i] = now.velocities;
    positions = now.positions;
  }
  double most = 0;
  for (std::size_t k = 0; k < velocities[0].size(); ++k)
    most = std::max(most, std::fabs(double(velocities[1][k] - velocities[0][k])));
  return most;
}

TEST_P(VorticityConfinement, LeavesFreeFallAndRotationAlone) {
  const scenes::Scene moves = block(0, 8, 8, 8, [](const auto &) { return std::array<float, 3>{0.5f, 0.2f, -1}; });
  EXPECT_LT(difference(GetParam(), moves, 6, 9.81f), 1e-3);
  const scenes::Scene turns = block(0, 8, 8, 8, [](const std::array<float, 3> &x) {
    return std::array<float, 3>{4 * (x[1] - 4 * r), -4 * (x[0] - 4 * r), 0};
  });
  const double turned = difference(GetParam(), turns, 6, 0);
  RecordProperty("turned", std::to_string(turned));
  EXPECT_LT(turned, 0.01 * 4 * 5.6 * double(r));
}

/* What particles of water do in an open tank in which it was stirred, a second and a half later: no more than without it. */
TEST_P(VorticityConfinement, ComesToRest) {
  double speeds[2], heights[2] = {};
  for (int i = 0; i < 2; ++i) {
    scenes::Scene scene = box_with_an_eddy(float(i), 0.5f);
    scene.planes.erase(scene.planes.begin() + 3);
    scenes::World world = world_of(scene, GetParam(), 4, 9.81f);
    for (int step = 0; step < 180; ++step) world.step(1.0f / 120);
    speeds[i] = world.statistics().mean_speed;
    const scenes::Snapshot now = world.snapshot();
    for (std::size_t k = 1; k < now.positions.size(); k += 3) heights[i] += double(now.positions[k]) / double(now.count());
    RecordProperty("speed_" + std::to_string(i), std::to_string(speeds[i]));
    RecordProperty("height_" + std::to_string(i), std::to_string(heights[i]));
  }
  EXPECT_LT(speeds[1], 1.5 * speeds[0]);
  EXPECT_NEAR(heights[1], heights[0], 0.01 * heights[0]);
}

/* What fluid without it has of it: nothing. */
TEST(NoVorticityConfinement, NoStageAndNoMemory) {
  std::uint64_t bytes[2];
  for (int i = 0; i < 2; ++i) {
    scenes::World world = world_of(box_with_an_eddy(float(i), 0.5f), LOAM_SOLVER_GAUSS_SEIDEL, 1);
    world.step(1e-3f);
    EXPECT_EQ(world.has_stage("vorticity confinement"), i == 1);
    bytes[i] = world.memory_bytes();
  }
  EXPECT_GT(bytes[1], bytes[0]);
}

} // namespace
} // namespace loam
