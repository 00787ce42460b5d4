/* material_design.h: presets, and the formulas from what can be seen to what a law wants. */
#include "small_world.h"

#include <numbers>
#include <set>

namespace loam {
namespace {

using test::infinity;
using test::nan;

loam_material_def preset(const char *name) {
  loam_material_def def;
  EXPECT_EQ(loam_material_def_preset(name, &def, sizeof def), LOAM_OK) << name << ": " << loam_last_error();
  return def;
}

class Presets : public test::SmallWorld {};

TEST_F(Presets, EveryNameGivesAMaterialThatAWorldTakes) {
  std::set<std::string> names;
  for (std::uint32_t index = 0; loam_material_preset_name(index) != nullptr; ++index) {
    const char *name = loam_material_preset_name(index);
    const loam_material_def def = preset(name);
    EXPECT_STREQ(def.name, name);
    EXPECT_EQ(def.struct_size, sizeof def);
    loam_material_id id = 0;
    EXPECT_EQ(scenes::outcome(loam_material_create(world(), &def, &id)), "LOAM_OK") << name;
    names.insert(name);
  }
  EXPECT_EQ(names, (std::set<std::string>{"dry sand", "wet sand", "packed snow", "powder snow", "plasticine", "aluminium",
                                          "candy", "shaving foam", "paint", "toothpaste", "dough", "mud", "water"}));
  EXPECT_EQ(loam_material_preset_name(std::uint32_t(names.size())), nullptr);
  EXPECT_EQ(loam_material_preset_name(~0u), nullptr);
}

TEST_F(Presets, EveryPresetFallsAndStaysFinite) {
  for (std::uint32_t index = 0; loam_material_preset_name(index) != nullptr; ++index) {
    const char *name = loam_material_preset_name(index);
    scenes::Scene scene = scenes::drop_block(preset(name), 6, 0.05f, 1);
    loam_world_def def = scenes::world_def(scene);
    scenes::World block(def, scene);
    for (int frame = 0; frame < 12; ++frame) block.step(1.0f / 60);
    EXPECT_EQ(block.statistics().non_finite, 0u) << name;
    const scenes::Snapshot now = block.snapshot();
    float lowest = 1, fastest = 0;
    for (std::size_t i = 0; i < now.positions.size(); i += 3) {
      lowest = std::min(lowest, now.positions[i + 1]);
      for (int k = 0; k < 3; ++k) fastest = std::max(fastest, std::fabs(now.velocities[i + std::size_t(k)]));
    }
    EXPECT_GT(lowest, 0.004f) << name; // on the ground, less the stand-off
    EXPECT_LT(fastest, 5) << name;     // it came down at 1.4 m/s
  }
}

TEST_F(Presets, AnUnknownNameIsAnsweredWithThoseThereAre) {
  loam_material_def def;
  for (const char *name : {"", "sand", "Dry sand", "dry sand ", "%s%s%n"}) {
    std::memset(static_cast<void *>(&def), 0x5A, sizeof def);
    invalid({std::string("\"") + name + "\"", "dry sand", "wet sand", "packed snow", "toothpaste", "mud"},
            [&] { return loam_material_def_preset(name, &def, sizeof def); });
    EXPECT_EQ(def.struct_size, 0x5A5A5A5Au);
  }
  const std::string long_name(10000, 'x');
  invalid({"xxx", "mud"}, [&] { return loam_material_def_preset(long_name.c_str(), &def, sizeof def); });
  invalid({"name is null"}, [&] { return loam_material_def_preset(nullptr, &def, sizeof def); });
  invalid({"def is null"}, [&] { return loam_material_def_preset("mud", nullptr, sizeof def); });
  for (const std::uint32_t size : wrong_sizes(sizeof def))
    invalid({"def", std::to_string(size)}, [&] { return loam_material_def_preset("mud", &def, size); });
}

/* ---------------------------------------------------------------------------------------------------- formulas --- */

class Design : public test::SmallWorld {
protected:
  /* Calls with each argument in turn null, out of range, and as it should be. */
  template <std::size_t N, class Call>
  void refuses_each(const std::array<const char *, N> &names, const std::array<float, N> &good, Call &&call) {
    float result = 12345;
    EXPECT_EQ(scenes::outcome(call(good, &result)), "LOAM_OK");
    EXPECT_TRUE(std::isfinite(result) && result > 0);
    invalid({"is null"}, [&] { return call(good, nullptr); });
    for (std::size_t k = 0; k < N; ++k)
      for (const float bad : {-1.0f, nan, infinity, -infinity, 1e30f}) {
        std::array<float, N> arguments = good;
        arguments[k] = bad;
        result = 12345;
        invalid({names[k], "must be"}, [&] { return call(arguments, &result); });
        EXPECT_EQ(result, 12345) << names[k];
      }
  }
};

constexpr float degrees = std::numbers::pi_v<float> / 180;

TEST_F(Design, FrictionAngleOfASlope) {
  // The slopes at which layers of 20, 30 and 40 degrees start to flow.
  const std::pair<float, float> pairs[] = {{24.0f, 20}, {34.7f, 30}, {43.4f, 40}};
  for (const auto &[slope, expected] : pairs) {
    float angle = 0;
    ASSERT_EQ(loam_design_friction_angle(slope * degrees, &angle), LOAM_OK);
    EXPECT_NEAR(angle / degrees, expected, 0.06) << slope;
  }
  refuses_each<1>({"angle_of_repose"}, {0.5f}, [](const auto &a, float *r) { return loam_design_friction_angle(a[0], r); });
  float angle = 0;
  ASSERT_EQ(loam_design_friction_angle(1.04f, &angle), LOAM_OK);
  EXPECT_LE(angle, 1.5f);
  invalid({"angle_of_repose", "30"}, [&] { return loam_design_friction_angle(30, &angle); }); // degrees
}

TEST_F(Design, YoungsModulusOfAColumnThatSinks) {
  float modulus = 0;
  ASSERT_EQ(loam_design_youngs_modulus(1000, 10, 1, 0.05f, &modulus), LOAM_OK);
  EXPECT_NEAR(modulus, 1e5f, 1);
  refuses_each<4>({"density", "gravity", "height", "sinking"}, {1000, 9.81f, 1, 0.01f},
                  [](const auto &a, float *r) { return loam_design_youngs_modulus(a[0], a[1], a[2], a[3], r); });
  invalid({"sinking", "0.2", "0.1"}, [&] { return loam_design_youngs_modulus(1000, 10, 1, 0.2f, &modulus); });
}

TEST_F(Design, YieldStressOfAColumnThatStands) {
  float uniaxial = 0, shear = 0;
  ASSERT_EQ(loam_design_yield_stress(1500, 10, 0.2f, &uniaxial), LOAM_OK);
  ASSERT_EQ(loam_design_shear_yield_stress(1500, 10, 0.2f, &shear), LOAM_OK);
  EXPECT_NEAR(uniaxial, 3000, 0.01);
  EXPECT_NEAR(shear, 3000 / std::sqrt(3.0), 0.01);
  const std::array<const char *, 3> names = {"density", "gravity", "height"};
  refuses_each<3>(names, {1000, 9.81f, 1},
                  [](const auto &a, float *r) { return loam_design_yield_stress(a[0], a[1], a[2], r); });
  refuses_each<3>(names, {1000, 9.81f, 1},
                  [](const auto &a, float *r) { return loam_design_shear_yield_stress(a[0], a[1], a[2], r); });
}

TEST_F(Design, YieldStressOfAPuddle) {
  // The fifty-cent rheometer: a litre of 2000 kg/m^3 that spreads to a radius of 0.2 m.
  float stress = 0;
  ASSERT_EQ(loam_design_puddle_yield_stress(2000, 10, 1e-3f, 0.2f, &stress), LOAM_OK);
  EXPECT_NEAR(stress, 225 * 2000 * 10 * 1e-6 / (128 * 9.8696044 * std::pow(0.2, 5)), 1e-3);
  refuses_each<4>({"density", "gravity", "volume", "radius"}, {1000, 9.81f, 1e-3f, 0.2f},
                  [](const auto &a, float *r) { return loam_design_puddle_yield_stress(a[0], a[1], a[2], a[3], r); });
}

TEST_F(Design, ConsistencyOfAFilm) {
  const auto call = [](const std::array<float, 7> &a, float *r) {
    return loam_design_consistency(a[0], a[1], a[2], a[3], a[4], a[5], a[6], r);
  };
  // Bingham down a wall: speed = density g hs^2 / (2 k), here with half the film a plug.
  float consistency = 0;
  ASSERT_EQ(call({1000, 10, 50, 1, 0.01f, std::numbers::pi_v<float> / 2, 0.05f}, &consistency), LOAM_OK);
  EXPECT_NEAR(consistency, 1e4 * 0.005 * 0.005 / (2 * 0.05), 1e-4);
  // Integrated once more: the shear rate at depth z under the plug is (pull z / k)^(1/n).
  for (const float n : {0.3f, 0.5f, 2.0f}) {
    ASSERT_EQ(call({1300, 9.81f, 20, n, 0.02f, 0.6f, 0.3f}, &consistency), LOAM_OK);
    const double pull = 1300 * 9.81 * std::sin(0.6), sheared = 0.02 - 20 / pull;
    double speed = 0;
    for (int i = 0; i < 10000; ++i)
      speed += sheared / 10000 * std::pow(pull * sheared * (i + 0.5) / 10000 / double(consistency), 1 / double(n));
    EXPECT_NEAR(speed, 0.3, 3e-4) << n;
  }
  refuses_each<7>({"density", "gravity", "shear_yield_stress", "flow_exponent", "thickness", "slope", "speed"},
                  {1300, 9.81f, 20, 0.5f, 0.02f, 0.6f, 0.3f}, call);
  invalid({"thickness", "0.001", "does not flow"}, [&] { return call({1000, 10, 50, 1, 0.001f, 1, 0.05f}, &consistency); });
}

TEST_F(Design, StrengthsOfBrittleMatter) {
  loam_material_def def = preset("candy");
  const double bulk = 1e6 / (3 * (1 - 0.6));
  ASSERT_EQ(scenes::outcome(loam_design_strengths(&def, 1e5f, 4e4f, 30 * degrees, 0.01f)), "LOAM_OK");
  EXPECT_NEAR(bulk * (1e-5 + std::sinh(-double(def.hardening_factor) * double(def.consolidation))), 1e5, 1);
  EXPECT_NEAR(double(def.cohesion_ratio) * 1e5, 4e4, 1);
  EXPECT_NEAR(std::exp(-double(def.consolidation)), 1.01, 1e-6);
  EXPECT_NEAR(def.critical_state_slope, 1.2, 1e-5); // 6 / 2 / 2.5
  loam_material_id id = 0;
  EXPECT_EQ(scenes::outcome(loam_material_create(world(), &def, &id)), "LOAM_OK");
  for (const float bad : {-1.0f, nan, infinity}) {
    const loam_material_def before = def;
    invalid({"compressive"}, [&] { return loam_design_strengths(&def, bad, 4e4f, 0.5f, 0.01f); });
    invalid({"tensile"}, [&] { return loam_design_strengths(&def, 1e5f, bad, 0.5f, 0.01f); });
    invalid({"friction_angle"}, [&] { return loam_design_strengths(&def, 1e5f, 4e4f, bad, 0.01f); });
    invalid({"opening"}, [&] { return loam_design_strengths(&def, 1e5f, 4e4f, 0.5f, bad); });
    EXPECT_EQ(std::memcmp(&before, &def, sizeof def), 0);
  }
  invalid({"compressive", "must be"}, [&] { return loam_design_strengths(&def, 1e9f, 4e4f, 0.5f, 0.01f); });
  invalid({"hardening_factor"}, [&] { return loam_design_strengths(&def, 2.5e6f, 4e4f, 0.5f, 1e-4f); });
  invalid({"def is null"}, [&] { return loam_design_strengths(nullptr, 1e5f, 4e4f, 0.5f, 0.01f); });
  loam_material_def sand = preset("dry sand");
  invalid({"law is 2"}, [&] { return loam_design_strengths(&sand, 1e5f, 4e4f, 0.5f, 0.01f); });
  def.struct_size = 64;
  invalid({"struct_size", "64"}, [&] { return loam_design_strengths(&def, 1e5f, 4e4f, 0.5f, 0.01f); });
}

} // namespace
} // namespace loam
