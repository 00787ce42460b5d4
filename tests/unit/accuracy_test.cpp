/* How substeps and iterations are chosen. */
#include <cmath>
#include <gtest/gtest.h>

#include "scene/accuracy.h"

namespace loam {
namespace {

loam_accuracy_def chosen() {
  loam_accuracy_def def = default_accuracy();
  def.substeps = 0;
  return def;
}

/* A sixtieth of a second with r = 1 cm. */
StepNeeds needs(double speed, double wave_speed, double gravity = 9.81) {
  return {1.0 / 60, 0.01, speed, wave_speed, gravity};
}

TEST(ChooseSubsteps, WhatAsksForMostDecides) {
  struct Case {
    StepNeeds needs;
    std::uint32_t substeps, reason;
  };
  for (const Case &c : {
           Case{needs(0, 0, 0), 1, LOAM_SUBSTEPS_LEAST},
           Case{needs(3, 0), 10, LOAM_SUBSTEPS_SPEED},          // 5 cm in steps of half a radius
           Case{needs(3, 36), 20, LOAM_SUBSTEPS_STIFFNESS},     // 60 radii in steps of three
           Case{needs(0.1, 0, 9810), 24, LOAM_SUBSTEPS_WEIGHT}, // sqrt(r / 2 g) = .71 ms
           Case{needs(0, 3600), 256, LOAM_SUBSTEPS_MOST},
       }) {
    const StepChoice choice = choose_substeps(chosen(), c.needs);
    EXPECT_EQ(choice.substeps, c.substeps);
    EXPECT_EQ(choice.reason, c.reason);
    EXPECT_EQ(choice.iterations, 5u);
  }
  EXPECT_EQ(choose_substeps(default_accuracy(), needs(3, 3600)).substeps, 16u);
  EXPECT_EQ(choose_substeps(default_accuracy(), needs(3, 3600)).reason, std::uint32_t(LOAM_SUBSTEPS_GIVEN));
}

TEST(ChooseSubsteps, ClothAsksForItsOwn) {
  StepNeeds with_cloth = needs(0, 0);
  with_cloth.cloth = true;
  EXPECT_EQ(choose_substeps(chosen(), with_cloth).substeps, 8u); // 2.08 ms
  EXPECT_EQ(choose_substeps(chosen(), with_cloth).reason, std::uint32_t(LOAM_SUBSTEPS_CLOTH));
}

TEST(ChooseSubsteps, ASmallerCourantNumberCutsSpeedsToo) {
  loam_accuracy_def def = chosen();
  def.courant = 1;
  EXPECT_EQ(choose_substeps(def, needs(3, 0)).substeps, 30u); // a sixth of a radius
  EXPECT_EQ(choose_substeps(def, needs(0, 36)).substeps, 60u);
}

/* A machine on which a substep takes `substep` and an iteration `iteration` nanoseconds a particle, and all of it now and then a fifth longer. */
struct Machine {
  double substep = 150, iteration = 40, load = 10000;
  int step = 0;
  double of_iterations(const StepChoice &c) const { return 1e-9 * load * c.substeps * c.iterations * iteration; }
  double seconds(const StepChoice &c) {
    const double disturbed = ++step % 7 == 3 ? 1.2 : 1;
    return disturbed * (1e-9 * load * c.substeps * substep + of_iterations(c));
  }
};

TEST(Budget, IsMetOnAverageThoughTheLoadDoubles) {
  loam_accuracy_def def = chosen();
  def.mode = LOAM_ACCURACY_BUDGET;
  def.budget = 0.008f;
  for (const double load : {300.0, 1000.0, 5000.0}) {
    BudgetControl control;
    Machine machine;
    machine.load = load;
    double sums[2] = {0, 0};
    for (int step = 0; step < 200; ++step) {
      if (step == 100) machine.load *= 2;
      const StepChoice choice = control.choose(def, needs(0.5, 30), machine.load);
      const double seconds = machine.seconds(choice);
      control.learn(choice, seconds, machine.of_iterations(choice), machine.load, 0.008);
      sums[step / 100] += seconds / 100;
      EXPECT_FALSE(choice.exceeds_budget);
      if (step > 3 && step != 100) {
        EXPECT_EQ(choice.reason, std::uint32_t(LOAM_SUBSTEPS_BUDGET)) << load << " " << step;
        EXPECT_GE(choice.iterations, 3u) << load << " " << step;
        EXPECT_LE(choice.iterations, 9u) << load << " " << step;
      }
    }
    EXPECT_NEAR(sums[0], 0.008, 0.0004) << load;
    EXPECT_NEAR(sums[1], 0.008, 0.0004) << load;
  }
}

/* Matter at 3 m/s asks for 5 substeps; two iterations are the least. */
TEST(Budget, BelowWhatStabilityNeedsItTellsTheLeast) {
  loam_accuracy_def def = chosen();
  def.mode = LOAM_ACCURACY_BUDGET;
  def.budget = 0.008f;
  BudgetControl control;
  Machine machine;
  machine.load = 10000;
  StepChoice choice{};
  for (int step = 0; step < 20; ++step) {
    choice = control.choose(def, needs(3, 30), machine.load);
    EXPECT_EQ(choice.substeps, 5u);
    EXPECT_EQ(choice.iterations, 2u);
    control.learn(choice, machine.seconds(choice), machine.of_iterations(choice), machine.load, 0.008);
  }
  EXPECT_TRUE(choice.exceeds_budget);
  EXPECT_NEAR(choice.least_budget, 1e-9 * 10000 * 5 * (150 + 2 * 40), 0.0015); // 11.5 ms
  control.forgive();
  def.budget = 0.02f; // pays for more iterations, but not for more substeps of five
  choice = control.choose(def, needs(3, 30), machine.load);
  EXPECT_FALSE(choice.exceeds_budget);
  EXPECT_GE(choice.substeps, 5u);
  EXPECT_GE(choice.iterations, 4u);
}

} // namespace
} // namespace loam
