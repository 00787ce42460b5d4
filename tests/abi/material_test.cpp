/* material.h: every field of the definition, handles, and what a material in use refuses. */
#include "small_world.h"

namespace loam {
namespace {

using test::infinity;
using test::nan;
using test::SmallWorld;

class Materials : public SmallWorld {
protected:
  loam_material_def of_law(std::uint32_t law) {
    loam_material_def def;
    EXPECT_EQ(loam_material_def_default(law, &def, sizeof def), LOAM_OK);
    return def;
  }
  void refuses(const loam_material_def &def, const std::vector<std::string> &parts) {
    loam_material_id id = 12345;
    invalid(parts, [&] { return loam_material_create(world(), &def, &id); });
    EXPECT_EQ(id, 12345u);
  }
  std::string accepts(const loam_material_def &def) {
    loam_material_id id = 0;
    return scenes::outcome(loam_material_create(world(), &def, &id));
  }
};

TEST_F(Materials, NullArguments) {
  const loam_material_def def = of_law(LOAM_LAW_ELASTIC);
  loam_material_id id = 0;
  invalid({"world is null"}, [&] { return loam_material_create(nullptr, &def, &id); });
  invalid({"def is null"}, [&] { return loam_material_create(world(), nullptr, &id); });
  invalid({"material is null"}, [&] { return loam_material_create(world(), &def, nullptr); });
  invalid({"world is null"}, [&] { return loam_material_destroy(nullptr, material_); });
  loam_material_def back = {};
  invalid({"world is null"}, [&] { return loam_material_get(nullptr, material_, &back); });
  invalid({"def is null"}, [&] { return loam_material_get(world(), material_, nullptr); });
}

TEST_F(Materials, UnknownSizes) {
  for (const std::uint32_t size : wrong_sizes(sizeof(loam_material_def))) {
    loam_material_def def = of_law(LOAM_LAW_ELASTIC);
    def.struct_size = size;
    refuses(def, {"struct_size", std::to_string(size)});
    invalid({"def", std::to_string(size)}, [&] { return loam_material_get(world(), material_, &def); });
  }
}

TEST_F(Materials, EveryNumberHasItsRange) {
  struct Field {
    const char *name;
    std::uint32_t law;
    float loam_material_def::*member;
    std::vector<float> bad, good;
  };
  const Field fields[] = {
      {"density", LOAM_LAW_ELASTIC, &loam_material_def::density, {0, -1, 0.9e-3f, 1.1e6f}, {1e-3f, 1e6f}},
      {"youngs_modulus", LOAM_LAW_ELASTIC, &loam_material_def::youngs_modulus, {0, -1, 0.9f, 1.1e13f}, {1, 1e13f}},
      {"poissons_ratio", LOAM_LAW_ELASTIC, &loam_material_def::poissons_ratio, {-0.01f, 0.4901f, 0.5f, 1}, {0, 0.49f}},
      {"yield_stress", LOAM_LAW_VON_MISES, &loam_material_def::yield_stress, {0, -1}, {1e-3f, 1e12f}},
      {"friction_angle", LOAM_LAW_DRUCKER_PRAGER, &loam_material_def::friction_angle, {-0.01f, 1.51f, 30}, {0, 1.5f}},
      {"cohesion", LOAM_LAW_DRUCKER_PRAGER, &loam_material_def::cohesion, {-1}, {0, 1e6f}},
  };
  for (const Field &field : fields) {
    std::vector<float> bad = field.bad;
    bad.insert(bad.end(), {nan, infinity, -infinity});
    for (const float value : bad) {
      loam_material_def def = of_law(field.law);
      def.*field.member = value;
      refuses(def, {field.name, "must be"});
    }
    for (const float value : field.good) {
      loam_material_def def = of_law(field.law);
      def.*field.member = value;
      EXPECT_EQ(accepts(def), "LOAM_OK") << field.name << " " << value;
    }
  }
  for (const std::uint32_t law : {3u, ~0u}) {
    loam_material_def def = of_law(LOAM_LAW_ELASTIC);
    def.law = law;
    refuses(def, {"law", std::to_string(law)});
  }
  // The value stands in the text.
  loam_material_def def = of_law(LOAM_LAW_ELASTIC);
  def.density = -12.5f;
  refuses(def, {"density", "-12.5"});
}

TEST_F(Materials, FieldsOfOtherLawsAreIgnored) {
  loam_material_def def = of_law(LOAM_LAW_ELASTIC);
  def.yield_stress = def.friction_angle = def.cohesion = nan;
  EXPECT_EQ(accepts(def), "LOAM_OK");
  def = of_law(LOAM_LAW_DRUCKER_PRAGER);
  def.yield_stress = -1;
  EXPECT_EQ(accepts(def), "LOAM_OK");
}

TEST_F(Materials, NamesMustEnd) {
  loam_material_def def = of_law(LOAM_LAW_ELASTIC);
  std::memset(def.name, 'x', sizeof def.name);
  refuses(def, {"name"});
  def.name[sizeof def.name - 1] = 0;
  EXPECT_EQ(accepts(def), "LOAM_OK");
  def.name[0] = 0;
  EXPECT_EQ(accepts(def), "LOAM_OK");
}

TEST_F(Materials, ReadBackWhatWasGiven) {
  loam_material_def def = of_law(LOAM_LAW_DRUCKER_PRAGER), back = {};
  def.cohesion = 123;
  std::strcpy(def.name, "damp sand");
  loam_material_id id = 0;
  ASSERT_EQ(loam_material_create(world(), &def, &id), LOAM_OK);
  back.struct_size = sizeof back;
  ASSERT_EQ(loam_material_get(world(), id, &back), LOAM_OK);
  EXPECT_EQ(std::memcmp(&def, &back, sizeof def), 0);
}

TEST_F(Materials, InUseWhileParticlesAreMadeOfIt) {
  loam_particles_def def;
  ASSERT_EQ(loam_particles_def_default(&def, sizeof def), LOAM_OK);
  const float place[3] = {0, 1, 0};
  def.material = material_;
  def.count = 1;
  def.positions = place;
  ASSERT_EQ(loam_particles_add(world(), &def, nullptr), LOAM_OK);
  refused(LOAM_ERROR_IN_USE, {"sand", "1"}, [&] { return loam_material_destroy(world(), material_); });
}

TEST_F(Materials, WrongHandles) {
  const loam_material_def def = of_law(LOAM_LAW_ELASTIC);
  loam_material_id stale = 0, foreign = 0;
  ASSERT_EQ(loam_material_create(world(), &def, &stale), LOAM_OK);
  ASSERT_EQ(loam_material_destroy(world(), stale), LOAM_OK);
  const scenes::World other(definition(scene_));
  ASSERT_EQ(loam_material_create(other.get(), &def, &foreign), LOAM_OK);
  loam_material_id reused = 0;
  ASSERT_EQ(loam_material_create(world(), &def, &reused), LOAM_OK);
  EXPECT_NE(reused, stale);
  loam_particles_def particles;
  ASSERT_EQ(loam_particles_def_default(&particles, sizeof particles), LOAM_OK);
  loam_fill_def fill;
  ASSERT_EQ(loam_fill_def_default(&fill, sizeof fill), LOAM_OK);
  const float place[3] = {0, 1, 0};
  particles.positions = place;
  particles.count = 1;
  fill.region.kind = LOAM_REGION_SPHERE;
  fill.region.radius = 0.02f;
  for (const loam_material_id bad :
       {loam_material_id(0), stale, foreign, material_ + 1000, ~loam_material_id(0), collider_ ^ 0xffff}) {
    loam_material_def back = {};
    back.struct_size = sizeof back;
    particles.material = fill.material = bad;
    const auto wrong = [&](auto &&call) { refused(LOAM_ERROR_INVALID_HANDLE, {"material"}, call); };
    wrong([&] { return loam_material_destroy(world(), bad); });
    wrong([&] { return loam_material_get(world(), bad, &back); });
    wrong([&] { return loam_particles_add(world(), &particles, nullptr); });
    wrong([&] { return loam_particles_fill(world(), &fill, nullptr); });
  }
}

TEST_F(Materials, AWorldHoldsFourThousandAndNinetySix) {
  const loam_material_def def = of_law(LOAM_LAW_ELASTIC);
  loam_material_id id = 0;
  for (int k = 2; k < 4096; ++k) ASSERT_EQ(loam_material_create(world(), &def, &id), LOAM_OK) << k;
  refused(LOAM_ERROR_CAPACITY, {"4096"}, [&] { return loam_material_create(world(), &def, &id); });
  ASSERT_EQ(loam_material_destroy(world(), id), LOAM_OK);
  EXPECT_EQ(loam_material_create(world(), &def, &id), LOAM_OK);
  EXPECT_EQ(loam_world_step(world(), 1e-3f), LOAM_OK);
}

} // namespace
} // namespace loam
