/* What a fluid's viscosity does: the rate at which shear dies out, and what it leaves alone. */
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>
#include <numeric>

#include "support/scenes.h"

namespace loam {
namespace {

constexpr float r = 0.01f;
constexpr float edge = 12;
constexpr double pi = std::numbers::pi;

class Viscosity : public testing::TestWithParam<std::uint32_t> {};
INSTANTIATE_TEST_SUITE_P(Solvers, Viscosity, testing::Values(LOAM_SOLVER_GAUSS_SEIDEL, LOAM_SOLVER_JACOBI),
                         [](const auto &info) { return info.param == LOAM_SOLVER_JACOBI ? "Jacobi" : "GaussSeidel"; });

/* A cube of fluid around the origin, without gravity. */
class Cube {
public:
  Cube(float viscosity, std::uint32_t solver, std::uint32_t substeps) {
    scenes::Scene none;
    scenes::require(loam_material_def_default(LOAM_LAW_FLUID, &none.material, sizeof none.material), "default");
    none.material.viscosity = viscosity;
    none.spacing = r;
    loam_world_def def = scenes::world_def(none);
    def.particle_capacity = 4000;
    def.solver = solver;
    def.substeps = substeps;
    for (float &g : def.gravity) g = 0;
    world = scenes::World(def);
    loam_fill_def fill;
    scenes::require(loam_fill_def_default(&fill, sizeof fill), "fill");
    scenes::require(loam_material_create(world.get(), &none.material, &fill.material), "material");
    fill.region.kind = LOAM_REGION_BOX;
    for (float &half : fill.region.half_extents) half = 0.5f * edge * r;
    scenes::require(loam_particles_fill(world.get(), &fill, nullptr), "fill");
  }
  /* `velocity` fills in v at x. */
  template <class F> void set_velocities(F &&velocity) {
    scenes::Snapshot now = world.snapshot();
    std::vector<std::uint32_t> ids(now.count());
    std::iota(ids.begin(), ids.end(), 0u);
    for (std::size_t i = 0; i < now.count(); ++i) velocity(&now.positions[3 * i], &now.velocities[3 * i]);
    scenes::require(loam_particles_move(world.get(), ids.data(), ids.size(), nullptr, now.velocities.data()), "move");
  }
  scenes::World world{[] {
    loam_world_def def;
    scenes::require(loam_world_def_default(&def, sizeof def), "default");
    def.particle_capacity = 1;
    return def;
  }()};
};

/* The rate over that of water, 1e-6 k^2, at which v = U cos(k . x) along `along` dies out, of a wave with a whole length in the cube, seen in its middle. */
double decay(float viscosity, std::uint32_t solver, std::uint32_t substeps, int direction, int along, float seconds) {
  constexpr float speed = 0.01f, k = float(2 * pi) / (edge * r);
  const auto wave = [&](const float *x) { return std::cos(k * x[direction]); };
  Cube cube(viscosity, solver, substeps);
  for (int i = 0; i < 4; ++i) cube.world.step(1.0f / 60); // it settles
  cube.set_velocities([&](const float *x, float *v) {
    for (int i = 0; i < 3; ++i) v[i] = i == along ? speed * wave(x) : 0;
  });
  const auto amplitude = [&] {
    const scenes::Snapshot now = cube.world.snapshot();
    double sum = 0, squares = 0;
    for (std::size_t i = 0; i < now.count(); ++i) {
      const float *x = &now.positions[3 * i];
      if (std::abs(x[(direction + 1) % 3]) > 2.5f * r || std::abs(x[(direction + 2) % 3]) > 2.5f * r) continue;
      sum += double(now.velocities[3 * i + std::size_t(along)] * wave(x));
      squares += double(wave(x) * wave(x));
    }
    return sum / squares;
  };
  const double before = amplitude();
  cube.world.step(seconds);
  return std::log(before / amplitude()) / double(1e-6f * k * k * seconds);
}

TEST_P(Viscosity, AShearWaveDiesOutAtItsRateWhateverTheSubstep) {
  for (const float viscosity : {0.1f, 10.0f}) {
    const double nu = 1e-3 * double(viscosity);
    const auto seconds = float(0.5 * double(r) * double(r) / nu);
    double rates[2];
    for (int i = 0; i < 2; ++i) {
      rates[i] = decay(viscosity, GetParam(), i == 0 ? 1 : 8, i == 0 ? 2 : 0, i == 0 ? 0 : 1, seconds) / (nu / 1e-6);
      RecordProperty("rate_" + std::to_string(viscosity) + "_" + std::to_string(i), std::to_string(rates[i]));
      EXPECT_NEAR(rates[i], 1, 0.15) << viscosity;
    }
  }
  // without it
  EXPECT_LT(std::abs(decay(0, GetParam(), 2, 2, 0, 0.5f * r * r / 1e-3f)) / 1e3, 0.05);
}
TEST_P(Viscosity, IsTheSameInOneSubstepAndInEight) {
  const float seconds = 0.5f * r * r / 1e-3f;
  const double once = decay(1, GetParam(), 1, 2, 0, seconds), in_eight = decay(1, GetParam(), 8, 2, 0, seconds);
  RecordProperty("ratio", std::to_string(once / in_eight));
  EXPECT_NEAR(once, in_eight, 0.07 * in_eight);
}

/* As viscous as can be told, in steps of 1/60 s: what moves at random comes to rest in the motion of a rigid body, with all of its momentum and angular momentum. */
TEST_P(Viscosity, WithoutBoundKeepsMomentumAndAngularMomentum) {
  Cube cube(1e9f, GetParam(), 1);
  cube.world.step(1.0f / 60);
  const auto noise = [](float x) { return std::sin(1e5f * x); };
  cube.set_velocities([&](const float *x, float *v) {
    v[0] = 0.1f - 1.5f * x[1] + 0.1f * noise(x[0]);
    v[1] = 1.5f * x[0] + 0.1f * noise(x[1]);
    v[2] = 0.1f * noise(x[2]);
  });
  struct Motion {
    double momentum[3] = {}, angular[3] = {}, energy = 0, size = 0;
  };
  const auto motion = [&] {
    const scenes::Snapshot now = cube.world.snapshot();
    Motion all;
    for (std::size_t i = 0; i < now.count(); ++i) {
      const float *x = &now.positions[3 * i], *v = &now.velocities[3 * i];
      const double mass = 1 / double(now.inverse_masses[i]);
      for (int k = 0; k < 3; ++k) {
        const int l = (k + 1) % 3, m = (k + 2) % 3;
        all.momentum[k] += mass * double(v[k]);
        all.angular[k] += mass * (double(x[l]) * double(v[m]) - double(x[m]) * double(v[l]));
        all.energy += 0.5 * mass * double(v[k]) * double(v[k]);
        all.size += mass * std::abs(double(v[k]));
      }
    }
    return all;
  };
  const Motion before = motion();
  double energy = before.energy;
  for (int step = 0; step < 8; ++step) {
    cube.world.step(1.0f / 60);
    EXPECT_LE(motion().energy, 1.0001 * energy) << step;
    energy = motion().energy;
  }
  const Motion after = motion();
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(after.momentum[k], before.momentum[k], 1e-6 * before.size) << k;
    RecordProperty("angular_" + std::to_string(k),
                   std::to_string((after.angular[k] - before.angular[k]) / before.angular[2]));
    EXPECT_NEAR(after.angular[k], before.angular[k], 0.01 * before.angular[2]) << k;
  }
  /* z, where there was nothing but random motion of 0.07 m/s */
  const scenes::Snapshot now = cube.world.snapshot();
  double left = 0;
  for (std::size_t i = 0; i < now.count(); ++i)
    left += double(now.velocities[3 * i + 2]) * double(now.velocities[3 * i + 2]);
  left = std::sqrt(left / double(now.count()));
  RecordProperty("left", std::to_string(left));
  EXPECT_LT(left, 0.005);
  EXPECT_EQ(cube.world.statistics().non_finite, 0u);
}

/* A block of rubber at rest beside a fluid that flows past it. */
TEST_P(Viscosity, DragsOtherMatterAlong) {
  double speed[2];
  for (int i = 0; i < 2; ++i) {
    Cube cube(i == 0 ? 0.0f : 5.0f, GetParam(), 4);
    cube.set_velocities([](const float *, float *v) { v[0] = 0.1f; });
    scenes::Scene rubber = scenes::drop_block(scenes::rubber(), 6, 0);
    rubber.planes.clear();
    for (std::size_t k = 1; k < rubber.positions.size(); k += 3) rubber.positions[k] += 0.5f * edge * r;
    const std::size_t first = cube.world.snapshot().count();
    cube.world.add(rubber);
    for (int step = 0; step < 6; ++step) cube.world.step(1.0f / 120);
    const scenes::Snapshot now = cube.world.snapshot();
    speed[i] = 0;
    for (std::size_t k = first; k < now.count(); ++k)
      speed[i] += double(now.velocities[3 * k]) / double(now.count() - first);
  }
  RecordProperty("without", std::to_string(speed[0]));
  RecordProperty("with", std::to_string(speed[1]));
  EXPECT_LT(speed[0], 0.005);
  EXPECT_GT(speed[1], 0.02);
}

/* What fluid without viscosity has of it: nothing. */
TEST(NoViscosity, NoStageAndNoMemory) {
  std::uint64_t bytes[2];
  for (int i = 0; i < 2; ++i) {
    Cube cube(i == 0 ? 0.0f : 1.0f, LOAM_SOLVER_GAUSS_SEIDEL, 1);
    cube.world.step(1e-3f);
    EXPECT_EQ(cube.world.has_stage("viscosity"), i == 1);
    bytes[i] = cube.world.memory_bytes();
  }
  EXPECT_GT(bytes[1], bytes[0]);
}

} // namespace
} // namespace loam
