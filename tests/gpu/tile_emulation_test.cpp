// The CUDA executor's text, on the CPU: visit order, layout of the lists, teams and folded sums over emulated tiles, against the CPU
// executor. What is left for a machine with a GPU to prove are the launches, CUB and the ordering of a tile's threads.
#include "rig.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <ostream>
#include <string>

#include "scene/error.h"

namespace loam {
namespace {

using test::greatest_difference, test::Rig, test::root_mean_square, test::Runs, test::Settings;

struct Law {
  loam_material_def material;
  friend void PrintTo(const Law &law, std::ostream *out) { *out << law.material.name; }
};
class EachLaw : public testing::TestWithParam<Law> {};

// Both take the particles in the same order, so only the rounding of differently folded sums is left.
TEST_P(EachLaw, AgreesWithTheCpuToRounding) {
  const scenes::Scene scene = scenes::jittered_block(GetParam().material, 700, 5);
  for (const bool jacobi : {false, true}) {
    Settings settings;
    settings.jacobi = jacobi;
    Rig cpu(Runs::cpu, scene, settings, {scene.material}), emulated(Runs::emulated, scene, settings, {scene.material});
    cpu.step(0.004f);
    emulated.step(0.004f);
    const auto expected = cpu.velocities();
    EXPECT_LT(greatest_difference(expected, emulated.velocities()), 5e-5f * root_mean_square(expected)) << jacobi;
    const loam_statistics a = cpu.backend().statistics(), b = emulated.backend().statistics();
    EXPECT_EQ(a.pairs, b.pairs);
    EXPECT_EQ(a.contacts, b.contacts);
    EXPECT_NEAR(a.residual, b.residual, 1e-4);
    EXPECT_NEAR(a.kinetic_energy, b.kinetic_energy, 1e-5 * a.kinetic_energy);
  }
}

std::vector<Law> each_law() {
  std::vector<Law> laws;
  for (const loam_material_def &material : scenes::each_law()) laws.push_back({material});
  return laws;
}
INSTANTIATE_TEST_SUITE_P(TileEmulation, EachLaw, testing::ValuesIn(each_law()),
                         [](const auto &info) { return std::string(info.param.material.name); });

// Impulses between free particles cancel: a lost or doubled write to a neighbour would show.
TEST(TileEmulation, GaussSeidelKeepsMomentum) {
  scenes::Scene scene = scenes::jittered_block(scenes::rubber(1e6f), 700, 20);
  scene.planes.clear();
  Settings settings;
  settings.gravity = {0, 0, 0};
  Rig emulated(Runs::emulated, scene, settings, {scene.material});
  emulated.step(1e-6f);
  const loam_statistics before = emulated.backend().statistics();
  emulated.step(0.01f);
  const loam_statistics after = emulated.backend().statistics();
  const double scale = before.mean_speed * static_cast<double>(scene.material.density * scene.volume()) * 700;
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(before.momentum[k], after.momentum[k], 1e-5 * scale);
}

struct Case {
  const char *name;
  std::size_t particles;
  int materials;
  float second_block; // spacings away; 0: there is none
  friend void PrintTo(const Case &c, std::ostream *out) { *out << c.name; }
};
scenes::Scene make_scene(const Case &c) {
  scenes::Scene scene = scenes::jittered_block(scenes::sand(), c.particles, 5);
  if (c.second_block == 0) return scene;
  const std::size_t first = scene.positions.size();
  for (std::size_t i = 0; i < first; ++i) {
    scene.positions.push_back(scene.positions[i] + (i % 3 == 1 ? 0 : c.second_block * scene.spacing));
    scene.velocities.push_back(scene.velocities[i]);
  }
  return scene;
}
std::vector<loam_material_def> make_materials(const Case &c) {
  std::vector<loam_material_def> materials = {scenes::sand()};
  if (c.materials > 1) materials.push_back(scenes::plasticine());
  return materials;
}
class EachOrder : public testing::TestWithParam<Case> {};

// Blocks of a pass touch no common particle, every particle has its turns, and what a GPU does at once may happen in any order. The cases:
// the two colourings, passes of two materials, and matter so far apart that cells are wrapped around.
TEST_P(EachOrder, IsTheCpusAndFreeOfConflicts) {
  const scenes::Scene scene = make_scene(GetParam());
  const auto materials = make_materials(GetParam());
  Settings settings;
  settings.substeps = 2;
  settings.iterations = 2;
  emulation::report = {};
  Rig cpu(Runs::cpu, scene, settings, materials), forwards(Runs::emulated, scene, settings, materials),
      backwards(Runs::emulated_backwards, scene, settings, materials);
  cpu.step(0.002f);
  forwards.step(0.002f);
  EXPECT_EQ(emulation::report.conflicts, 0);
  // Every particle once for its constraint and once for its distances, in each iteration.
  EXPECT_EQ(emulation::report.ordered_visits, static_cast<long>(scene.count()) * 2 * 2 * 2);
  const auto expected = cpu.velocities();
  EXPECT_LT(greatest_difference(expected, forwards.velocities()), 2e-5f * root_mean_square(expected));
  EXPECT_EQ(cpu.backend().statistics().pairs, forwards.backend().statistics().pairs);

  backwards.step(0.002f);
  EXPECT_EQ(forwards.backend().state_hash(), backwards.backend().state_hash());
}

INSTANTIATE_TEST_SUITE_P(TileEmulation, EachOrder,
                         testing::Values(Case{"small_blocks", 1500, 1, 0}, Case{"large_blocks", 30000, 1, 0},
                                         Case{"two_materials", 1500, 2, 0}, Case{"scattered", 500, 1, 707}),
                         [](const auto &info) { return std::string(info.param.name); });

// CUDA against the emulation: the same text, the same order, the same folding. With fused multiply-adds they differ by rounding; a build with
// LOAM_CUDA_PARITY, which says so by an environment variable, must have the same bits.
TEST_P(EachOrder, OfCudaGivesTheEmulationsBits) {
  const bool same_bits = std::getenv("LOAM_TEST_CUDA_PARITY") != nullptr;
  const scenes::Scene scene = make_scene(GetParam());
  const auto materials = make_materials(GetParam());
  for (const bool jacobi : {false, true}) {
    Settings settings;
    settings.jacobi = jacobi;
    settings.substeps = 2;
    settings.iterations = 2;
    try {
      Rig cuda(Runs::cuda, scene, settings, materials), emulated(Runs::emulated, scene, settings, materials);
      cuda.step(0.002f);
      emulated.step(0.002f);
      const auto expected = emulated.velocities();
      EXPECT_LT(greatest_difference(expected, cuda.velocities()), 1e-4f * root_mean_square(expected)) << jacobi;
      if (same_bits) {
        EXPECT_EQ(cuda.backend().state_hash(), emulated.backend().state_hash()) << jacobi;
      }
    } catch (const Error &error) {
      EXPECT_EQ(error.status(), LOAM_ERROR_BACKEND_UNAVAILABLE) << error.what();
      EXPECT_FALSE(same_bits) << "the parity check needs a device";
    }
  }
}

// A pile of sand comes to rest. Whether a particle sleeps is a matter of thresholds, so roundings may tell a few apart for a while.
TEST(TileEmulation, MatterFallsAsleepAsOnTheCpu) {
  const scenes::Scene scene = scenes::resting_pile(scenes::sand(), 8);
  Settings settings;
  settings.sleep_speed = 0.02f;
  Rig cpu(Runs::cpu, scene, settings, {scene.material}), emulated(Runs::emulated, scene, settings, {scene.material});
  int together = 0, steps = 0;
  const auto all_sleep = [&](Rig &rig) { return rig.backend().statistics().sleeping == scene.count(); };
  for (; steps < 120 && !(all_sleep(cpu) && all_sleep(emulated)); ++steps) {
    cpu.step(1.0f / 120);
    emulated.step(1.0f / 120);
    const auto a = cpu.backend().statistics().sleeping, b = emulated.backend().statistics().sleeping;
    together += std::max(a, b) - std::min(a, b) <= scene.count() / 20 ? 1 : 0;
  }
  EXPECT_TRUE(all_sleep(cpu) && all_sleep(emulated));
  EXPECT_GE(together, steps * 8 / 10);
  EXPECT_LT(greatest_difference(cpu.positions(), emulated.positions()), 0.02f * scene.spacing);
}

// The whole scene: a column of sand that collapses.
TEST(TileEmulation, ColumnCollapseAgreesWithTheCpu) {
  const scenes::Scene scene = scenes::axisymmetric_column(scenes::sand(), 6, 1);
  Settings settings;
  settings.substeps = 16;
  Rig cpu(Runs::cpu, scene, settings, {scene.material}), emulated(Runs::emulated, scene, settings, {scene.material});
  for (int frame = 0; frame < 12; ++frame) {
    cpu.step(1.0f / 40);
    emulated.step(1.0f / 40);
  }
  const auto flat = [](const std::vector<Vec3<float>> &rows) {
    std::vector<float> values;
    for (const Vec3<float> &row : rows) values.insert(values.end(), {row.x, row.y, row.z});
    return values;
  };
  const auto height = [](const std::vector<Vec3<float>> &rows) {
    double sum = 0;
    for (const Vec3<float> &row : rows) sum += static_cast<double>(row.y);
    return sum / static_cast<double>(rows.size());
  };
  const auto expected = cpu.positions(), found = emulated.positions();
  const double run_out = scenes::run_out(flat(expected), scene, 0.95);
  EXPECT_GT(run_out, 0.1); // it did collapse
  EXPECT_NEAR(run_out, scenes::run_out(flat(found), scene, 0.95), 0.04);
  EXPECT_NEAR(height(expected), height(found), 0.02 * height(expected));
  EXPECT_EQ(emulated.backend().statistics().non_finite, 0u);
}

} // namespace
} // namespace loam
