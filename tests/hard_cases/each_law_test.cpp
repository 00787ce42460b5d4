/* What every law must survive: drops at the edge of what a substep can carry, being torn apart, folded through itself, crushed, and changed while it runs. */
#include "hard_case.h"

namespace loam {
namespace {

using test::block;
using test::HardCase;
using test::Outcome;
using test::survive;
using test::without_planes;

class EachLaw : public test::OfASolver {};
INSTANTIATE_TEST_SUITE_P(Solvers, EachLaw, test::every_solver(), test::solver_name);

/* With a Young's modulus for which elastic waves cross `particles` of them in a substep: c h / r, c^2 = (lambda + 2 mu) / density. */
loam_material_def with_waves_of(loam_material_def material, float particles, float substep, float spacing) {
  const float c = particles * spacing / substep, nu = material.poissons_ratio;
  material.youngs_modulus = material.density * c * c * (1 + nu) * (1 - 2 * nu) / (1 - nu);
  return material;
}

TEST_P(EachLaw, DroppedAtAMetrePerSecondWithWavesThatCrossManyParticles) {
  test::shows("every law, c h / r = 4 and 30: what an unconverged substep stores, it must not give back as more");
  for (const loam_material_def &material : scenes::each_law())
    for (const float waves : {4.0f, 30.0f}) {
      HardCase hard(GetParam());
      hard.parts = {block(with_waves_of(material, waves, 1.0f / 960, 0.01f), 4, 0.005f, 1)};
      hard.steps = 24;
      hard.greatest_gain = 1.01;
      const Outcome outcome = survive(hard);
      EXPECT_GT(outcome.lowest, 0.0025) << material.name << " " << waves;
      EXPECT_LT(outcome.mean_height, 0.07) << material.name << " " << waves;
    }
}

/* Large enough for a wave to be reflected within, and turning, so that each substep deforms it by several percent: a model of small motions overshoots
 * here, and rubber bursts. */
TEST_P(EachLaw, SpinningRubberAsStiffAsASubstepCarriesHitsTheGround) {
  test::shows("a cube of rubber that turns at 40 rad/s hits the ground at 5 m/s, c h / r = 3 and 30");
  for (const float waves : {3.0f, 30.0f}) {
    scenes::Scene cube = block(with_waves_of(scenes::rubber(), waves, 1.0f / 960, 0.01f), 7, 0.01f, 5);
    for (std::size_t i = 0; i < cube.positions.size(); i += 3) {
      cube.velocities[i] += 40 * (cube.positions[i + 1] - 0.045f);
      cube.velocities[i + 1] -= 40 * cube.positions[i];
    }
    HardCase hard(GetParam(), {cube});
    hard.steps = 24;
    hard.greatest_gain = 1.01;
    const Outcome outcome = survive(hard);
    EXPECT_GT(outcome.lowest, 0.0025) << waves;
  }
}

TEST_P(EachLaw, DroppedInSubstepsOfASixtiethOfASecond) {
  test::shows("every law, one substep a frame, dropped at 1 m/s");
  for (const loam_material_def &material : scenes::each_law()) {
    HardCase hard(GetParam(), {block(material, 5, 0.05f, 1, 0, 0.05f)});
    hard.def.kernel_radius = 0.05f;
    hard.def.substeps = 1;
    hard.step_seconds = 1.0f / 60;
    hard.steps = 90;
    hard.greatest_gain = 1.01;
    const Outcome outcome = survive(hard);
    EXPECT_GT(outcome.lowest, 0.0125) << material.name;
    EXPECT_LT(outcome.statistics.mean_speed, 1) << material.name;
  }
}

/* Ends flying apart at 4 m/s each: nothing holds that together, and what tears off may not be faster than it was. */
TEST_P(EachLaw, TornApart) {
  test::shows("every law pulled apart at 100 / s, far beyond what holds");
  for (const loam_material_def &material : scenes::each_law()) {
    scenes::Scene bar = without_planes(block(material, 4, 0));
    for (std::size_t i = 0; i < bar.positions.size(); i += 3) {
      bar.velocities[i] = 150 * bar.positions[i];
      bar.positions[i] *= 1.5f; // already thin
    }
    HardCase hard(GetParam(), {bar});
    hard.def.gravity[1] = 0;
    hard.steps = 20;
    hard.greatest_gain = 1.01;
    survive(hard);
  }
}

/* Clay with the strength of candy snaps: both halves fly on. */
TEST_P(EachLaw, ABrittleBarSnapsIntoTwo) {
  test::shows("brittle clay (NACC) pulled until it snaps; both halves fly on, none of the fragments faster than it was");
  loam_material_def candy = {};
  scenes::require(loam_material_def_preset("candy", &candy, sizeof candy), "preset");
  scenes::Scene bar = without_planes(block(candy, 4, 0));
  const std::vector<float> once = bar.positions;
  for (const float shift : {0.04f, 0.08f})
    for (std::size_t i = 0; i < once.size(); i += 3)
      bar.positions.insert(bar.positions.end(), {once[i] + shift, once[i + 1], once[i + 2]});
  bar.velocities.assign(bar.positions.size(), 0.0f);
  for (std::size_t i = 0; i < bar.positions.size(); i += 3) bar.velocities[i] = bar.positions[i] < 0.04f ? -2.0f : 2.0f;
  HardCase hard(GetParam(), {bar});
  hard.def.gravity[1] = 0;
  hard.steps = 30;
  hard.greatest_gain = 1.01;
  const Outcome outcome = survive(hard);
  float left = 1e30f, right = -1e30f;
  for (std::size_t i = 0; i < outcome.end.positions.size(); i += 3) {
    left = std::min(left, outcome.end.positions[i]);
    right = std::max(right, outcome.end.positions[i]);
  }
  EXPECT_GT(right - left, 0.12f + 0.5f); // 0.25 s apart at 4 m/s would be 1 m
}

/* Every particle sent to its mirror image, as far as the speed limit lets it go. */
TEST_P(EachLaw, TurnedInsideOutInOneSubstep) {
  test::shows("every law sent through itself, towards its mirror image, at the speed limit");
  for (const loam_material_def &material : scenes::each_law()) {
    scenes::Scene folded = block(material, 4, 0.1f);
    for (std::size_t i = 0; i < folded.positions.size(); i += 3)
      folded.velocities[i + 1] = -1920 * (folded.positions[i + 1] - 0.12f);
    HardCase hard(GetParam(), {folded});
    hard.steps = 24;
    hard.greatest_gain = 1.01;
    const Outcome outcome = survive(hard);
    EXPECT_GT(outcome.lowest, 0.0025) << material.name;
  }
}

TEST_P(EachLaw, FluidsFromThinToStiff) {
  test::shows("Herschel-Bulkley, exponents 0.1 to 10, consistencies from nothing to 1e13 Pa s^n");
  for (const float exponent : {0.1f, 0.3f, 1.0f, 3.0f, 10.0f})
    for (const float consistency : {1e-12f, 1e4f, 1e13f}) {
      loam_material_def fluid = {};
      scenes::require(loam_material_def_preset("mud", &fluid, sizeof fluid), "preset");
      fluid.flow_exponent = exponent;
      fluid.consistency = consistency;
      fluid.shear_yield_stress = 0;
      HardCase hard(GetParam(), {block(fluid, 4, 0.005f, 3)});
      hard.steps = 16;
      hard.greatest_gain = 1.01;
      const Outcome outcome = survive(hard);
      EXPECT_GT(outcome.lowest, 0.0025) << exponent << " " << consistency;
      EXPECT_LT(outcome.mean_height, 0.07) << exponent << " " << consistency;
    }
}

/* Snow and clay whose strength grows as steeply as is allowed, pressed flat by a plate and let go. */
TEST_P(EachLaw, HardeningAsSteepAsAllowedUnderAPress) {
  test::shows("snow and clay that harden as steeply as is allowed, pressed flat and let go");
  const meshes::Mesh plate = meshes::box(0.2f, 0.01f, 0.2f);
  for (const std::uint32_t law : {LOAM_LAW_NACC, LOAM_LAW_STOMAKHIN_SNOW})
    for (const float hardening : {1.0f, 1000.0f}) {
      loam_material_def snow;
      scenes::require(loam_material_def_default(law, &snow, sizeof snow), "default");
      snow.hardening_factor = hardening;
      snow.consolidation = -0.5f / hardening;
      HardCase hard(GetParam(), {block(snow, 4, 0)});
      loam_collider_id id = 0;
      hard.prepare = [&](scenes::World &world) { id = test::add_mesh(world, plate, 0.6f, 0, 0.06f, 0); };
      hard.each = [&](scenes::World &world, int step) {
        const float height = step < 20 ? 0.06f - 0.002f * float(step) : 0.02f + 0.004f * float(step - 20);
        const float at[3] = {0, std::max(height, 0.022f), 0}, upright[4] = {0, 0, 0, 1};
        scenes::require(loam_collider_move(world.get(), id, at, upright), "move");
      };
      hard.steps = 40;
      const Outcome outcome = survive(hard);
      EXPECT_GT(outcome.lowest, 0.0) << law << " " << hardening;
    }
}

TEST_P(EachLaw, UnderGravityThatFlips) {
  test::shows("every law in gravity of 30 m/s^2 that turns about in every frame");
  for (const loam_material_def &material : scenes::each_law()) {
    HardCase hard(GetParam(), {block(material, 4, 0)});
    hard.steps = 24;
    hard.each = [](scenes::World &world, int step) {
      const float up[3] = {0, 30, 0}, down[3] = {0, -30, 0};
      scenes::require(loam_world_set_gravity(world.get(), step % 2 == 0 ? up : down), "gravity");
    };
    const Outcome outcome = survive(hard);
    EXPECT_GT(outcome.lowest, 0.0025) << material.name;
    EXPECT_LT(outcome.peak_speed, 2) << material.name;
  }
}

/* A long step may leave pairs too near, and a short one parts them within itself, fast: energy is not bounded here, only what follows from the speed
 * limit. */
TEST_P(EachLaw, StepsThatChangeFromAHundredThousandthToASixtiethOfASecond) {
  test::shows("every law, each step of another length than the one before: 1e-5 to 1/60 s");
  for (const loam_material_def &material : scenes::each_law()) {
    HardCase hard(GetParam(), {block(material, 4, 0.005f)});
    hard.def.substeps = 1;
    hard.step_seconds = 1e-5f; // the longer ones are made before it
    hard.steps = 24;
    hard.each = [](scenes::World &world, int step) {
      world.step(step % 3 == 0 ? 1.0f / 60 : step % 3 == 1 ? 1e-3f : 1e-5f);
    };
    const Outcome outcome = survive(hard);
    EXPECT_GT(outcome.lowest, 0.0025) << material.name;
  }
}

/* A host that turns a knob from end to end in every frame. Matter that stiffens while it is strained gains energy, but no more than is fatal. */
TEST_P(EachLaw, StiffnessChangedAHundredfoldInEveryFrame) {
  test::shows("every law, its Young's modulus switched between 1e4 and 1e6 Pa in every frame");
  for (const loam_material_def &material : scenes::each_law()) {
    HardCase hard(GetParam(), {block(material, 4, 0)});
    hard.steps = 24;
    std::vector<loam_material_id> ids;
    hard.materials = &ids;
    hard.each = [&](scenes::World &world, int step) {
      loam_material_def def = material;
      def.youngs_modulus = step % 2 == 0 ? 1e4f : 1e6f;
      scenes::require(loam_material_set(world.get(), ids[0], &def), "set");
    };
    const Outcome outcome = survive(hard);
    EXPECT_GT(outcome.lowest, 0.0025) << material.name;
    EXPECT_LT(outcome.peak_speed, 3) << material.name;
  }
}

class Mixture : public test::OfASolver {
protected:
  /* Every law, particle by particle, in one falling block. */
  HardCase every_law() const {
    const std::vector<loam_material_def> laws = scenes::each_law();
    HardCase hard(GetParam());
    for (std::size_t law = 0; law < laws.size(); ++law) {
      scenes::Scene part = block(laws[law], 8, 0.03f, 1);
      std::vector<float> positions, velocities;
      for (std::size_t i = (law * 7) % laws.size(); i < part.count(); i += laws.size())
        for (std::size_t k = 0; k < 3; ++k) {
          positions.push_back(part.positions[3 * i + k]);
          velocities.push_back(part.velocities[3 * i + k]);
        }
      part.positions = positions;
      part.velocities = velocities;
      if (law > 0) part.planes.clear();
      hard.parts.push_back(part);
    }
    hard.greatest_gain = 1.01;
    return hard;
  }
};
INSTANTIATE_TEST_SUITE_P(Solvers, Mixture, test::every_solver(), test::solver_name);

TEST_P(Mixture, EveryLawParticleByParticle) {
  test::shows("every law in one block, particle by particle, as one continuum");
  const Outcome outcome = survive(every_law());
  EXPECT_GT(outcome.lowest, 0.0025);
  EXPECT_LT(outcome.statistics.mean_speed, 0.3);
}

TEST_P(Mixture, EveryLawParticleByParticleMeetingByContact) {
  test::shows("the same, all of them meeting by frictional contact: no particle has neighbours of its own");
  HardCase hard = every_law();
  for (scenes::Scene &part : hard.parts)
    for (float &x : part.positions) x *= 1.4f; // no two nearer than contact keeps them
  std::vector<loam_material_id> ids;
  hard.materials = &ids;
  hard.prepare = [&](scenes::World &world) {
    for (std::size_t a = 0; a < ids.size(); ++a)
      for (std::size_t b = a + 1; b < ids.size(); ++b)
        scenes::require(loam_material_set_meeting(world.get(), ids[a], ids[b], LOAM_MEETING_CONTACT, 0.3f), "meeting");
  };
  const Outcome outcome = survive(hard);
  EXPECT_GT(outcome.lowest, 0.0025);
  EXPECT_LT(outcome.statistics.mean_speed, 0.5);
}

TEST_P(Mixture, MetalDropsIntoFoamAThousandTimesLighter) {
  test::shows("metal dropped into foam of a thousandth of its density");
  loam_material_def foam = {}, metal = scenes::plasticine(1e6f, 1e8f);
  scenes::require(loam_material_def_preset("shaving foam", &foam, sizeof foam), "preset");
  foam.density = 50;
  metal.density = 5e4f;
  HardCase hard(GetParam(), {block(foam, 7, 0), without_planes(block(metal, 3, 0.075f, 1))});
  hard.greatest_gain = 1.01;
  const Outcome outcome = survive(hard);
  EXPECT_GT(outcome.lowest, 0.0025);
}

/* One minute: nothing that rests may creep, and nothing may gain energy. */
TEST_P(Mixture, APileAtRestForAMinute) {
  test::shows("a pile of sand left alone for a minute: how far it creeps, in kernel radii, is `creep`");
  scenes::Scene pile = scenes::resting_pile(scenes::sand(), 7, 20);
  HardCase hard(GetParam(), {pile});
  hard.def.substeps = 4;
  hard.step_seconds = 1.0f / 60;
  hard.steps = hooks::short_run() ? 60 : 3600;
  hard.greatest_gain = 1.001;
  scenes::Snapshot settled;
  double early = 0;
  hard.each = [&](scenes::World &world, int step) {
    if (step == hard.steps / 2) {
      settled = world.snapshot();
      early = world.statistics().kinetic_energy;
    }
  };
  std::uint64_t hash = 0;
  const Outcome outcome = test::run_once(hard, hash);
  test::record(outcome, double(hard.step_seconds) * hard.steps);
  double creep = 0;
  for (std::size_t i = 0; i < settled.count(); ++i) {
    double squared = 0;
    for (std::size_t k = 0; k < 3; ++k)
      squared += std::pow(double(outcome.end.positions[3 * i + k] - settled.positions[3 * i + k]), 2);
    creep = std::max(creep, std::sqrt(squared) / 0.01);
  }
  RecordProperty("creep", std::to_string(creep));
  RecordProperty("early", std::to_string(early));
  RecordProperty("late", std::to_string(outcome.statistics.kinetic_energy));
  if (!hooks::short_run()) {
    EXPECT_LT(creep, 0.005); // of r: a hundredth of a particle's radius
    EXPECT_LT(outcome.statistics.kinetic_energy, 1.5 * early + 1e-12);
  }
}

} // namespace
} // namespace loam
