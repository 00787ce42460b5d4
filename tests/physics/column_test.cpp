/* Collapse of granular columns against measured run-outs: (R - R0) / R0 within which 99.5 % of the matter comes to rest. Beside each band stands
 * a control that a wrong method would land on. */
#include "collapse.h"

namespace loam {
namespace {

using test::Collapse;

scenes::Scene column(int radius, float friction_degrees = 30) {
  return scenes::axisymmetric_column(scenes::sand(friction_degrees), radius, 1, 1);
}

TEST(Column, TheBaseCaseRunsOutAsMeasured) {
  const Collapse::Result result = Collapse(column(12)).run();
  RecordProperty("run_out", std::to_string(result.run_out));
  EXPECT_NEAR(result.run_out, 0.70, 0.03);
  EXPECT_GT(result.nearest, 0.65);  // position correction keeps 0.75 of r, but for what an unfinished iteration leaves
  EXPECT_GT(result.lowest, 0.0049); // nothing in the ground
}

TEST(Column, SemiImplicitPlasticityMakesJelly) {
  Collapse jelly(column(8));
  jelly.def.plasticity = LOAM_PLASTICITY_SEMI_IMPLICIT;
  const Collapse::Result result = jelly.run();
  RecordProperty("run_out", std::to_string(result.run_out));
  EXPECT_LT(result.run_out, 0.35);
}

/* One change at a time to a smaller column. */
TEST(Column, RunOutFollowsWhatItShouldAndNothingElse) {
  const auto record = [](const char *what, const Collapse::Result &result) {
    RecordProperty(what, std::to_string(result.run_out));
    return result;
  };
  const Collapse::Result base = record("base", Collapse(column(8)).run());
  EXPECT_GT(record("angle_20", Collapse(column(8, 20)).run()).run_out, base.run_out + 0.1);
  EXPECT_LT(record("angle_40", Collapse(column(8, 40)).run()).run_out, base.run_out - 0.08);
  const scenes::Scene smooth = scenes::axisymmetric_column(scenes::sand(), 8, 1, 0.3f);
  EXPECT_GT(record("ground_0_3", Collapse(smooth).run()).run_out, base.run_out + 0.2);

  // Velocity smoothing is a rate: doubling the substep must not double its effect.
  Collapse coarse(column(8));
  coarse.substep = 1e-3;
  EXPECT_NEAR(record("substep_1e_3", coarse.run()).run_out, base.run_out, 0.05);

  // Without position correction particles collapse onto each other.
  Collapse off(column(8));
  off.def.minimum_distance = 0;
  EXPECT_LT(record("uncorrected", off.run()).nearest, 0.2);
  EXPECT_GT(base.nearest, 0.65);
}

/* Between walls, Lube et al. 2005 measured 1.2 a, for tall slabs 1.9 a^(2/3), and Lajeunesse et al. 2005 1.8 a for these: at a = 3 the band reaches down to 15 %
 * under the lower one, which leaves out no more than a slab of seven spacings does not resolve. The angle is that which acts as 30 degrees in plane strain. */
TEST(Slab, RunOutMeetsTheExperimentsBands) {
  struct Case {
    int length; // a low slab needs more layers to run out in full
    float aspect;
    double least, most;
  };
  for (const auto &[length, aspect, least, most] : {Case{20, 1, 1.2, 1.8}, Case{10, 2, 2.4, 3.6}, Case{7, 3, 3.36, 5.4}}) {
    Collapse slab(scenes::slab(scenes::sand(22.2f), length, aspect, 5, 1));
    slab.def.velocity_smoothing = 0;
    slab.seconds = 0.8;
    const double run_out = slab.run().run_out;
    RecordProperty("run_out_" + std::to_string(int(aspect)), std::to_string(run_out));
    EXPECT_GT(run_out, least) << aspect;
    EXPECT_LT(run_out, most) << aspect;
  }
}

TEST(Slab, WithTheTriaxialAngleItFallsShort) { // the control: 30 degrees act as 43.9 in plane strain
  Collapse slab(scenes::slab(scenes::sand(30), 20, 1, 5, 1));
  slab.def.velocity_smoothing = 0;
  slab.seconds = 0.8;
  const double run_out = slab.run().run_out;
  RecordProperty("run_out", std::to_string(run_out));
  EXPECT_LT(run_out, 1.2);
}

/* In equilibrium the stress carries the weight: the virial is 1. */
TEST(Pile, AtRestItsVirialIsOneAndItDoesNotCreep) {
  Collapse pile(scenes::resting_pile(scenes::sand(), 12, 20));
  const double start = scenes::run_out(pile.scene.positions, pile.scene);
  pile.seconds = 1;
  const Collapse::Result result = pile.run();
  RecordProperty("virial", std::to_string(result.virial));
  RecordProperty("mean_speed", std::to_string(result.mean_speed));
  EXPECT_NEAR(result.virial, 1.05, 0.1);
  EXPECT_LT(result.mean_speed, 5e-4); // 5 % of r a second
  EXPECT_NEAR(result.run_out, start, 0.03);
}

} // namespace
} // namespace loam
