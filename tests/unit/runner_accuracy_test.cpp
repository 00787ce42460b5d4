// Accuracy on the command line and in scene files, and what a budget does to a scene.
#include <gtest/gtest.h>

#include "accuracy.h"
#include "runner_temporary_folder.h"
#include "scene_reader.h"
#include "simulation.h"

namespace {

void expect_refused(const std::string &text, const std::vector<std::string> &parts) {
  const std::string message = error_text([&] { (void)runner::parse_accuracy(text); });
  for (const std::string &part : parts)
    EXPECT_NE(message.find(part), std::string::npos) << "'" << part << "' is not in: " << message;
}

TEST(RunnerAccuracy, EveryFormIsUnderstoodAndDescribedAsItWasGiven) {
  for (const char *text : {"fast", "balanced", "accurate", "reference", "tolerance=0.02", "budget=8", "12x3"})
    EXPECT_EQ(runner::accuracy_text(runner::parse_accuracy(text)), text);
  const loam_accuracy_def budget = runner::parse_accuracy("budget=8");
  EXPECT_EQ(budget.mode, std::uint32_t(LOAM_ACCURACY_BUDGET));
  EXPECT_FLOAT_EQ(budget.budget, 0.008f);
  EXPECT_EQ(runner::parse_accuracy("12x3").substeps, 12u);
  EXPECT_EQ(runner::parse_accuracy("12x3").iterations, 3u);
}

TEST(RunnerAccuracy, WhatIsNoneIsNamed) {
  for (const char *text :
       {"", "quick", "fast ", "16", "16x", "x5", "16x5x3", "tolerance", "tolerance=", "tolerance=a", "budget=8ms"})
    expect_refused(text, {"\"" + std::string(text) + "\"", "16x5"});
  expect_refused("tolerance=0", {"tolerance is 0", "0.0001"}); // with what single precision reaches
  expect_refused("tolerance=-1", {"tolerance is -1"});
  expect_refused("tolerance=nan", {"tolerance is nan"});
  expect_refused("budget=0", {"budget is 0"});
  expect_refused("0x5", {"substeps"});
  expect_refused("20000x5", {"substeps is 20000", "10000"});
  expect_refused("16x0", {"iterations is 0"});
}

const std::string block = "[world]\nkernel_radius = 0.02\n"                            // lines 1 and 2
                          "[[materials]]\nname = \"sand\"\nlaw = \"drucker_prager\"\n" // lines 3 to 5
                          "friction_angle_degrees = 30\n"                              // line 6
                          "[[emitters]]\nmaterial = \"sand\"\n"
                          "region = { kind = \"box\", center = [0, 1, 0], half_extents = [0.1, 0.1, 0.1] }\n";

TEST(RunnerAccuracy, ASceneMayChooseIt) {
  const TemporaryFolder folder;
  const std::string with = "[world]\naccuracy = \"fast\"" + block.substr(7);
  runner::Scene scene = runner::read_scene(folder.write("scene.toml", with));
  scene.world.backend = LOAM_BACKEND_CPU;
  EXPECT_EQ(runner::accuracy_text(runner::Simulation(scene).accuracy()), "fast");
  const auto error = [&](const std::string &world) {
    const auto path = folder.write("scene.toml", "[world]\n" + world + block.substr(7));
    return error_text([&] { (void)runner::read_scene(path); });
  };
  EXPECT_NE(error("accuracy = \"fats\"").find("scene.toml:2: world.accuracy"), std::string::npos)
      << error("accuracy = \"fats\"");
  EXPECT_NE(error("accuracy = \"fast\"\nsubsteps = 4").find("scene.toml:3: world.substeps"), std::string::npos);
}

TEST(RunnerAccuracy, AStateIsGoneBackTo) {
  const TemporaryFolder folder;
  runner::Scene scene = runner::read_scene(folder.write("scene.toml", block));
  scene.world.backend = LOAM_BACKEND_CPU;
  runner::Simulation simulation(scene);
  simulation.step();
  const runner::Simulation::State state = simulation.save();
  simulation.use_accuracy(runner::parse_accuracy("3x2"));
  simulation.step();
  EXPECT_EQ(simulation.statistics().substeps, 3u);
  const std::uint64_t hash = simulation.state_hash();
  simulation.restore(state);
  EXPECT_EQ(runner::accuracy_text(simulation.accuracy()), "16x5");
  simulation.use_accuracy(runner::parse_accuracy("3x2"));
  simulation.step();
  EXPECT_EQ(simulation.state_hash(), hash);
}

// A frame that no machine makes in a nanosecond.
TEST(RunnerAccuracy, FramesOverTheBudgetAreCounted) {
  const TemporaryFolder folder;
  runner::Scene scene = runner::read_scene(folder.write("scene.toml", block));
  scene.world.backend = LOAM_BACKEND_CPU;
  scene.accuracy = runner::parse_accuracy("budget=1e-6");
  runner::Simulation simulation(scene);
  for (int frame = 0; frame < 4; ++frame) simulation.step();
  EXPECT_EQ(simulation.over_budget(), 3u); // of the first it is not known
}

} // namespace
