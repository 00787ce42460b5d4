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
  invalid({"world is null"}, [&] { return loam_material_set(nullptr, material_, &def); });
  invalid({"def is null"}, [&] { return loam_material_set(world(), material_, nullptr); });
}

TEST_F(Materials, UnknownSizes) {
  for (const std::uint32_t size : wrong_sizes(sizeof(loam_material_def))) {
    loam_material_def def = of_law(LOAM_LAW_ELASTIC);
    def.struct_size = size;
    refuses(def, {"struct_size", std::to_string(size)});
    invalid({"def", std::to_string(size)}, [&] { return loam_material_get(world(), material_, &def); });
    invalid({"def", std::to_string(size)}, [&] { return loam_material_set(world(), material_, &def); });
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
      {"hardening_modulus", LOAM_LAW_VON_MISES, &loam_material_def::hardening_modulus, {-1}, {0, 1e12f}},
      {"consolidation", LOAM_LAW_NACC, &loam_material_def::consolidation, {-0.21f, 1.1f}, {-0.2f, 1}},
      {"cohesion_ratio", LOAM_LAW_NACC, &loam_material_def::cohesion_ratio, {-0.1f, 11}, {0, 10}},
      {"hardening_factor", LOAM_LAW_NACC, &loam_material_def::hardening_factor, {0, -1, 0.09f, 1001}, {0.1f, 800}},
      {"critical_state_slope", LOAM_LAW_NACC, &loam_material_def::critical_state_slope, {0, -1, 11}, {0.01f, 10}},
      {"shear_yield_stress", LOAM_LAW_HERSCHEL_BULKLEY, &loam_material_def::shear_yield_stress, {-1}, {0, 1e12f}},
      {"consistency", LOAM_LAW_HERSCHEL_BULKLEY, &loam_material_def::consistency, {0, -1}, {1e-6f, 1e12f}},
      {"flow_exponent", LOAM_LAW_HERSCHEL_BULKLEY, &loam_material_def::flow_exponent, {0, -1, 0.09f, 10.1f}, {0.1f, 10}},
      {"critical_compression",
       LOAM_LAW_STOMAKHIN_SNOW,
       &loam_material_def::critical_compression,
       {-0.01f, 0.4f, 1},
       {0, 0.39f}},
      {"critical_stretch", LOAM_LAW_STOMAKHIN_SNOW, &loam_material_def::critical_stretch, {-0.01f, 0.65f}, {0, 0.64f}},
      {"hardening_factor", LOAM_LAW_STOMAKHIN_SNOW, &loam_material_def::hardening_factor, {-1, 1001}, {0, 1000}},
      {"viscosity", LOAM_LAW_FLUID, &loam_material_def::viscosity, {-1e-6f, 1.1e9f}, {0, 1e-6f, 1e9f}},
      {"surface_tension", LOAM_LAW_FLUID, &loam_material_def::surface_tension, {-1e-6f, 1.1e9f}, {0, 0.07f, 1e9f}},
      {"adhesion", LOAM_LAW_FLUID, &loam_material_def::adhesion, {-1e-6f, 1.1e9f}, {0, 20, 1e9f}},
      {"vorticity_confinement", LOAM_LAW_FLUID, &loam_material_def::vorticity_confinement, {-1e-6f, 1.01f}, {0, 0.5f, 1}},
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
  for (const std::uint32_t law : {7u, ~0u}) {
    loam_material_def def = of_law(LOAM_LAW_ELASTIC);
    def.law = law;
    refuses(def, {"law", std::to_string(law)});
  }
  loam_material_def choice = of_law(LOAM_LAW_NACC);
  choice.constant_hardness = 1;
  EXPECT_EQ(accepts(choice), "LOAM_OK");
  choice.constant_hardness = 2;
  refuses(choice, {"constant_hardness", "2"});
  // The value stands in the text.
  loam_material_def def = of_law(LOAM_LAW_ELASTIC);
  def.density = -12.5f;
  refuses(def, {"density", "-12.5"});
}

TEST_F(Materials, FieldsOfOtherLawsAreIgnored) {
  loam_material_def def = of_law(LOAM_LAW_ELASTIC);
  def.yield_stress = def.friction_angle = def.cohesion = nan;
  EXPECT_EQ(accepts(def), "LOAM_OK");
  def.hardening_modulus = def.consolidation = def.consistency = def.critical_stretch = nan;
  def.viscosity = def.surface_tension = def.adhesion = def.vorticity_confinement = nan;
  EXPECT_EQ(accepts(def), "LOAM_OK");
  def = of_law(LOAM_LAW_DRUCKER_PRAGER);
  def.yield_stress = -1;
  EXPECT_EQ(accepts(def), "LOAM_OK");
  def = of_law(LOAM_LAW_HERSCHEL_BULKLEY);
  def.yield_stress = def.hardening_factor = nan;
  EXPECT_EQ(accepts(def), "LOAM_OK");
}

/* A host of the first version: its struct ended with the name. */
TEST_F(Materials, TheFirstVersionsStructStillWorks) {
  constexpr std::uint32_t first_size = 64;
  EXPECT_EQ(offsetof(loam_material_def, hardening_modulus), first_size);
  unsigned char memory[sizeof(loam_material_def)];
  std::memset(memory, 0x5A, sizeof memory);
  auto *def = reinterpret_cast<loam_material_def *>(memory);
  for (const std::uint32_t law : {LOAM_LAW_ELASTIC, LOAM_LAW_VON_MISES, LOAM_LAW_DRUCKER_PRAGER}) {
    ASSERT_EQ(loam_material_def_default(law, def, first_size), LOAM_OK);
    loam_material_id id = 0;
    ASSERT_EQ(scenes::outcome(loam_material_create(world(), def, &id)), "LOAM_OK");
    def->density = 777;
    ASSERT_EQ(scenes::outcome(loam_material_set(world(), id, def)), "LOAM_OK");
    ASSERT_EQ(scenes::outcome(loam_material_get(world(), id, def)), "LOAM_OK");
    EXPECT_EQ(def->density, 777);
    EXPECT_EQ(def->struct_size, first_size);
    loam_material_def whole = {};
    whole.struct_size = sizeof whole;
    ASSERT_EQ(loam_material_get(world(), id, &whole), LOAM_OK);
    EXPECT_EQ(whole.hardening_modulus, 0);
  }
  for (std::size_t i = first_size; i < sizeof memory; ++i) EXPECT_EQ(memory[i], 0x5A) << i;
  // One that ended before the fields of fluids.
  constexpr std::uint32_t second_size = 108;
  EXPECT_EQ(offsetof(loam_material_def, viscosity), second_size);
  ASSERT_EQ(loam_material_def_default(LOAM_LAW_FLUID, def, second_size), LOAM_OK);
  loam_material_id water = 0;
  ASSERT_EQ(scenes::outcome(loam_material_create(world(), def, &water)), "LOAM_OK");
  loam_material_def whole = {};
  whole.struct_size = sizeof whole;
  ASSERT_EQ(loam_material_get(world(), water, &whole), LOAM_OK);
  EXPECT_EQ(whole.viscosity, 0);
  // And one before vorticity confinement.
  constexpr std::uint32_t third_size = 120;
  EXPECT_EQ(offsetof(loam_material_def, vorticity_confinement), third_size);
  ASSERT_EQ(loam_material_def_default(LOAM_LAW_FLUID, def, third_size), LOAM_OK);
  def->adhesion = 7;
  ASSERT_EQ(scenes::outcome(loam_material_create(world(), def, &water)), "LOAM_OK");
  ASSERT_EQ(loam_material_get(world(), water, &whole), LOAM_OK);
  EXPECT_EQ(whole.adhesion, 7);
  EXPECT_EQ(whole.vorticity_confinement, 0);
  // It cannot know of a newer law's fields: they are 0, and the text says which is not enough.
  ASSERT_EQ(loam_material_def_default(LOAM_LAW_HERSCHEL_BULKLEY, def, first_size), LOAM_OK);
  refuses(*def, {"consistency", "0"});
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

/* ----------------------------------------------------------------------------------------- changes at run time --- */

class ChangingMaterial : public Materials {
protected:
  loam_material_id of_particles() const { return material_; }
  void SetUp() override {
    const loam_particles_def def = block();
    ASSERT_EQ(loam_particles_add(world(), &def, nullptr), LOAM_OK);
  }
  loam_particles_def block() {
    loam_particles_def def;
    EXPECT_EQ(loam_particles_def_default(&def, sizeof def), LOAM_OK);
    for (int k = 0; k < 27; ++k) {
      const float r = scene_.spacing;
      places_.insert(places_.end(), {1 + r * float(k % 3), 1 + r * float(k / 3 % 3), r * float(k / 9)});
    }
    def.material = material_;
    def.count = 27;
    def.positions = places_.data();
    return def;
  }
  std::vector<float> places_;
};

TEST_F(ChangingMaterial, ANewParameterHoldsFromTheNextStepOn) {
  loam_material_def def = scene_.material, back = {};
  def.friction_angle = 0.1f;
  def.cohesion = 77;
  ASSERT_EQ(scenes::outcome(loam_material_set(world(), of_particles(), &def)), "LOAM_OK");
  back.struct_size = sizeof back;
  ASSERT_EQ(loam_material_get(world(), of_particles(), &back), LOAM_OK);
  EXPECT_EQ(std::memcmp(&def, &back, sizeof def), 0);
  world_.step(1e-3f);
}

/* Two worlds, equal but for a change in one of them: equal until then, different afterwards, equal again without it. */
TEST_F(ChangingMaterial, TheChangeActsAndOnlyIt) {
  const auto run = [&](bool change, float modulus) {
    scenes::World other(definition(scene_));
    const loam_material_id id = other.add(scene_);
    other.step(1e-2f);
    loam_material_def def = scene_.material;
    def.youngs_modulus = modulus;
    if (change) {
      EXPECT_EQ(scenes::outcome(loam_material_set(other.get(), id, &def)), "LOAM_OK");
    }
    other.step(1e-2f);
    return other.state_hash();
  };
  const std::uint64_t unchanged = run(false, 0);
  EXPECT_EQ(run(true, scene_.material.youngs_modulus), unchanged);
  EXPECT_NE(run(true, 0.01f * scene_.material.youngs_modulus), unchanged);
}

TEST_F(ChangingMaterial, LawAndDensityStayWhileThereAreParticles) {
  loam_material_def def = of_law(LOAM_LAW_NACC);
  def.density = scene_.material.density;
  refused(LOAM_ERROR_IN_USE, {"law is 3", "27", "sand"}, [&] { return loam_material_set(world(), of_particles(), &def); });
  def = scene_.material;
  def.density = 1234;
  refused(LOAM_ERROR_IN_USE, {"density is 1234", "27", "1600"},
          [&] { return loam_material_set(world(), of_particles(), &def); });
  def = scene_.material;
  def.poissons_ratio = 0.5f;
  invalid({"poissons_ratio", "0.5", "0.49"}, [&] { return loam_material_set(world(), of_particles(), &def); });
  loam_material_def back = {};
  back.struct_size = sizeof back;
  ASSERT_EQ(loam_material_get(world(), of_particles(), &back), LOAM_OK);
  EXPECT_EQ(back.poissons_ratio, scene_.material.poissons_ratio);
  EXPECT_EQ(back.density, 1600);
  // Without particles, anything goes.
  loam_material_id unused = 0;
  def = of_law(LOAM_LAW_ELASTIC);
  ASSERT_EQ(loam_material_create(world(), &def, &unused), LOAM_OK);
  def = of_law(LOAM_LAW_NACC);
  EXPECT_EQ(scenes::outcome(loam_material_set(world(), unused, &def)), "LOAM_OK");
}

TEST_F(ChangingMaterial, NotWhileBuffersAreMapped) {
  loam_particle_view view = {};
  view.struct_size = sizeof view;
  ASSERT_EQ(loam_particles_map(world(), &view), LOAM_OK);
  EXPECT_EQ(loam_material_set(world(), of_particles(), &scene_.material), LOAM_ERROR_IN_USE);
  test::expect_error_names({"mapped"});
  ASSERT_EQ(loam_particles_unmap(world()), LOAM_OK);
}

/* Hardening turned on is a law with a history, which particles made before it have from then on. */
TEST_F(ChangingMaterial, HardeningCanBeTurnedOnLater) {
  scenes::World metal(definition(scene_));
  loam_material_def def = of_law(LOAM_LAW_VON_MISES);
  loam_material_id id = 0;
  ASSERT_EQ(loam_material_create(metal.get(), &def, &id), LOAM_OK);
  loam_particles_def particles = block();
  particles.material = id;
  ASSERT_EQ(loam_particles_add(metal.get(), &particles, nullptr), LOAM_OK);
  metal.step(1e-3f);
  const std::uint64_t without = metal.memory_bytes();
  def.hardening_modulus = 1e5f;
  ASSERT_EQ(scenes::outcome(loam_material_set(metal.get(), id, &def)), "LOAM_OK");
  metal.step(1e-3f);
  EXPECT_EQ(metal.statistics().non_finite, 0u);
  EXPECT_GT(metal.memory_bytes(), without);
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
    wrong([&] { return loam_material_set(world(), bad, &def); });
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

TEST_F(ChangingMaterial, MeetingsAreCheckedAndActFromTheNextStepOn) {
  const loam_material_def rubber = of_law(LOAM_LAW_ELASTIC);
  loam_material_id other = 0;
  ASSERT_EQ(loam_material_create(world(), &rubber, &other), LOAM_OK);
  const auto meet = [&](loam_material_id a, loam_material_id b, std::uint32_t meeting, float friction) {
    return loam_material_set_meeting(world(), a, b, meeting, friction);
  };
  invalid({"a and b", "same"}, [&] { return meet(other, other, LOAM_MEETING_CONTACT, 0.5f); });
  invalid({"meeting", "2"}, [&] { return meet(other, of_particles(), 2, 0.5f); });
  for (const float friction : {-0.1f, 101.0f, NAN, INFINITY})
    invalid({"friction"}, [&] { return meet(other, of_particles(), LOAM_MEETING_CONTACT, friction); });
  refused(LOAM_ERROR_INVALID_HANDLE, {"a 0x"}, [&] { return meet(0, of_particles(), LOAM_MEETING_CONTACT, 0.5f); });
  refused(LOAM_ERROR_INVALID_HANDLE, {"b 0x"}, [&] { return meet(other, other + 1, LOAM_MEETING_CONTACT, 0.5f); });
  EXPECT_EQ(loam_material_set_meeting(nullptr, other, of_particles(), 0, 0), LOAM_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(meet(other, of_particles(), LOAM_MEETING_CONTACT, 0.5f), LOAM_OK);
  EXPECT_EQ(meet(of_particles(), other, LOAM_MEETING_SHARED, NAN), LOAM_OK); // ignored there
  EXPECT_EQ(meet(other, of_particles(), LOAM_MEETING_CONTACT, 0.5f), LOAM_OK);
  world_.step(1e-3f);
  EXPECT_EQ(loam_material_destroy(world(), other), LOAM_OK); // and the meeting with it
  world_.step(1e-3f);
}

} // namespace
} // namespace loam
