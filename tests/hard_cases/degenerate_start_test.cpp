/* Starts that no sane host would make, and hosts make: matter squashed to a plane, a line, a point; duplicates; lone particles; inside a collider. */
#include "hard_case.h"

namespace loam {
namespace {

using test::block;
using test::HardCase;
using test::Outcome;
using test::survive;
using test::without_planes;

class DegenerateStart : public test::OfASolver {};
INSTANTIATE_TEST_SUITE_P(Solvers, DegenerateStart, test::both_solvers(), test::solver_name);

/* Matter as flat as that is pushed apart by position correction alone, at up to 0.75 r a substep. */
TEST_P(DegenerateStart, MatterSquashedToAPlaneALineOrAPoint) {
  test::shows("every law started as a plane, a line, a point: it finds room again");
  for (const loam_material_def &material : scenes::each_law())
    for (int dimensions = 0; dimensions < 3; ++dimensions) {
      scenes::Scene squashed = block(material, 4, 0.05f);
      for (std::size_t i = 0; i < squashed.positions.size(); ++i)
        if (int(i % 3) >= dimensions) squashed.positions[i] = i % 3 == 1 ? 0.1f : 0;
      HardCase hard(GetParam(), {squashed});
      hard.steps = 30;
      const Outcome outcome = survive(hard);
      EXPECT_GT(outcome.lowest, 0.0025) << material.name << " " << dimensions;
      double spread = 0; // it found room
      for (std::size_t i = 0; i < outcome.end.positions.size(); i += 3)
        spread = std::max(spread, double(std::fabs(outcome.end.positions[i])));
      EXPECT_LT(spread, 10 * 0.25) << material.name << " " << dimensions;
      if (GetParam() == LOAM_SOLVER_GAUSS_SEIDEL) {
        EXPECT_GT(spread, 0.005) << material.name << " " << dimensions;
      }
    }
}

TEST_P(DegenerateStart, EveryParticleTwice) {
  test::shows("a block in which every particle exists twice");
  const scenes::Scene sand = block(scenes::sand(), 6, 0.01f);
  const Outcome outcome = survive(HardCase(GetParam(), {sand, without_planes(sand)}));
  EXPECT_GT(outcome.lowest, 0.0025);
  EXPECT_LT(outcome.statistics.mean_speed, 1);
}

TEST_P(DegenerateStart, LoneParticlesAndPairsFallAndRest) {
  test::shows("lone particles, pairs, and pairs a micrometre apart fall and lie still");
  scenes::Scene lone = block(scenes::sand(), 1, 0.05f);
  lone.positions.clear();
  for (int k = 0; k < 40; ++k) {
    lone.positions.insert(lone.positions.end(), {0.1f * float(k), 0.05f, 0});
    if (k % 3 == 1) lone.positions.insert(lone.positions.end(), {0.1f * float(k) + 0.012f, 0.05f, 0}); // a pair
    if (k % 3 == 2) lone.positions.insert(lone.positions.end(), {0.1f * float(k), 0.05f, 1e-6f});      // nearly one
  }
  lone.velocities.assign(lone.positions.size(), 0.0f);
  HardCase hard(GetParam(), {lone});
  hard.steps = 150; // those that were nearly one part fast, and slide until friction has stopped them
  const Outcome outcome = survive(hard);
  EXPECT_GT(outcome.lowest, 0.00499);
  EXPECT_LT(outcome.statistics.max_speed, 0.2);
}

TEST_P(DegenerateStart, InvertedMatterUnfoldsOrStaysButStaysFinite) {
  test::shows("rubber thrown through itself at 18 m/s");
  // Rubber thrown through itself: the upper half falls faster than the lower half can give way.
  scenes::Scene rubber = block(scenes::rubber(), 7, 0.1f);
  for (std::size_t i = 0; i < rubber.positions.size(); i += 3)
    rubber.velocities[i + 1] = rubber.positions[i + 1] > 0.14f ? -9.0f : 9.0f;
  const Outcome outcome = survive(HardCase(GetParam(), {rubber}));
  EXPECT_GT(outcome.lowest, 0.0025);
  EXPECT_LT(outcome.statistics.kinetic_energy, outcome.start_energy);
}

TEST_P(DegenerateStart, AFillInsideASolidGroundComesOutSlowly) {
  test::shows("sand filled in half under the ground comes out without a jump");
  HardCase hard(GetParam(), {block(scenes::sand(), 1, 1)}); // for its ground
  hard.prepare = [](scenes::World &world) {
    loam_fill_def def;
    scenes::require(loam_fill_def_default(&def, sizeof def), "default");
    const loam_material_def sand = scenes::sand();
    scenes::require(loam_material_create(world.get(), &sand, &def.material), "material");
    def.region.kind = LOAM_REGION_SPHERE;
    def.region.radius = 0.04f; // half of it under the ground
    scenes::require(loam_particles_fill(world.get(), &def, nullptr), "fill");
  };
  const Outcome outcome = survive(hard);
  EXPECT_GT(outcome.lowest, 0.0);
  EXPECT_LT(outcome.statistics.mean_speed, 0.2);
}

TEST_P(DegenerateStart, AFillAcrossTheWallOfAMeshSettlesOnBothSides) {
  test::shows("sand filled in across a wall settles on both sides");
  const meshes::Mesh box = meshes::box(0.05f, 0.05f, 0.05f);
  HardCase hard(GetParam(), {block(scenes::sand(), 1, 1)});
  hard.prepare = [&box](scenes::World &world) {
    test::add_mesh(world, box, 0.6f, 0.05f, 0.06f, 0);
    loam_fill_def def;
    scenes::require(loam_fill_def_default(&def, sizeof def), "default");
    const loam_material_def sand = scenes::sand();
    scenes::require(loam_material_create(world.get(), &sand, &def.material), "material");
    def.region.kind = LOAM_REGION_SPHERE; // about the middle of a wall
    def.region.center[1] = 0.06f;
    def.region.radius = 0.035f;
    scenes::require(loam_particles_fill(world.get(), &def, nullptr), "fill");
  };
  const Outcome outcome = survive(hard);
  EXPECT_GT(outcome.lowest, 0.0025);
  EXPECT_LT(outcome.statistics.mean_speed, 0.5);
}

} // namespace
} // namespace loam
