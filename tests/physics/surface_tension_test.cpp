/* Drops: how they oscillate, what shape they take, and what they cling to. */
#include <algorithm>
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>
#include <numeric>

#include "support/scenes.h"

namespace loam {
namespace {

constexpr float r = 1e-3f;
constexpr double pi = std::numbers::pi;

class Drop : public testing::TestWithParam<std::uint32_t> {};
INSTANTIATE_TEST_SUITE_P(Solvers, Drop, testing::Values(LOAM_SOLVER_GAUSS_SEIDEL, LOAM_SOLVER_JACOBI),
                         [](const auto &info) { return info.param == LOAM_SOLVER_JACOBI ? "Jacobi" : "GaussSeidel"; });

loam_material_def water(float surface_tension) {
  loam_material_def def;
  scenes::require(loam_material_def_default(LOAM_LAW_FLUID, &def, sizeof def), "default");
  def.surface_tension = surface_tension;
  return def;
}

/* A ball or a cube of `size` around the origin. */
class Water {
public:
  Water(const loam_material_def &material, std::uint32_t solver, std::uint32_t region, float size, float gravity = 0)
      : world(definition(material, solver, gravity)) {
    loam_fill_def fill;
    scenes::require(loam_fill_def_default(&fill, sizeof fill), "fill");
    scenes::require(loam_material_create(world.get(), &material, &fill.material), "material");
    fill.region.kind = region;
    fill.region.radius = size;
    for (float &half : fill.region.half_extents) half = 0.5f * size;
    scenes::require(loam_particles_fill(world.get(), &fill, nullptr), "fill");
  }
  template <class F> void set_velocities(F &&velocity) {
    scenes::Snapshot now = world.snapshot();
    std::vector<std::uint32_t> ids(now.count());
    std::iota(ids.begin(), ids.end(), 0u);
    for (std::size_t i = 0; i < now.count(); ++i) velocity(&now.positions[3 * i], &now.velocities[3 * i]);
    scenes::require(loam_particles_move(world.get(), ids.data(), ids.size(), nullptr, now.velocities.data()), "move");
  }
  /* Means of squares about the centre, of z less those of x and y over all; and of the fourth powers over those of squares of distances: 0.6 for what is round,
   * 0.48 or so for a cube. */
  struct Shape {
    double length, cubic;
  };
  Shape shape() const {
    const scenes::Snapshot now = world.snapshot();
    std::array<double, 3> centre = {}, squares = {};
    double fourth = 0, distances = 0;
    for (std::size_t i = 0; i < 3 * now.count(); ++i) centre[i % 3] += double(now.positions[i]) / double(now.count());
    for (std::size_t i = 0; i < now.count(); ++i) {
      double distance = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const double d = double(now.positions[3 * i + k]) - centre[k];
        squares[k] += d * d;
        fourth += d * d * d * d;
        distance += d * d;
      }
      distances += distance * distance;
    }
    return {(squares[2] - 0.5 * (squares[0] + squares[1])) / (squares[0] + squares[1] + squares[2]), fourth / distances};
  }
  scenes::World world;

private:
  static loam_world_def definition(const loam_material_def &material, std::uint32_t solver, float gravity) {
    scenes::Scene none;
    none.material = material;
    none.spacing = r;
    loam_world_def def = scenes::world_def(none);
    def.particle_capacity = 3000;
    def.solver = solver;
    def.substeps = 2;
    def.gravity[1] = gravity;
    return def;
  }
};

/* The period of the oscillation between long and flat. */
double period(float surface_tension, std::uint32_t solver, float radius, double seconds) {
  Water drop(water(surface_tension), solver, LOAM_REGION_SPHERE, radius);
  drop.world.step(2e-3f);
  drop.set_velocities([](const float *x, float *v) {
    for (int k = 0; k < 3; ++k) v[k] = (k == 2 ? -10.0f : 5.0f) * x[k];
  });
  std::vector<double> crossings;
  double before = 0;
  for (double t = 0; t < seconds; t += 2e-3) {
    drop.world.step(2e-3f);
    const double length = drop.shape().length;
    if (length * before < 0) crossings.push_back(t - 2e-3 * length / (length - before));
    before = length;
  }
  const std::size_t n = crossings.size();
  return n < 2 ? 1e9 : 2 * (crossings[n - 1] - crossings[0]) / double(n - 1);
}

TEST_P(Drop, OscillatesWithThePeriodOfItsTension) {
  for (const auto &[radius, tension] : {std::pair(4 * r, 0.072f), std::pair(5 * r, 0.018f)}) {
    const double expected = 2 * pi / std::sqrt(8 * double(tension) / (1000 * std::pow(double(radius), 3)));
    const double measured = period(tension, GetParam(), radius, 1.8 * expected);
    RecordProperty("period_" + std::to_string(tension), std::to_string(measured / expected));
    EXPECT_NEAR(measured, expected, 0.1 * expected) << tension;
  }
  EXPECT_GT(period(0, GetParam(), 4 * r, 0.12), 1) << "it does not come back";
}

TEST_P(Drop, OfACubeBecomesRoundAndKeepsItsMomentum) {
  for (const float tension : {0.0f, 0.072f}) {
    loam_material_def material = water(tension);
    material.viscosity = 0.01f;
    Water cube(material, GetParam(), LOAM_REGION_BOX, 8 * r);
    cube.set_velocities([](const float *, float *v) { v[0] = 0.05f; });
    cube.world.step(1e-6f);
    const loam_statistics before = cube.world.statistics();
    for (int step = 0; step < 80; ++step) cube.world.step(2e-3f);
    const loam_statistics after = cube.world.statistics();
    const double cubic = cube.shape().cubic;
    RecordProperty("cubic_" + std::to_string(tension), std::to_string(cubic));
    if (tension > 0)
      EXPECT_NEAR(cubic, 0.6, 0.03);
    else
      EXPECT_LT(cubic, 0.5);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(after.momentum[k], before.momentum[k], 1e-5 * before.momentum[0]) << tension;
  }
}

/* Beyond what a substep can carry: it is bounded, and nothing flies apart. */
TEST_P(Drop, OfAnyTensionStaysTogether) {
  Water drop(water(1e9f), GetParam(), LOAM_REGION_SPHERE, 4 * r);
  for (int step = 0; step < 40; ++step) drop.world.step(4e-3f);
  const scenes::Snapshot now = drop.world.snapshot();
  double farthest = 0;
  for (std::size_t i = 0; i < now.count(); ++i)
    farthest = std::max(farthest, std::hypot(double(now.positions[3 * i]), double(now.positions[3 * i + 1]),
                                             double(now.positions[3 * i + 2])));
  RecordProperty("farthest", std::to_string(farthest / double(4 * r)));
  EXPECT_LT(farthest, 1.3 * double(4 * r));
  EXPECT_EQ(drop.world.statistics().non_finite, 0u);
}

/* A cube of 3 mm under a plate. */
TEST_P(Drop, HangsFromAPlateThatItClingsTo) {
  for (const float adhesion : {0.0f, 300.0f}) {
    loam_material_def material = water(0.072f);
    material.adhesion = adhesion;
    Water drop(material, GetParam(), LOAM_REGION_BOX, 3 * r, -9.81f);
    loam_collider_def plate;
    loam_collider_id id;
    scenes::require(loam_collider_def_default(&plate, sizeof plate), "collider");
    plate.kind = LOAM_COLLIDER_BOX;
    plate.half_extents[0] = plate.half_extents[2] = 0.02f;
    plate.half_extents[1] = 0.002f;
    plate.position[1] = 0.002f + 1.5f * r;
    scenes::require(loam_collider_create(drop.world.get(), &plate, &id), "collider");
    for (int step = 0; step < 60; ++step) drop.world.step(2e-3f);
    const scenes::Snapshot now = drop.world.snapshot();
    double lowest = 1;
    for (std::size_t i = 1; i < now.positions.size(); i += 3) lowest = std::min(lowest, double(now.positions[i]));
    RecordProperty("lowest_" + std::to_string(adhesion), std::to_string(lowest / double(r)));
    if (adhesion > 0)
      EXPECT_GT(lowest, -3 * double(r));
    else
      EXPECT_LT(lowest, -30 * double(r));
  }
}

/* What fluid without surface tension has of it: nothing. */
TEST(NoSurfaceTension, NoStageAndNoMemory) {
  std::uint64_t bytes[2];
  for (int i = 0; i < 2; ++i) {
    Water drop(water(i == 0 ? 0.0f : 0.072f), LOAM_SOLVER_GAUSS_SEIDEL, LOAM_REGION_SPHERE, 3 * r);
    drop.world.step(1e-3f);
    EXPECT_EQ(drop.world.has_stage("surface tension"), i == 1);
    bytes[i] = drop.world.memory_bytes();
  }
  EXPECT_GT(bytes[1], bytes[0]);
}

} // namespace
} // namespace loam
