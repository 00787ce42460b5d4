/* The calls of accuracy.h: what each mode does, and what is refused. */
#include <functional>

#include "small_world.h"

namespace loam {
namespace {

using test::infinity;
using test::nan;

class Accuracy : public test::SmallWorld {
protected:
  static loam_accuracy_def of_mode(std::uint32_t mode) {
    loam_accuracy_def def;
    EXPECT_EQ(loam_accuracy_def_default(&def, sizeof def), LOAM_OK);
    def.mode = mode;
    if (mode == LOAM_ACCURACY_TOLERANCE) def.tolerance = 0.01f;
    if (mode == LOAM_ACCURACY_BUDGET) {
      def.budget = 0.005f;
      def.substeps = 0;
    }
    return def;
  }
  void refuses(std::uint32_t mode, const std::vector<std::string> &parts,
               const std::function<void(loam_accuracy_def &)> &change) {
    loam_accuracy_def def = of_mode(mode);
    change(def);
    invalid(parts, [&] { return loam_world_use_accuracy(world(), &def); });
    loam_accuracy_def now;
    ASSERT_EQ(loam_world_get_accuracy(world(), &now, sizeof now), LOAM_OK);
    EXPECT_EQ(now.mode, std::uint32_t(LOAM_ACCURACY_FIXED));
    EXPECT_EQ(now.substeps, 2u); // as it was
  }
};

TEST_F(Accuracy, EveryFieldIsBoundedAndNamed) {
  for (std::uint32_t mode = LOAM_ACCURACY_FIXED; mode <= LOAM_ACCURACY_BUDGET; ++mode) {
    refuses(mode, {"iterations", "1001"}, [](loam_accuracy_def &def) { def.iterations = 1001; });
    refuses(mode, {"iterations", "0"}, [](loam_accuracy_def &def) { def.iterations = 0; });
    refuses(mode, {"most_substeps", "10001"}, [](loam_accuracy_def &def) { def.most_substeps = 10001; });
    for (const float bad : {nan, infinity, 0.0f, -1.0f, 101.0f})
      refuses(mode, {"courant"}, [bad](loam_accuracy_def &def) { def.courant = bad; });
  }
  refuses(3, {"mode", "3"}, [](loam_accuracy_def &) {});
  refuses(LOAM_ACCURACY_FIXED, {"substeps", "10001"}, [](loam_accuracy_def &def) { def.substeps = 10001; });
  // With the least that single precision reaches.
  for (const float bad : {nan, infinity, 0.0f, -0.01f, 0.9e-4f, 0.6f})
    refuses(LOAM_ACCURACY_TOLERANCE, {"tolerance", "0.0001"}, [bad](loam_accuracy_def &def) { def.tolerance = bad; });
  for (const float bad : {nan, infinity, 0.0f, -0.01f, 11.0f})
    refuses(LOAM_ACCURACY_BUDGET, {"budget"}, [bad](loam_accuracy_def &def) { def.budget = bad; });
  invalid({"def is null"}, [&] { return loam_world_use_accuracy(world(), nullptr); });
  for (const std::uint32_t size : wrong_sizes(sizeof(loam_accuracy_def))) {
    loam_accuracy_def def = of_mode(LOAM_ACCURACY_FIXED);
    def.struct_size = size;
    invalid({"struct_size"}, [&] { return loam_world_use_accuracy(world(), &def); });
  }
}

TEST_F(Accuracy, WhatContradictsItselfIsRefused) {
  refuses(LOAM_ACCURACY_FIXED, {"tolerance", "mode is 0"}, [](loam_accuracy_def &def) { def.tolerance = 0.01f; });
  refuses(LOAM_ACCURACY_FIXED, {"budget", "mode is 0"}, [](loam_accuracy_def &def) { def.budget = 0.01f; });
  refuses(LOAM_ACCURACY_TOLERANCE, {"budget", "mode is 1"}, [](loam_accuracy_def &def) { def.budget = 0.01f; });
  refuses(LOAM_ACCURACY_BUDGET, {"tolerance", "mode is 2"}, [](loam_accuracy_def &def) { def.tolerance = 0.01f; });
  refuses(LOAM_ACCURACY_BUDGET, {"substeps", "8"}, [](loam_accuracy_def &def) { def.substeps = 8; });
}

TEST_F(Accuracy, PresetsCostMoreOneAfterTheOther) {
  loam_accuracy_def def;
  invalid({"preset", "4"}, [&] { return loam_accuracy_def_preset(4, &def, sizeof def); });
  invalid({"def is null"}, [&] { return loam_accuracy_def_preset(0, nullptr, sizeof def); });
  std::uint64_t before = 0;
  for (std::uint32_t preset = LOAM_ACCURACY_PRESET_FAST; preset <= LOAM_ACCURACY_PRESET_REFERENCE; ++preset) {
    ASSERT_EQ(loam_accuracy_def_preset(preset, &def, sizeof def), LOAM_OK);
    ASSERT_EQ(loam_world_use_accuracy(world(), &def), LOAM_OK);
    world_.step(1.0f / 60);
    const loam_statistics now = world_.statistics();
    EXPECT_GT(now.iterations_done, before) << preset;
    EXPECT_EQ(now.substeps_reason, std::uint32_t(LOAM_SUBSTEPS_STIFFNESS)) << preset; // sand of 1 MPa
    before = now.iterations_done;
  }
}

TEST_F(Accuracy, AToleranceIsReportedAndReached) {
  loam_accuracy_def def = of_mode(LOAM_ACCURACY_TOLERANCE);
  def.substeps = 8;
  def.iterations = 200;
  std::uint64_t before = 0;
  for (const float tolerance : {0.1f, 0.01f, 0.001f}) {
    scenes::World world(definition(scene_), scene_);
    def.tolerance = tolerance;
    ASSERT_EQ(loam_world_use_accuracy(world.get(), &def), LOAM_OK);
    world.step(8e-3f);
    const loam_statistics now = world.statistics();
    EXPECT_GT(now.solution_error, 0);
    EXPECT_LE(now.solution_error, double(tolerance));
    EXPECT_EQ(now.substeps_unsolved, 0u);
    EXPECT_LT(now.iterations, 200u);
    EXPECT_GT(now.iterations_done, before);
    before = now.iterations_done;
  }
  scenes::World world(definition(scene_), scene_);
  def.iterations = 3; // capped: told
  ASSERT_EQ(loam_world_use_accuracy(world.get(), &def), LOAM_OK);
  world.step(8e-3f);
  EXPECT_GT(world.statistics().solution_error, 0.001);
  EXPECT_EQ(world.statistics().substeps_unsolved, 8u);
  EXPECT_EQ(world.statistics().iterations_done, 24u);
}

TEST_F(Accuracy, ConvergenceTakesMemoryAndAStageOnlyWithATolerance) {
  const std::uint64_t before = world_.memory_bytes();
  EXPECT_FALSE(world_.has_stage("convergence"));
  const loam_accuracy_def def = of_mode(LOAM_ACCURACY_TOLERANCE);
  ASSERT_EQ(loam_world_use_accuracy(world(), &def), LOAM_OK);
  world_.step(1e-3f);
  EXPECT_TRUE(world_.has_stage("convergence"));
  EXPECT_GE(world_.memory_bytes(), before + 32 * 64);
  ASSERT_EQ(loam_world_set_accuracy(world(), 2, 5), LOAM_OK);
  world_.step(1e-3f);
  EXPECT_FALSE(world_.has_stage("convergence"));
  EXPECT_EQ(world_.memory_bytes(), before);
}

TEST_F(Accuracy, ABudgetsChoicesMakeTheSameBitsAgain) {
  scenes::World again(definition(scene_), scene_);
  scenes::World budgeted(definition(scene_), scene_);
  loam_accuracy_def def = of_mode(LOAM_ACCURACY_BUDGET);
  def.budget = 1e-3f;
  def.most_substeps = 40;
  ASSERT_EQ(loam_world_use_accuracy(budgeted.get(), &def), LOAM_OK);
  for (int frame = 0; frame < 6; ++frame) {
    /* Whether the budget was enough is for the machine to say; the step is done either way. */
    const loam_status status = loam_world_step(budgeted.get(), 1.0f / 60);
    ASSERT_TRUE(status == LOAM_OK || status == LOAM_ERROR_BUDGET) << loam_last_error();
    const loam_statistics chosen = budgeted.statistics();
    ASSERT_EQ(loam_world_set_accuracy(again.get(), chosen.substeps, chosen.iterations), LOAM_OK);
    again.step(1.0f / 60);
    ASSERT_EQ(budgeted.state_hash(), again.state_hash()) << frame;
  }
}

/* Nothing is solved, yet the choice is told as one that can be given again. */
TEST_F(Accuracy, ABudgetOfAnEmptyWorldCanBeReplayed) {
  scenes::World empty(definition(scene_));
  const loam_accuracy_def def = of_mode(LOAM_ACCURACY_BUDGET);
  ASSERT_EQ(loam_world_use_accuracy(empty.get(), &def), LOAM_OK);
  for (int frame = 0; frame < 3; ++frame) empty.step(1.0f / 60);
  const loam_statistics now = empty.statistics();
  EXPECT_EQ(now.iterations_done, 0u);
  EXPECT_EQ(loam_world_set_accuracy(empty.get(), now.substeps, now.iterations), LOAM_OK) << loam_last_error();
}

/* A stream without room is told of after every step; what the steps cost is learnt all the same. */
TEST_F(Accuracy, ABudgetIsKeptWhileAStreamIsFull) {
  loam_world_def world_def = definition(scene_);
  world_def.particle_capacity = scene_.count();
  scenes::World full(world_def, scene_);
  loam_material_id material = 0;
  ASSERT_EQ(loam_material_create(full.get(), &scene_.material, &material), LOAM_OK);
  loam_emitter_def emitter;
  ASSERT_EQ(loam_emitter_def_default(&emitter, sizeof emitter), LOAM_OK);
  emitter.material = material;
  emitter.position[1] = 1;
  emitter.radius = 0.02f;
  emitter.speed = 10;
  loam_emitter_id id = 0;
  ASSERT_EQ(loam_emitter_create(full.get(), &emitter, &id), LOAM_OK) << loam_last_error();
  loam_accuracy_def def = of_mode(LOAM_ACCURACY_BUDGET);
  def.budget = 10; // pays for far more than stability needs, on any machine
  def.most_substeps = 40;
  ASSERT_EQ(loam_world_use_accuracy(full.get(), &def), LOAM_OK);
  for (int frame = 0; frame < 3; ++frame) EXPECT_EQ(loam_world_step(full.get(), 1.0f / 60), LOAM_ERROR_CAPACITY);
  EXPECT_EQ(full.statistics().substeps, 40u);
  EXPECT_GT(full.statistics().least_budget, 0);
}

/* A particle 0.3 r above a plane: 0.2 r too near. It is moved out; but not from a slot of 0.6 r. */
TEST_F(Accuracy, PenetrationIsHowMuchIsMissingToHalfTheRadius) {
  scenes::Scene lone;
  lone.material = scenes::rubber();
  lone.spacing = 0.01f;
  lone.positions = {0, 0.003f, 0};
  lone.planes = {{{0, 0, 0}, {0, 1, 0}, 0}};
  const auto after = [&](int steps) {
    loam_world_def def = scenes::world_def(lone);
    def.substeps = 1;
    scenes::World world(def, lone);
    for (int k = 0; k < steps; ++k) world.step(2e-3f);
    return world.statistics().penetration;
  };
  EXPECT_NEAR(after(1), 0.002, 1e-6);
  EXPECT_NEAR(after(500), 0, 2e-5);
  lone.planes.push_back({{0, 0.006f, 0}, {0, -1, 0}, 0});
  EXPECT_NEAR(after(500), 0.002, 2e-4);
}

TEST_F(Accuracy, DensityErrorIsTheMeanCompressionThatTheViewShows) {
  for (const float spacing : {0.009f, 0.01f}) {
    scenes::Scene water;
    water.spacing = 0.01f;
    ASSERT_EQ(loam_material_def_default(LOAM_LAW_FLUID, &water.material, sizeof water.material), LOAM_OK);
    for (int i = 0; i < 512; ++i)
      for (const int place : {i % 8, i / 8 % 8, i / 64}) water.positions.push_back(spacing * float(place));
    loam_world_def def = scenes::world_def(water);
    def.substeps = 1;
    scenes::World world(def, water);
    world.step(1e-4f);
    loam_particle_view view = {};
    view.struct_size = sizeof view;
    ASSERT_EQ(loam_particles_map(world.get(), &view), LOAM_OK);
    double sum = 0;
    for (std::uint64_t i = 0; i < view.count; ++i) sum += std::max(0.0, double(view.densities[i]) / 1000 - 1);
    ASSERT_EQ(loam_particles_unmap(world.get()), LOAM_OK);
    EXPECT_NEAR(world.statistics().density_error, sum / 512, 1e-4);
    EXPECT_EQ(world.statistics().density_error > 0.05, spacing < 0.01f);
  }
}

TEST_F(Accuracy, ABudgetTooSmallIsToldAndTheStepIsDone) {
  loam_accuracy_def def = of_mode(LOAM_ACCURACY_BUDGET);
  def.budget = 1e-9f;
  ASSERT_EQ(loam_world_use_accuracy(world(), &def), LOAM_OK);
  world_.step(1.0f / 60); // what it costs is not known yet
  const std::uint64_t before = world_.state_hash();
  EXPECT_EQ(loam_world_step(world(), 1.0f / 60), LOAM_ERROR_BUDGET);
  test::expect_error_names({"budget", "1e-09", "stability"});
  const loam_statistics now = world_.statistics();
  EXPECT_GT(now.least_budget, 1e-9);
  EXPECT_EQ(now.substeps_done, now.substeps);
  EXPECT_EQ(now.iterations, 2u);
  EXPECT_NE(world_.state_hash(), before);
}

} // namespace
} // namespace loam
