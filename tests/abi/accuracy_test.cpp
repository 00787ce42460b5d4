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
    budgeted.step(1.0f / 60);
    const loam_statistics chosen = budgeted.statistics();
    ASSERT_EQ(loam_world_set_accuracy(again.get(), chosen.substeps, chosen.iterations), LOAM_OK);
    again.step(1.0f / 60);
    ASSERT_EQ(budgeted.state_hash(), again.state_hash()) << frame;
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
