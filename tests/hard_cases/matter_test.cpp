/* Hard matter: stiffness over seven decades, steps over four, impacts, mixtures, gravity that changes its mind. */
#include <random>

#include "hard_case.h"

namespace loam {
namespace {

using test::block;
using test::HardCase;
using test::Outcome;
using test::survive;
using test::without_planes;

class Matter : public test::OfASolver {};
INSTANTIATE_TEST_SUITE_P(Solvers, Matter, test::every_solver(), test::solver_name);

TEST_P(Matter, StiffnessFromAHundredPascalToAGigapascalInOneScene) {
  test::shows("1e2 to 1e9 Pa, stiff on soft on stiff");
  HardCase hard(GetParam());
  float height = 0;
  for (const float E : {1e2f, 1e9f, 1e4f, 1e7f, 1e3f, 1e8f}) { // stiff on soft on stiff
    const scenes::Scene part = block(scenes::rubber(E), 4, height, 1);
    hard.parts.push_back(height > 0 ? without_planes(part) : part);
    height += 0.05f;
  }
  const Outcome outcome = survive(hard);
  EXPECT_GT(outcome.lowest, 0.0025); // half of the stand-off
  EXPECT_LT(outcome.statistics.kinetic_energy, outcome.start_energy);
  EXPECT_LT(outcome.peak_energy, outcome.start_energy);
}

TEST_P(Matter, SubstepsFromATenMicrosecondToASixtiethOfASecond) {
  test::shows("substeps of 1e-5 to 1/60 s");
  for (const float substep : {1e-5f, 1e-4f, 1e-3f, 4e-3f, 1.0f / 60}) {
    for (const loam_material_def &material : {scenes::sand(), scenes::plasticine(), scenes::rubber()}) {
      HardCase hard(GetParam(), {block(material, 5, 0.01f)});
      hard.def.substeps = 4;
      hard.step_seconds = 4 * substep;
      hard.steps = int(std::clamp(0.5f / hard.step_seconds, 8.0f, 40.0f));
      const Outcome outcome = survive(hard);
      EXPECT_GT(outcome.lowest, 0.0025) << substep;
      EXPECT_LT(outcome.statistics.kinetic_energy, 1.2 * outcome.start_energy) << substep;
      EXPECT_LT(outcome.mean_height, 0.06) << substep; // it did not burst
    }
  }
}

TEST_P(Matter, ImpactAtAHundredMetresPerSecond) {
  test::shows("sand, plasticine and rubber hit the ground at 100 m/s");
  for (const loam_material_def &material : {scenes::sand(), scenes::plasticine(), scenes::rubber(1e6f)}) {
    HardCase hard(GetParam(), {block(material, 5, 0.05f, 100)});
    hard.def.substeps = 16;
    hard.step_seconds = 1e-3f; // the speed limit is 160 m/s
    hard.steps = 30;
    const Outcome outcome = survive(hard);
    EXPECT_LE(outcome.peak_speed, 165);
    EXPECT_LE(outcome.peak_energy, 1.01 * outcome.start_energy);
    EXPECT_GT(outcome.lowest, 0.0);
  }
}

TEST_P(Matter, AnImpactBeyondTheSpeedLimitIsSlowedDown) {
  test::shows("100 m/s where a substep carries 9.6 m/s");
  HardCase hard(GetParam(), {block(scenes::sand(), 6, 0.05f, 100)});
  const Outcome outcome = survive(hard);
  EXPECT_LE(outcome.peak_speed, 0.01 / (1.0 / 120 / 8) * 1.0001);
  EXPECT_GT(outcome.lowest, 0.0025);
}

TEST_P(Matter, WhatIsHurledIsSlowedBeforeAndAfterTheIterations) {
  test::shows("1e9 m/s in all directions, a hundred million times what a substep carries");
  scenes::Scene matter = block(scenes::sand(), 6, 0.05f);
  std::mt19937 random(1);
  std::uniform_real_distribution<float> uniform(-1e9f, 1e9f);
  for (float &v : matter.velocities) v = uniform(random);
  HardCase hard(GetParam(), {without_planes(matter)});
  hard.def.substeps = 1;
  hard.steps = 1;
  const Outcome outcome = survive(hard);
  EXPECT_GE(outcome.speed_limited, matter.count() * 3 / 2); // all before, and most after
  EXPECT_GT(outcome.statistics.mean_speed, 0.6);            // of 1.2 m/s
}

TEST_P(Matter, AllMaterialsMixedParticleByParticle) {
  test::shows("sand, plasticine ten times as dense and stiff rubber, particle by particle");
  HardCase hard(GetParam(), {block(scenes::sand(), 7, 0.02f), block(scenes::plasticine(), 7, 0.02f),
                             block(scenes::rubber(1e7f), 7, 0.02f)});
  hard.parts[1].material.density = 1e4f;
  for (std::size_t p = 0; p < 3; ++p) { // every third particle of the same block
    scenes::Scene &part = hard.parts[p];
    std::vector<float> positions, velocities;
    for (std::size_t i = p; i < part.count(); i += 3)
      for (std::size_t k = 0; k < 3; ++k) {
        positions.push_back(part.positions[3 * i + k]);
        velocities.push_back(part.velocities[3 * i + k]);
      }
    part.positions = positions;
    part.velocities = velocities;
    if (p > 0) part.planes.clear();
  }
  const Outcome outcome = survive(hard);
  EXPECT_GT(outcome.lowest, 0.0025);
  EXPECT_LT(outcome.peak_energy, outcome.start_energy);
  EXPECT_LT(outcome.statistics.mean_speed, 0.3);
}

TEST_P(Matter, MassesOneToAThousand) {
  test::shows("a block a thousand times as dense dropped on sand");
  loam_material_def heavy = scenes::plasticine(), light = scenes::sand();
  heavy.density = 1e5f;
  light.density = 1e2f;
  HardCase hard(GetParam(), {block(light, 8, 0), without_planes(block(heavy, 4, 0.085f, 3))});
  const Outcome outcome = survive(hard);
  EXPECT_GT(outcome.lowest, 0.0025);
  EXPECT_LT(outcome.statistics.kinetic_energy, outcome.start_energy);
}

TEST_P(Matter, GravityFlippedEveryFrame) {
  test::shows("gravity of 30 m/s^2 up, down and aside in turn");
  HardCase hard(GetParam(), {block(scenes::sand(), 7, 0)});
  hard.each = [](scenes::World &world, int step) {
    const float up[3] = {0, 30, 0}, down[3] = {0, -30, 0}, aside[3] = {30, 0, 0};
    scenes::require(loam_world_set_gravity(world.get(), step % 3 == 0 ? up : step % 3 == 1 ? down : aside), "gravity");
  };
  const Outcome outcome = survive(hard);
  EXPECT_GT(outcome.lowest, 0.0025);
  EXPECT_LT(outcome.peak_speed, 30 * 0.5 * 1.2); // what the forces could have given at most
}

TEST_P(Matter, HugeGravityPressesMatterFlatAndNotThrough) {
  test::shows("gravity of 1e6 m/s^2: flat, but not through the ground");
  HardCase hard(GetParam(), {block(scenes::sand(), 6, 0)});
  hard.def.gravity[1] = -1e6f;
  const Outcome outcome = survive(hard);
  EXPECT_GT(outcome.lowest, 0.0);
}

} // namespace
} // namespace loam
