/* particles.h: filling and adding, every field of both definitions; mapping and its rules. */
#include "small_world.h"

namespace loam {
namespace {

using test::infinity;
using test::nan;
using test::SmallWorld;

class Particles : public SmallWorld {
protected:
  loam_fill_def ball() const {
    loam_fill_def def;
    EXPECT_EQ(loam_fill_def_default(&def, sizeof def), LOAM_OK);
    def.material = material_;
    def.region.kind = LOAM_REGION_SPHERE;
    def.region.center[1] = 0.3f;
    def.region.radius = 0.015f;
    return def;
  }
  loam_particles_def two() const {
    static const float places[6] = {0, 0.2f, 0, 0.01f, 0.2f, 0};
    loam_particles_def def;
    EXPECT_EQ(loam_particles_def_default(&def, sizeof def), LOAM_OK);
    def.material = material_;
    def.count = 2;
    def.positions = places;
    return def;
  }
  void refuses(loam_status status, const loam_fill_def &def, const std::vector<std::string> &parts) {
    std::uint64_t count = 12345;
    refused(status, parts, [&] { return loam_particles_fill(world(), &def, &count); });
    EXPECT_EQ(count, 12345u);
  }
  void refuses(loam_status status, const loam_particles_def &def, const std::vector<std::string> &parts) {
    std::uint32_t first = 12345;
    refused(status, parts, [&] { return loam_particles_add(world(), &def, &first); });
    EXPECT_EQ(first, 12345u);
  }
};

TEST_F(Particles, NullArguments) {
  const loam_fill_def fill = ball();
  loam_particles_def add = two();
  invalid({"world is null"}, [&] { return loam_particles_fill(nullptr, &fill, nullptr); });
  invalid({"def is null"}, [&] { return loam_particles_fill(world(), nullptr, nullptr); });
  invalid({"world is null"}, [&] { return loam_particles_add(nullptr, &add, nullptr); });
  invalid({"def is null"}, [&] { return loam_particles_add(world(), nullptr, nullptr); });
  invalid({"world is null"}, [&] { return loam_particles_map(nullptr, nullptr); });
  invalid({"view is null"}, [&] { return loam_particles_map(world(), nullptr); });
  add.positions = nullptr;
  refuses(LOAM_ERROR_INVALID_ARGUMENT, add, {"positions is null"});
}

TEST_F(Particles, UnknownSizes) {
  for (const std::uint32_t size : wrong_sizes(sizeof(loam_fill_def))) {
    loam_fill_def def = ball();
    def.struct_size = size;
    refuses(LOAM_ERROR_INVALID_ARGUMENT, def, {"struct_size", std::to_string(size)});
  }
  for (const std::uint32_t size : wrong_sizes(sizeof(loam_particles_def))) {
    loam_particles_def def = two();
    def.struct_size = size;
    refuses(LOAM_ERROR_INVALID_ARGUMENT, def, {"struct_size", std::to_string(size)});
  }
  for (const std::uint32_t size : wrong_sizes(sizeof(loam_particle_view))) {
    loam_particle_view view = {};
    view.struct_size = size;
    invalid({"view", std::to_string(size)}, [&] { return loam_particles_map(world(), &view); });
    EXPECT_EQ(loam_particles_unmap(world()), LOAM_ERROR_INVALID_ARGUMENT); // nothing was mapped
  }
}

TEST_F(Particles, EveryNumberOfAFillHasItsRange) {
  const auto bad_float = [&](const std::string &name, auto member, std::vector<float> values) {
    values.insert(values.end(), {nan, infinity, -infinity});
    for (const float value : values) {
      loam_fill_def def = ball();
      *member(def) = value;
      refuses(LOAM_ERROR_INVALID_ARGUMENT, def, {name});
    }
  };
  bad_float("spacing", [](loam_fill_def &d) { return &d.spacing; }, {-0.01f, 0.0049f, 1e30f});
  bad_float("inset", [](loam_fill_def &d) { return &d.inset; }, {-1e-3f, 1e30f, 0.02f});
  bad_float("region.radius", [](loam_fill_def &d) { return &d.region.radius; }, {0, -1, 1e30f});
  for (int k = 0; k < 3; ++k) {
    const auto named = [k](std::string field) { return field.append("[").append(std::to_string(k)).append("]"); };
    bad_float(named("velocity"), [k](loam_fill_def &d) { return &d.velocity[k]; }, {1e30f});
    bad_float(named("region.center"), [k](loam_fill_def &d) { return &d.region.center[k]; }, {1e30f});
    bad_float(named("region.half_extents"),
              [k](loam_fill_def &d) {
                d.region.kind = LOAM_REGION_BOX;
                for (float &half : d.region.half_extents) half = 0.01f;
                return &d.region.half_extents[k];
              },
              {0, -1});
    bad_float(named("cut.center"),
              [k](loam_fill_def &d) {
                d.cut = d.region;
                return &d.cut.center[k];
              },
              {});
  }
  for (int k = 0; k < 4; ++k)
    bad_float(std::string("region.rotation[").append(std::to_string(k)).append("]"),
              [k](loam_fill_def &d) { return &d.region.rotation[k]; }, {1e30f});
  bad_float("region.half_height",
            [](loam_fill_def &d) {
              d.region.kind = LOAM_REGION_CYLINDER;
              return &d.region.half_height;
            },
            {0, -1});
  bad_float("jitter",
            [](loam_fill_def &d) {
              d.sampling = LOAM_SAMPLING_LATTICE;
              return &d.jitter;
            },
            {-0.01f, 0.51f});
}

TEST_F(Particles, EveryChoiceOfAFillIsChecked) {
  loam_fill_def def = ball();
  def.sampling = 2;
  refuses(LOAM_ERROR_INVALID_ARGUMENT, def, {"sampling", "2"});
  for (const std::uint32_t kind : {unsigned(LOAM_REGION_NONE), 5u, ~0u}) {
    def = ball();
    def.region.kind = kind;
    refuses(LOAM_ERROR_INVALID_ARGUMENT, def, {"region.kind", std::to_string(kind)});
  }
  def = ball();
  def.cut.kind = 9;
  refuses(LOAM_ERROR_INVALID_ARGUMENT, def, {"cut.kind", "9"});
  def = ball();
  def.reserved = 1;
  refuses(LOAM_ERROR_INVALID_ARGUMENT, def, {"reserved"});
  def = ball();
  def.cut = def.region;
  def.cut.center[0] = 1; // nothing is left
  refuses(LOAM_ERROR_INVALID_ARGUMENT, def, {"region", "cut"});
  def = ball();
  def.region.center[0] = 2e4f; // beyond 1e6 r
  refuses(LOAM_ERROR_INVALID_ARGUMENT, def, {"region"});
}

TEST_F(Particles, MeshRegionsMustClose) {
  const meshes::Mesh sheet = meshes::sheet(0.1f, 2), box = meshes::box(0.012f, 0.012f, 0.012f);
  loam_fill_def def = ball();
  def.region.kind = LOAM_REGION_MESH;
  def.region.mesh = sheet.view();
  refuses(LOAM_ERROR_INVALID_MESH, def, {"region.mesh", "open"});
  def.region.mesh.positions = nullptr;
  refuses(LOAM_ERROR_INVALID_ARGUMENT, def, {"region.mesh.positions"});
  def.region.mesh = box.view();
  std::uint64_t count = 0;
  EXPECT_EQ(scenes::outcome(loam_particles_fill(world(), &def, &count)), "LOAM_OK");
  EXPECT_GT(count, 5u);
}

TEST_F(Particles, EveryNumberOfAnAddHasItsRange) {
  for (const float volume : {-1e-6f, nan, infinity, 1e30f, 1e-30f}) {
    loam_particles_def def = two();
    def.volume = volume;
    refuses(LOAM_ERROR_INVALID_ARGUMENT, def, {"volume"});
  }
  for (const float bad : {nan, infinity, -infinity, 1.01e4f, -1e30f}) {
    const float places[6] = {0, 0.2f, 0, 0.01f, bad, 0};
    loam_particles_def def = two();
    def.positions = places;
    refuses(LOAM_ERROR_INVALID_ARGUMENT, def, {"positions[1].y"});
  }
  for (const float bad : {nan, infinity, -infinity, 1e30f}) {
    const float speeds[6] = {0, 0, bad, 0, 0, 0};
    loam_particles_def def = two();
    def.velocities = speeds;
    refuses(LOAM_ERROR_INVALID_ARGUMENT, def, {"velocities[0].z"});
  }
  loam_particles_def def = two();
  def.pinned = 2;
  refuses(LOAM_ERROR_INVALID_ARGUMENT, def, {"pinned", "2"});
  def = two();
  def.reserved = 1;
  refuses(LOAM_ERROR_INVALID_ARGUMENT, def, {"reserved"});
}

TEST_F(Particles, AddGivesIdsInTheOrderOfCreation) {
  loam_particles_def def = two();
  std::uint32_t first = 0;
  ASSERT_EQ(loam_particles_add(world(), &def, &first), LOAM_OK);
  EXPECT_EQ(first, 64u);
  def.count = 0;
  def.positions = nullptr;
  EXPECT_EQ(loam_particles_add(world(), &def, &first), LOAM_OK); // none is allowed
  EXPECT_EQ(first, 66u);
  std::uint64_t count = 0;
  EXPECT_EQ(loam_particles_count(world(), &count), LOAM_OK);
  EXPECT_EQ(count, 66u);
  const scenes::Snapshot now = world_.snapshot();
  EXPECT_EQ(now.positions[3 * 65], 0.01f);
  EXPECT_FLOAT_EQ(now.volumes[65], 1e-6f); // r^3
  EXPECT_FLOAT_EQ(now.inverse_masses[65], 1 / (1600 * 1e-6f));
}

TEST_F(Particles, PinnedOnesKeepTheirVelocity) {
  const float speeds[6] = {1, 0, 0, 1, 0, 0};
  loam_particles_def def = two();
  def.velocities = speeds;
  def.pinned = 1;
  ASSERT_EQ(loam_particles_add(world(), &def, nullptr), LOAM_OK);
  world_.step(0.01f);
  const scenes::Snapshot now = world_.snapshot();
  EXPECT_EQ(now.velocities[3 * 64], 1.0f);
  EXPECT_EQ(now.velocities[3 * 64 + 1], 0.0f);
  EXPECT_NEAR(now.positions[3 * 64], 0.01f, 1e-6);
  EXPECT_EQ(now.inverse_masses[64], 0.0f);
}

TEST_F(Particles, FillingTakesTheRegionsMass) {
  for (const std::uint32_t sampling : {LOAM_SAMPLING_POISSON_DISK, LOAM_SAMPLING_LATTICE}) {
    loam_fill_def def = ball();
    def.sampling = sampling;
    def.velocity[2] = 3;
    loam_world_def world_def = definition(scene_);
    const scenes::World fresh(world_def);
    ASSERT_EQ(loam_material_create(fresh.get(), &scene_.material, &def.material), LOAM_OK);
    std::uint64_t count = 0;
    ASSERT_EQ(scenes::outcome(loam_particles_fill(fresh.get(), &def, &count)), "LOAM_OK");
    const scenes::Snapshot now = fresh.snapshot();
    ASSERT_EQ(now.count(), count);
    double mass = 0;
    for (std::size_t i = 0; i < count; ++i) {
      mass += 1 / double(now.inverse_masses[i]);
      EXPECT_EQ(now.velocities[3 * i + 2], 3.0f);
      const float *x = &now.positions[3 * i];
      EXPECT_LT(std::hypot(x[0], x[1] - 0.3f, x[2]), 0.0151f);
    }
    EXPECT_NEAR(mass, 1600 * 4.0 / 3 * 3.14159265 * std::pow(0.015, 3), 1e-3 * mass);
  }
}

} // namespace
} // namespace loam
