/* A block on an incline slides at g (sin - mu cos), or sticks where tan < mu. */
#include <cmath>
#include <gtest/gtest.h>

#include "support/scenes.h"

namespace loam {
namespace {

struct Slide {
  double acceleration, distance;
};

/* A stiff cube on a plane; gravity is tilted rather than the plane. */
Slide slide(double degrees, float friction, std::uint32_t solver) {
  scenes::Lattice lattice;
  lattice.jitter = 0.05f;
  scenes::Scene scene = scenes::drop_block(scenes::rubber(1e6f), 5, 0, 0, lattice);
  scene.planes[0].friction = friction;
  loam_world_def def = scenes::world_def(scene);
  const double angle = degrees * 3.14159265358979 / 180;
  def.gravity[0] = float(9.81 * std::sin(angle));
  def.gravity[1] = float(-9.81 * std::cos(angle));
  def.solver = solver;
  def.substeps = 20;
  scenes::World world(def, scene);
  const auto mean = [&](bool velocity) {
    const scenes::Snapshot now = world.snapshot();
    double sum = 0;
    for (std::size_t i = 0; i < now.positions.size(); i += 3) sum += double(velocity ? now.velocities[i] : now.positions[i]);
    return sum / double(now.count());
  };
  const double start = mean(false);
  for (int k = 0; k < 20; ++k) world.step(0.01f); // settle
  const double before = mean(true);
  for (int k = 0; k < 30; ++k) world.step(0.01f);
  return {(mean(true) - before) / 0.3, mean(false) - start};
}

TEST(Incline, ABlockSlidesAtItsClosedForm) {
  for (const std::uint32_t solver : {LOAM_SOLVER_GAUSS_SEIDEL, LOAM_SOLVER_JACOBI}) {
    for (const auto &[degrees, friction] : {std::pair(30.0, 0.3f), std::pair(20.0, 0.1f), std::pair(40.0, 0.0f)}) {
      const double angle = degrees * 3.14159265358979 / 180;
      const double expected = 9.81 * (std::sin(angle) - double(friction) * std::cos(angle));
      EXPECT_NEAR(slide(degrees, friction, solver).acceleration, expected, 0.02 * expected) << degrees << " " << friction;
    }
  }
}

TEST(Incline, ABlockSticksUnderTheAngleOfFriction) {
  for (const std::uint32_t solver : {LOAM_SOLVER_GAUSS_SEIDEL, LOAM_SOLVER_JACOBI}) {
    const Slide stuck = slide(15, 0.4f, solver); // tan 15 = 0.27
    EXPECT_LT(std::fabs(stuck.distance), 1e-3);
    EXPECT_LT(std::fabs(stuck.acceleration), 0.02);
  }
}

} // namespace
} // namespace loam
