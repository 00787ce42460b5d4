/* What is free of external force keeps its momentum; free fall is exact. */
#include <cmath>
#include <gtest/gtest.h>

#include "support/scenes.h"

namespace loam {
namespace {

struct Blocks {
  scenes::Scene light, heavy;
};

/* Two blocks, one above the other, without ground. */
Blocks blocks(const loam_material_def &light, const loam_material_def &heavy, float speed) {
  Blocks both = {scenes::drop_block(light, 7, 0.005f, 0), scenes::drop_block(heavy, 7, 0.085f, 0)};
  for (scenes::Scene *scene : {&both.light, &both.heavy}) scene->planes.clear();
  for (std::size_t i = 0; i < both.light.velocities.size(); i += 3) {
    both.light.velocities[i] = 0.3f; // some shear
    both.light.velocities[i + 1] = speed;
    both.heavy.velocities[i + 1] = -speed;
    both.heavy.velocities[i + 2] = 0.2f;
  }
  return both;
}

/* The greatest change of momentum over a collision, relative to the sum of |m v|; `exchanged` receives how much the blocks gave each other. */
double momentum_error(const Blocks &both, loam_world_def def, double &exchanged) {
  def.particle_capacity = both.light.count() + both.heavy.count();
  for (float &component : def.gravity) component = 0;
  scenes::World world(def, both.light);
  world.add(both.heavy);
  const auto momenta = [&](std::size_t first, std::size_t last, double sum[3]) {
    const scenes::Snapshot now = world.snapshot();
    double magnitude = 0;
    for (std::size_t i = first; i < last; ++i)
      for (std::size_t k = 0; k < 3; ++k) {
        const double p = double(now.velocities[3 * i + k]) / double(now.inverse_masses[i]);
        sum[k] += p;
        magnitude += std::fabs(p);
      }
    return magnitude;
  };
  const std::size_t half = both.light.count(), all = half + both.heavy.count();
  double before[3] = {}, own_before[3] = {};
  const double magnitude = momenta(0, all, before);
  momenta(0, half, own_before);
  double worst = 0;
  for (int frame = 0; frame < 20; ++frame) {
    world.step(0.002f);
    double now[3] = {};
    momenta(0, all, now);
    for (int k = 0; k < 3; ++k) worst = std::max(worst, std::fabs(now[k] - before[k]) / magnitude);
  }
  double own[3] = {};
  momenta(0, half, own);
  exchanged = std::fabs(own[1] - own_before[1]) / magnitude;
  return worst;
}

TEST(Momentum, OfAFreeCollisionIsConserved) {
  for (const std::uint32_t solver : {LOAM_SOLVER_GAUSS_SEIDEL, LOAM_SOLVER_JACOBI}) {
    for (const auto &[light, heavy] :
         {std::pair(scenes::sand(), scenes::sand()), std::pair(scenes::rubber(), scenes::plasticine())}) {
      const Blocks both = blocks(light, heavy, 0.5f);
      loam_world_def def = scenes::world_def(both.light);
      def.solver = solver;
      def.substeps = 4;
      double exchanged = 0;
      EXPECT_LT(momentum_error(both, def, exchanged), 1e-6) << "solver " << solver;
      EXPECT_GT(exchanged, 0.01); // they did collide
    }
  }
}

/* As printed in the paper, XSPH leaks momentum where masses differ. */
TEST(Momentum, VelocitySmoothingOfUnequalMassesConservesIt) {
  loam_material_def heavy = scenes::rubber();
  heavy.density = 1e5f;
  const Blocks both = blocks(scenes::rubber(), heavy, 0.5f);
  loam_world_def def = scenes::world_def(both.light);
  def.velocity_smoothing = 1000; // half of the difference in a substep
  def.substeps = 4;
  double exchanged = 0;
  EXPECT_LT(momentum_error(both, def, exchanged), 1e-6);
  EXPECT_GT(exchanged, 1e-3);
}

TEST(FreeFall, IsThatOfTheIntegrator) {
  for (const std::uint32_t solver : {LOAM_SOLVER_GAUSS_SEIDEL, LOAM_SOLVER_JACOBI}) {
    scenes::Scene scene = scenes::drop_block(scenes::sand(), 5, 2, 0.5f);
    scene.planes.clear();
    loam_world_def def = scenes::world_def(scene);
    def.solver = solver;
    def.substeps = 10;
    scenes::World world(def, scene);
    const int steps = 20;
    for (int k = 0; k < steps; ++k) world.step(0.01f);
    const double n = steps * 10, h = 1e-3, g = 9.81;
    const scenes::Snapshot now = world.snapshot();
    for (std::size_t i = 0; i < now.count(); ++i) {
      // v_n = v_0 + n h g, x_n = x_0 + h sum of v: symplectic Euler
      EXPECT_NEAR(now.velocities[3 * i + 1], -0.5 - n * h * g, 2e-5);
      EXPECT_NEAR(now.positions[3 * i + 1], double(scene.positions[3 * i + 1]) - n * h * 0.5 - g * h * h * n * (n + 1) / 2,
                  2e-5);
      EXPECT_NEAR(now.positions[3 * i], scene.positions[3 * i], 1e-5);
      for (std::size_t k = 0; k < 6; ++k) EXPECT_LT(std::fabs(now.strains[6 * i + k]), 1e-4);
    }
  }
}

} // namespace
} // namespace loam
