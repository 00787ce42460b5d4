/* Colliders that are moved without mercy, and a pile that must simply lie still. */
#include "hard_case.h"

namespace loam {
namespace {

using meshes::Mesh;
using test::block;
using test::HardCase;
using test::Outcome;
using test::survive;
using test::without_planes;

class MovingCollider : public test::OfASolver {};
INSTANTIATE_TEST_SUITE_P(Solvers, MovingCollider, test::both_solvers(), test::solver_name);

const float upright[4] = {0, 0, 0, 1};

TEST_P(MovingCollider, ABallTeleportedThroughAHeap) {
  test::shows("a ball placed elsewhere in the heap in every frame pushes gently");
  const Mesh ball = meshes::icosphere(0.03f, 2);
  HardCase hard(GetParam(), {block(scenes::sand(), 8, 0)});
  loam_collider_id id = 0;
  hard.prepare = [&](scenes::World &world) { id = test::add_mesh(world, ball, 0.6f, 0, 0.5f, 0); };
  hard.each = [&](scenes::World &world, int step) {
    const float at[3] = {0.02f * float(step % 5 - 2), 0.03f + 0.01f * float(step % 3), 0.02f * float(step % 7 - 3)};
    scenes::require(loam_collider_place(world.get(), id, at, upright), "place");
  };
  const Outcome outcome = survive(hard);
  EXPECT_GT(outcome.lowest, 0.0025);
  EXPECT_LT(outcome.peak_speed, 3); // a teleport gives no push
}

TEST_P(MovingCollider, ABladeSpinningThroughAHeap) {
  test::shows("a blade turning at 24 rad/s through a heap");
  const Mesh blade = meshes::box(0.08f, 0.01f, 0.004f);
  HardCase hard(GetParam(), {block(scenes::sand(), 8, 0)});
  loam_collider_id id = 0;
  hard.prepare = [&](scenes::World &world) { id = test::add_mesh(world, blade, 0.6f, 0, 0.02f, 0); };
  hard.each = [&](scenes::World &world, int step) {
    const float at[3] = {0, 0.02f, 0}, half = 0.1f * float(step + 1); // 0.2 radians a frame, 24 a second: 2 m/s at the tips
    const float turn[4] = {0, std::sin(half), 0, std::cos(half)};
    scenes::require(loam_collider_move(world.get(), id, at, turn), "move");
  };
  const Outcome outcome = survive(hard);
  EXPECT_GT(outcome.lowest, 0.0025);
  EXPECT_GT(outcome.peak_speed, 0.3); // it does stir
  EXPECT_LT(outcome.peak_speed, 9.7); // r a substep
}

TEST_P(MovingCollider, HalfATurnAndAMetreInOneStep) {
  test::shows("a plate moved by a metre and turned over within one step");
  const Mesh plate = meshes::box(0.2f, 0.002f, 0.2f);
  HardCase hard(GetParam(), {block(scenes::sand(), 7, 0)});
  loam_collider_id id = 0;
  hard.prepare = [&](scenes::World &world) { id = test::add_mesh(world, plate, 0.6f, -0.5f, 0.03f, 0); };
  hard.each = [&](scenes::World &world, int step) {
    const float at[3] = {step % 2 == 0 ? 0.5f : -0.5f, 0.03f, 0}, over[4] = {1, 0, 0, 1e-4f};
    scenes::require(loam_collider_move(world.get(), id, at, step % 2 == 0 ? over : upright), "move");
  };
  hard.steps = 30;
  hard.collider_speed = 1.2 * 120; // a metre a step, and the turn
  const Outcome outcome = survive(hard);
  EXPECT_GT(outcome.lowest, 0.0);
}

TEST_P(MovingCollider, APistonPressesSandAgainstTheGroundAndLosesNone) {
  test::shows("a piston pressing sand against the ground: none gets through");
  const Mesh plate = meshes::box(0.2f, 0.01f, 0.2f);
  HardCase hard(GetParam(), {block(scenes::sand(), 6, 0)});
  loam_collider_id id = 0;
  hard.prepare = [&](scenes::World &world) { id = test::add_mesh(world, plate, 0.6f, 0, 0.12f, 0); };
  hard.each = [&](scenes::World &world, int step) {
    const float at[3] = {0, std::max(0.03f, 0.12f - 0.002f * float(step)), 0};
    scenes::require(loam_collider_move(world.get(), id, at, upright), "move");
  };
  const Outcome outcome = survive(hard);
  EXPECT_GT(outcome.lowest, 0.0);
  std::size_t on_top = 0;
  for (std::size_t i = 0; i < outcome.end.positions.size(); i += 3) {
    const float *x = &outcome.end.positions[i];
    on_top += std::fabs(x[0]) < 0.19f && std::fabs(x[2]) < 0.19f && x[1] > 0.03f ? 1 : 0;
  }
  EXPECT_EQ(on_top, 0u);
}

/* A small heap in the upper bulb of an hourglass, poured and left alone. */
TEST_P(MovingCollider, APileInAClosedMeshComesToRest) {
  test::shows("sand in an hourglass that is closed, for five seconds: at rest");
  const Mesh glass = meshes::hourglass(0.05f, 0.004f); // a neck under the stand-off: at most single grains squeeze through
  HardCase hard(GetParam());
  hard.step_seconds = 1.0f / 60;
  hard.steps = hooks::short_run() ? 20 : 300;                    // 5 s
  if (GetParam() == LOAM_SOLVER_JACOBI) hard.def.iterations = 8; // it needs more of them
  hard.prepare = [&](scenes::World &world) {
    test::add_mesh(world, glass);
    loam_fill_def def;
    scenes::require(loam_fill_def_default(&def, sizeof def), "default");
    const loam_material_def sand = scenes::sand();
    scenes::require(loam_material_create(world.get(), &sand, &def.material), "material");
    def.region.kind = LOAM_REGION_MESH;
    def.region.mesh = glass.view();
    def.cut.kind = LOAM_REGION_BOX;
    def.cut.center[1] = 0.055f;
    def.cut.half_extents[0] = def.cut.half_extents[2] = 1;
    def.cut.half_extents[1] = 0.035f;
    def.inset = 0.005f;
    def.sampling = LOAM_SAMPLING_LATTICE;
    scenes::require(loam_particles_fill(world.get(), &def, nullptr), "fill");
  };
  std::uint64_t hash = 0;
  const Outcome outcome = test::run_once(hard, hash);
  const float at[3] = {0, 0, 0};
  EXPECT_GT(outcome.end.count(), 150u);
  EXPECT_EQ(test::outside(outcome.end.positions, glass, at), 0u);
  test::record(outcome, 5);
  if (!hooks::short_run()) {
    EXPECT_LT(outcome.statistics.mean_speed, 0.05 * 0.01); // 5 % of r a second
  }
}

} // namespace
} // namespace loam
