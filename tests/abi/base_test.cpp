/* Status names, the last error, the version, and the log. */
#include <set>
#include <thread>

#include "small_world.h"
#include "support/hooks.h"

namespace loam {
namespace {

using test::SmallWorld;

TEST(Base, EveryStatusHasItsName) {
  const char *names[] = {"LOAM_OK",
                         "LOAM_ERROR_INVALID_ARGUMENT",
                         "LOAM_ERROR_INVALID_HANDLE",
                         "LOAM_ERROR_OUT_OF_MEMORY",
                         "LOAM_ERROR_CAPACITY",
                         "LOAM_ERROR_BACKEND_UNAVAILABLE",
                         "LOAM_ERROR_IN_USE",
                         "LOAM_ERROR_INVALID_MESH",
                         "LOAM_ERROR_DEVICE",
                         "LOAM_ERROR_INTERNAL",
                         "LOAM_ERROR_INVALID_SNAPSHOT",
                         "LOAM_ERROR_SNAPSHOT_MISMATCH",
                         "LOAM_ERROR_BUSY",
                         "LOAM_ERROR_NOT_BUILT",
                         "LOAM_ERROR_BUDGET"};
  for (loam_status status = 0; status < loam_status(std::size(names)); ++status)
    EXPECT_STREQ(loam_status_name(status), names[status]);
  for (const loam_status unknown : {-1, loam_status(std::size(names)), 1000, INT32_MIN, INT32_MAX})
    EXPECT_STREQ(loam_status_name(unknown), "LOAM_ERROR_UNKNOWN");
}

TEST(Base, TheVersionIsThatOfTheHeader) {
  std::uint32_t major = 99, minor = 99, patch = 99;
  EXPECT_EQ(loam_version(&major, &minor, &patch), LOAM_OK);
  EXPECT_EQ(major, unsigned(LOAM_VERSION_MAJOR));
  EXPECT_EQ(minor, unsigned(LOAM_VERSION_MINOR));
  EXPECT_EQ(patch, unsigned(LOAM_VERSION_PATCH));
  EXPECT_EQ(loam_version(nullptr, nullptr, nullptr), LOAM_OK);
}

TEST(Base, TheLastErrorIsEmptyAfterASuccess) {
  EXPECT_EQ(loam_world_step(nullptr, 0.01f), LOAM_ERROR_INVALID_ARGUMENT);
  EXPECT_STRNE(loam_last_error(), "");
  EXPECT_EQ(loam_version(nullptr, nullptr, nullptr), LOAM_OK);
  EXPECT_STREQ(loam_last_error(), "");
}

TEST(Base, TheLastErrorBelongsToItsThread) {
  EXPECT_EQ(loam_world_step(nullptr, 0.01f), LOAM_ERROR_INVALID_ARGUMENT);
  const std::string mine = loam_last_error();
  std::string theirs_before, theirs_after;
  std::thread([&] {
    theirs_before = loam_last_error();
    loam_fill_def_default(nullptr, 0);
    theirs_after = loam_last_error();
  }).join();
  EXPECT_EQ(theirs_before, "");
  EXPECT_NE(theirs_after.find("def"), std::string::npos);
  EXPECT_EQ(loam_last_error(), mine);
}

TEST(Base, TheLogReceivesEachErrorOfItsWorld) {
  hooks::Log log;
  loam_world_def def;
  ASSERT_EQ(loam_world_def_default(&def, sizeof def), LOAM_OK);
  def.backend = LOAM_BACKEND_CPU;
  def.particle_capacity = 1;
  def.log = log.hooks();
  const scenes::World world(def);
  EXPECT_EQ(loam_world_step(world.get(), -1), LOAM_ERROR_INVALID_ARGUMENT);
  ASSERT_EQ(log.lines.size(), 1u);
  EXPECT_EQ(log.lines[0].level, LOAM_LOG_ERROR);
  EXPECT_EQ(log.lines[0].text, loam_last_error());
  EXPECT_EQ(log.lines[0].text.find('\n'), std::string::npos);
  EXPECT_EQ(loam_world_step(world.get(), 0.01f), LOAM_OK);
  EXPECT_EQ(log.lines.size(), 1u);
}

/* The defaults are documented field by field in the headers. */
TEST(Base, DefaultsAreThoseOfTheHeaders) {
  loam_world_def world;
  ASSERT_EQ(loam_world_def_default(&world, sizeof world), LOAM_OK);
  EXPECT_EQ(world.struct_size, sizeof world);
  EXPECT_EQ(world.backend, unsigned(LOAM_BACKEND_AUTO));
  EXPECT_EQ(world.gravity[1], -9.81f);
  EXPECT_EQ(world.kernel_radius, 0.01f);
  EXPECT_EQ(world.substeps, 16u);
  EXPECT_EQ(world.iterations, 5u);
  EXPECT_EQ(world.velocity_smoothing, 20.0f);
  EXPECT_EQ(world.minimum_distance, 0.75f);
  EXPECT_EQ(world.gradient_cutoff, 0.2f);
  EXPECT_EQ(world.particle_capacity, 65536u);
  EXPECT_EQ(world.pair_capacity, 0u);

  loam_material_def material;
  ASSERT_EQ(loam_material_def_default(LOAM_LAW_DRUCKER_PRAGER, &material, sizeof material), LOAM_OK);
  EXPECT_EQ(material.density, 1600.0f);
  EXPECT_EQ(material.youngs_modulus, 1e6f);
  EXPECT_NEAR(material.friction_angle, 0.5235988f, 1e-7);
  EXPECT_EQ(material.cohesion, 0.0f);
  ASSERT_EQ(loam_material_def_default(LOAM_LAW_VON_MISES, &material, sizeof material), LOAM_OK);
  EXPECT_EQ(material.yield_stress, 5000.0f);
  EXPECT_EQ(material.density, 1500.0f);
  ASSERT_EQ(loam_material_def_default(LOAM_LAW_ELASTIC, &material, sizeof material), LOAM_OK);
  EXPECT_EQ(material.youngs_modulus, 1e5f);
  ASSERT_EQ(loam_material_def_default(LOAM_LAW_NACC, &material, sizeof material), LOAM_OK);
  EXPECT_STREQ(material.name, "packed snow");
  EXPECT_EQ(material.law, unsigned(LOAM_LAW_NACC));
  ASSERT_EQ(loam_material_def_default(LOAM_LAW_HERSCHEL_BULKLEY, &material, sizeof material), LOAM_OK);
  EXPECT_STREQ(material.name, "shaving foam");
  EXPECT_EQ(material.law, unsigned(LOAM_LAW_HERSCHEL_BULKLEY));
  ASSERT_EQ(loam_material_def_default(LOAM_LAW_STOMAKHIN_SNOW, &material, sizeof material), LOAM_OK);
  EXPECT_EQ(material.critical_compression, 0.025f);
  EXPECT_EQ(material.critical_stretch, 0.0075f);
  EXPECT_EQ(material.hardening_factor, 10.0f);

  loam_collider_def collider;
  ASSERT_EQ(loam_collider_def_default(&collider, sizeof collider), LOAM_OK);
  EXPECT_EQ(collider.kind, unsigned(LOAM_COLLIDER_PLANE));
  EXPECT_EQ(collider.rotation[3], 1.0f);
  EXPECT_EQ(collider.friction, 0.6f);

  loam_fill_def fill;
  ASSERT_EQ(loam_fill_def_default(&fill, sizeof fill), LOAM_OK);
  EXPECT_EQ(fill.sampling, unsigned(LOAM_SAMPLING_POISSON_DISK));
  EXPECT_EQ(fill.cut.kind, unsigned(LOAM_REGION_NONE));
  EXPECT_EQ(fill.jitter, 0.12f);
  EXPECT_EQ(fill.seed, 1u);
}

TEST(Base, DefaultFunctionsRefuseNullAndUnknownSizesAndWriteNothing) {
  const auto check = [](auto def, auto &&call) {
    EXPECT_EQ(call(nullptr, sizeof def), LOAM_ERROR_INVALID_ARGUMENT);
    test::expect_error_names({"def is null"});
    for (const std::size_t size : {std::size_t(0), std::size_t(4), sizeof def - 1, sizeof def + 1, ~std::size_t(0)}) {
      std::memset(static_cast<void *>(&def), 0x5A, sizeof def);
      EXPECT_EQ(call(&def, size), LOAM_ERROR_INVALID_ARGUMENT) << size;
      test::expect_error_names({"def", std::to_string(size)});
      const auto *bytes = reinterpret_cast<const unsigned char *>(&def);
      EXPECT_TRUE(std::all_of(bytes, bytes + sizeof def, [](unsigned char byte) { return byte == 0x5A; }));
    }
  };
  check(loam_world_def{}, loam_world_def_default);
  check(loam_collider_def{}, loam_collider_def_default);
  check(loam_fill_def{}, loam_fill_def_default);
  check(loam_particles_def{}, loam_particles_def_default);
  check(loam_material_def{},
        [](loam_material_def *def, std::size_t size) { return loam_material_def_default(LOAM_LAW_ELASTIC, def, size); });
  loam_material_def def;
  for (const std::uint32_t law : {7u, 0xffffffffu}) {
    EXPECT_EQ(loam_material_def_default(law, &def, sizeof def), LOAM_ERROR_INVALID_ARGUMENT);
    test::expect_error_names({"law", std::to_string(law)});
  }
}

} // namespace
} // namespace loam
