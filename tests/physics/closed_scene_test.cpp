/* Sand, water and cloth together, without anything outside: what they have of momentum stays. */
#include <cmath>
#include <gtest/gtest.h>

#include "support/cloths.h"

namespace loam {
namespace {

using cloths::Cloth;
using cloths::Grid;

struct Momentum {
  double sum[3] = {}, size = 0;
  void add(const std::vector<float> &velocities, const std::vector<float> &inverse_masses, std::size_t first,
           std::size_t last) {
    for (std::size_t i = first; i < last; ++i)
      for (std::size_t k = 0; k < 3; ++k) {
        const double p = double(velocities[3 * i + k]) / double(inverse_masses[i]);
        sum[k] += p;
        size += std::fabs(p);
      }
  }
};

class ClosedScene : public testing::TestWithParam<std::uint32_t> {};
INSTANTIATE_TEST_SUITE_P(Solvers, ClosedScene, testing::Values(LOAM_SOLVER_GAUSS_SEIDEL, LOAM_SOLVER_JACOBI),
                         [](const auto &info) { return info.param == LOAM_SOLVER_JACOBI ? "Jacobi" : "GaussSeidel"; });

/* From below water, from above sand and water against each other in the middle of a free sheet. */
TEST_P(ClosedScene, OfSandWaterAndFreeClothKeepsItsMomentum) {
  constexpr float r = 0.01f;
  scenes::Scene sand = scenes::drop_block(scenes::sand(), 6, 0.01f, 1), water = sand;
  sand.planes.clear();
  water.planes.clear();
  scenes::require(loam_material_def_default(LOAM_LAW_FLUID, &water.material, sizeof water.material), "default");
  const auto place = [](scenes::Scene &scene, float x, float y, float u, float v) {
    for (std::size_t i = 0; i < scene.positions.size(); i += 3) {
      scene.positions[i] += x;
      scene.positions[i + 1] += y;
      scene.velocities[i] = u;
      scene.velocities[i + 1] = v;
    }
  };
  place(sand, -0.025f, 0, 0.5f, -1);
  place(water, 0.035f, 0, -0.5f, -1.2f);
  loam_world_def def = scenes::world_def(sand);
  def.solver = GetParam();
  def.substeps = 8;
  def.particle_capacity = sand.count() + water.count();
  for (float &g : def.gravity) g = 0;
  scenes::World world(def, sand);
  world.add(water);
  const Grid grid(14, 14, 1.2f * r);
  const Cloth cloth(world.get(), cloths::definition(grid));
  const auto total = [&](Momentum *of_each) {
    const scenes::Snapshot now = world.snapshot();
    const Cloth::Vertices vertices = cloth.vertices();
    Momentum all;
    of_each[0].add(now.velocities, now.inverse_masses, 0, sand.count());
    of_each[1].add(now.velocities, now.inverse_masses, sand.count(), now.count());
    of_each[2].add(vertices.velocities, vertices.inverse_masses, 0, vertices.inverse_masses.size());
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) all.sum[k] += of_each[i].sum[k];
      all.size += of_each[i].size;
    }
    return all;
  };
  Momentum first[3], last[3];
  const Momentum before = total(first);
  double worst = 0;
  for (int step = 0; step < 20; ++step) {
    world.step(1.0f / 240);
    Momentum each[3];
    const Momentum now = total(each);
    for (int k = 0; k < 3; ++k) worst = std::max(worst, std::fabs(now.sum[k] - before.sum[k]) / before.size);
  }
  total(last);
  RecordProperty("error", std::to_string(1e6 * worst));
  EXPECT_LT(worst, 1e-5);
  EXPECT_EQ(world.statistics().speed_limited, 0u);
  for (int i = 0; i < 3; ++i) { // each has met the others
    EXPECT_GT(std::fabs(last[i].sum[1] - first[i].sum[1]), 1e-3 * before.size) << i;
  }
}

} // namespace
} // namespace loam
