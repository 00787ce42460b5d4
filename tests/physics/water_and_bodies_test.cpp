/* Water that cloth holds, and blocks that float in it or sink. */
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

#include "support/cloths.h"

namespace loam {
namespace {

using cloths::Cloth;
using cloths::Grid;

class WaterAndBodies : public testing::TestWithParam<std::uint32_t> {};
INSTANTIATE_TEST_SUITE_P(Solvers, WaterAndBodies, testing::Values(LOAM_SOLVER_GAUSS_SEIDEL, LOAM_SOLVER_JACOBI),
                         [](const auto &info) { return info.param == LOAM_SOLVER_JACOBI ? "Jacobi" : "GaussSeidel"; });

loam_material_id add_box(loam_world *world, const loam_material_def &material, const float center[3], const float half[3]) {
  loam_fill_def fill;
  scenes::require(loam_fill_def_default(&fill, sizeof fill), "fill");
  scenes::require(loam_material_create(world, &material, &fill.material), "material");
  fill.region.kind = LOAM_REGION_BOX;
  for (int k = 0; k < 3; ++k) {
    fill.region.center[k] = center[k];
    fill.region.half_extents[k] = half[k];
  }
  scenes::require(loam_particles_fill(world, &fill, nullptr), "fill");
  return fill.material;
}
loam_material_def of_law(std::uint32_t law) {
  loam_material_def def;
  scenes::require(loam_material_def_default(law, &def, sizeof def), "default");
  return def;
}

/* A cube of water falls into a sheet that is held along its edges. */
TEST_P(WaterAndBodies, AHeldClothHoldsWater) {
  constexpr float r = 0.02f;
  loam_world_def def = cloths::world_def(5, 8);
  def.kernel_radius = r;
  def.solver = GetParam();
  def.particle_capacity = 1000;
  scenes::World world(def);
  constexpr std::uint32_t edge = 24;
  const Grid grid(edge, edge, 0.8f * r);
  const Cloth cloth(world.get(), cloths::definition(grid));
  std::vector<std::uint32_t> held;
  for (std::uint32_t i = 0; i <= edge; ++i)
    for (std::uint32_t j = 0; j <= edge; ++j)
      if (i == 0 || j == 0 || i == edge || j == edge) held.push_back(grid.at(i, j));
  cloth.attach(held);
  const float center[3] = {0, 5 * r, 0}, half[3] = {2.5f * r, 2.5f * r, 2.5f * r};
  add_box(world.get(), of_law(LOAM_LAW_FLUID), center, half);
  double deepest = 0;
  for (int frame = 0; frame < 24; ++frame) {
    world.step(1.0f / 60);
    const scenes::Snapshot now = world.snapshot();
    const Cloth::Vertices vertices = cloth.vertices();
    ASSERT_TRUE(vertices.finite());
    deepest = std::min(deepest, double(vertices.lowest()));
    for (std::size_t i = 0; i < now.count(); ++i) { // none is behind the nearest vertex
      const auto from = [&](std::size_t v, std::size_t k) {
        return double(now.positions[3 * i + k]) - double(vertices.positions[3 * v + k]);
      };
      std::size_t nearest = 0;
      double least = 1e30, beyond = 0;
      for (std::size_t v = 0; v < vertices.count(); ++v) {
        const double distance = std::hypot(from(v, 0), from(v, 1), from(v, 2));
        if (distance > least) continue;
        least = distance;
        nearest = v;
      }
      const double up = vertices.normals[3 * nearest + 1] > 0 ? 1 : -1;
      for (std::size_t k = 0; k < 3; ++k) beyond += up * from(nearest, k) * double(vertices.normals[3 * nearest + k]);
      ASSERT_GT(beyond, -double(r)) << frame << " " << i;
    }
  }
  RecordProperty("deepest", std::to_string(deepest / double(r)));
  EXPECT_LT(deepest, -3 * double(r)); // it bore the water
}

/* A block of rubber that starts in the middle of water. */
TEST_P(WaterAndBodies, LightBlocksFloatAndHeavyOnesSink) {
  constexpr float r = 0.01f;
  constexpr int width = 9, height = 9, edge = 3;
  for (const float density : {300.0f, 2000.0f}) {
    scenes::Scene tank, block;
    tank.spacing = block.spacing = r;
    tank.material = of_law(LOAM_LAW_FLUID);
    block.material = scenes::rubber();
    block.material.density = density;
    const auto inside = [](int at, int of) { return std::abs(2 * at + 1 - of) < edge; };
    for (int x = 0; x < width; ++x)
      for (int y = 0; y < height; ++y)
        for (int z = 0; z < width; ++z) {
          auto &positions = inside(x, width) && inside(y, height) && inside(z, width) ? block.positions : tank.positions;
          positions.insert(positions.end(), {(float(x) + 0.5f) * r, (float(y) + 0.5f) * r, (float(z) + 0.5f) * r});
        }
    const float w = width * r;
    tank.planes = {{{0, 0, 0}, {0, 1, 0}, 0},
                   {{0, 0, 0}, {1, 0, 0}, 0},
                   {{w, 0, 0}, {-1, 0, 0}, 0},
                   {{0, 0, 0}, {0, 0, 1}, 0},
                   {{0, 0, w}, {0, 0, -1}, 0}};
    loam_world_def def = scenes::world_def(tank);
    def.particle_capacity = tank.count() + block.count();
    def.solver = GetParam();
    def.substeps = 4;
    scenes::World world(def, tank);
    world.add(block);
    for (int step = 0; step < 36; ++step) world.step(1.0f / 60);
    const scenes::Snapshot now = world.snapshot();
    double of_block = 0, of_water = 0;
    for (std::size_t i = 0; i < tank.count(); ++i) of_water += double(now.positions[3 * i + 1]) / double(tank.count());
    for (std::size_t i = tank.count(); i < now.count(); ++i)
      of_block += double(now.positions[3 * i + 1]) / double(block.count());
    const std::string which = std::to_string(int(density));
    RecordProperty("block_" + which, std::to_string(of_block / double(r)));
    RecordProperty("water_" + which, std::to_string(of_water / double(r)));
    if (density < 1000)
      EXPECT_NEAR(of_block, 2 * of_water, double(r)) << "its middle is near the surface";
    else
      EXPECT_NEAR(of_block, 0.5 * double(edge * r), 0.8 * double(r)) << "it lies on the ground";
  }
}

} // namespace
} // namespace loam
