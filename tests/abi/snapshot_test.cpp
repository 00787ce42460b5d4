/* Snapshots: their size, what is refused by name, and that a refused one changes nothing. */
#include "small_world.h"
#include "support/hooks.h"
#include "support/snapshots.h"

namespace loam {
namespace {

using snapshots::Bytes;
using test::SmallWorld;

TEST_F(SmallWorld, ASnapshotHasTheSizeThatItSays) {
  std::uint64_t size = 0, written = 0;
  ASSERT_EQ(loam_snapshot_size(world(), &size), LOAM_OK);
  Bytes bytes(size + 64, std::byte{0xAA});
  ASSERT_EQ(loam_snapshot_save(world(), bytes.data() + 1, size, &written), LOAM_OK); /* of any alignment */
  EXPECT_EQ(written, size);
  EXPECT_EQ(bytes[0], std::byte{0xAA});
  EXPECT_EQ(bytes[size + 1], std::byte{0xAA});
  ASSERT_EQ(loam_snapshot_save(world(), bytes.data(), bytes.size(), nullptr), LOAM_OK);
  bytes.resize(size);
  EXPECT_EQ(loam_snapshot_restore(world(), bytes.data(), size), LOAM_OK);
}

TEST_F(SmallWorld, ASnapshotTakesFewBytes) {
  /* Sand; and sand's drifts where it shares a world with matter that has some. Beside the description, which does not grow. */
  for (const auto &[rubber, warm] : {std::pair(false, 0u), std::pair(true, 0u), std::pair(false, 1u), std::pair(true, 1u)})
    for (const std::uint32_t multiplier : {LOAM_MULTIPLIER_SCALAR, LOAM_MULTIPLIER_PROJECTED_TENSOR}) {
      const scenes::Scene scene = scenes::jittered_block(scenes::sand(), 4096);
      loam_world_def def = scenes::world_def(scene);
      def.multiplier = multiplier;
      def.warm_start = warm;
      scenes::World sand(def, scene);
      const loam_material_def soft = scenes::rubber();
      loam_material_id id = 0;
      if (rubber) scenes::require(loam_material_create(sand.get(), &soft, &id), "material");
      sand.step(1e-3f);
      const double bytes = double(snapshots::save(sand.get()).size()) / double(scene.count());
      const bool tensor = multiplier == LOAM_MULTIPLIER_PROJECTED_TENSOR;
      const double least = 60 + (rubber && tensor ? 12 + 12 * warm : 0) + (tensor ? 24 * warm : 0);
      EXPECT_GE(bytes, least);
      EXPECT_LE(bytes, least + 0.3);
    }
}

TEST_F(SmallWorld, SnapshotsRefuseNullAndTooLittleRoom) {
  std::uint64_t size = 0;
  const Bytes saved = snapshots::save(world());
  Bytes bytes(saved.size() - 1, std::byte{0xAA});
  invalid({"bytes", "null"}, [&] { return loam_snapshot_size(world(), nullptr); });
  invalid({"world", "null"}, [&] { return loam_snapshot_size(nullptr, &size); });
  invalid({"world", "null"}, [&] { return loam_snapshot_save(nullptr, bytes.data(), bytes.size(), nullptr); });
  invalid({"memory", "null"}, [&] { return loam_snapshot_save(world(), nullptr, 1 << 20, nullptr); });
  invalid({"world", "null"}, [&] { return loam_snapshot_restore(nullptr, saved.data(), saved.size()); });
  invalid({"memory", "null"}, [&] { return loam_snapshot_restore(world(), nullptr, saved.size()); });
  for (const std::uint64_t room : {std::uint64_t(0), std::uint64_t(7), saved.size() - 1}) {
    refused(LOAM_ERROR_CAPACITY, {"capacity", std::to_string(saved.size())},
            [&] { return loam_snapshot_save(world(), bytes.data(), room, &size); });
    EXPECT_EQ(bytes, Bytes(saved.size() - 1, std::byte{0xAA}));
  }
}

TEST_F(SmallWorld, WhatIsNoSnapshotIsRefused) {
  const Bytes saved = snapshots::save(world());
  const auto broken = [&](const std::vector<std::string> &parts, const Bytes &bytes) {
    refused(LOAM_ERROR_INVALID_SNAPSHOT, parts, [&] { return loam_snapshot_restore(world(), bytes.data(), bytes.size()); });
  };
  Bytes none(1), other = saved, newer = saved, swapped = saved, longer = saved, shorter = saved, flipped = saved;
  other[0] = std::byte{'l'};
  newer[8] = std::byte{8};
  std::reverse(swapped.begin() + 12, swapped.begin() + 16);
  longer.push_back(std::byte{0});
  shorter.pop_back();
  flipped[saved.size() / 2] ^= std::byte{1};
  broken({"header"}, none);
  broken({"LOAMSNAP"}, other);
  broken({"version 8", "version 7"}, newer);
  broken({"byte order"}, swapped);
  broken({std::to_string(saved.size()), std::to_string(saved.size() + 1)}, longer);
  broken({std::to_string(saved.size()), std::to_string(saved.size() - 1)}, shorter);
  broken({"damaged", "checksum"}, flipped);
  EXPECT_EQ(loam_snapshot_restore(world(), saved.data(), saved.size()), LOAM_OK);
}

/* Each field that must fit, one at a time, by its name. */
TEST_F(SmallWorld, AForeignSnapshotIsRefusedByTheFieldThatDiffers) {
  const auto mismatch = [&](const std::string &field, const loam_world *other) {
    SCOPED_TRACE(field);
    const Bytes bytes = snapshots::save(other);
    refused(LOAM_ERROR_SNAPSHOT_MISMATCH, {field, "in the world", "in the snapshot"},
            [&] { return loam_snapshot_restore(world(), bytes.data(), bytes.size()); });
  };
  /* The fixture's world, with changes. */
  const auto make = [&](auto &&change) {
    loam_world_def def = definition(scene_);
    scenes::Scene scene = scene_;
    loam_material_def second = scene.material;
    loam_collider_def collider;
    EXPECT_EQ(loam_collider_def_default(&collider, sizeof collider), LOAM_OK);
    meshes::Mesh box = meshes::box(0.5f, 0.5f, 0.5f);
    collider.kind = LOAM_COLLIDER_MESH;
    change(def, scene, second, collider, box);
    collider.mesh = box.view();
    scenes::World world(def, scene);
    loam_material_id material = 0;
    loam_collider_id id = 0;
    EXPECT_EQ(loam_material_create(world.get(), &second, &material), LOAM_OK);
    EXPECT_EQ(loam_collider_create(world.get(), &collider, &id), LOAM_OK);
    return world;
  };
  const auto same = make([](auto &...) {});
  const Bytes fits = snapshots::save(same.get());
  const Bytes before = snapshots::save(world());
  EXPECT_EQ(loam_snapshot_restore(world(), fits.data(), fits.size()), LOAM_OK) << loam_last_error();
  EXPECT_EQ(world_.state_hash(), same.state_hash());
  snapshots::restore(world(), before);

  const auto of_world = [&](const char *field, auto &&change) {
    mismatch(field, make([&](loam_world_def &def, auto &...) { change(def); }).get());
  };
  of_world("kernel_radius", [](auto &def) { def.kernel_radius *= 2; });
  of_world("solver", [](auto &def) { def.solver = LOAM_SOLVER_JACOBI; });
  of_world("plasticity", [](auto &def) { def.plasticity = LOAM_PLASTICITY_SEMI_IMPLICIT; });
  of_world("velocity_smoothing", [](auto &def) { def.velocity_smoothing = 0; });
  of_world("minimum_distance", [](auto &def) { def.minimum_distance = 0; });
  of_world("gradient_cutoff", [](auto &def) { def.gradient_cutoff = 0.3f; });
  of_world("particle_capacity", [](auto &def) { def.particle_capacity += 1; });
  of_world("multiplier", [](auto &def) { def.multiplier = LOAM_MULTIPLIER_SCALAR; });
  of_world("zero_energy_stiffness", [](auto &def) { def.zero_energy_stiffness = 1; });
  of_world("warm_start", [](auto &def) { def.warm_start = 1; });
  const auto of_material = [&](const char *field, auto &&change) {
    mismatch(std::string("material 1: ") + field,
             make([&](auto &, auto &, loam_material_def &second, auto &...) { change(second); }).get());
  };
  of_material("law", [](auto &def) { def.law = LOAM_LAW_ELASTIC; });
  of_material("density", [](auto &def) { def.density = 999; });
  of_material("youngs_modulus", [](auto &def) { def.youngs_modulus *= 2; });
  of_material("friction_angle", [](auto &def) { def.friction_angle = 0.1f; });
  const auto of_collider = [&](const char *field, auto &&change) {
    mismatch(std::string("collider 1: ") + field,
             make([&](auto &, auto &, auto &, loam_collider_def &def, meshes::Mesh &mesh) { change(def, mesh); }).get());
  };
  of_collider("kind", [](auto &def, auto &) { def.kind = LOAM_COLLIDER_HULL; });
  of_collider("friction", [](auto &def, auto &) { def.friction = 0.1f; });
  of_collider("fingerprint of the mesh", [](auto &, auto &mesh) { mesh = meshes::box(0.5f, 0.5f, 0.6f); });
  {
    auto more = make([](auto &...) {});
    loam_collider_def plane;
    loam_collider_id id = 0;
    loam_material_id material = 0;
    ASSERT_EQ(loam_collider_def_default(&plane, sizeof plane), LOAM_OK);
    ASSERT_EQ(loam_collider_create(more.get(), &plane, &id), LOAM_OK);
    mismatch("number of colliders", more.get());
    ASSERT_EQ(loam_material_create(more.get(), &scene_.material, &material), LOAM_OK);
    mismatch("number of materials", more.get());
    ASSERT_EQ(loam_collider_destroy(more.get(), id), LOAM_OK);
    ASSERT_EQ(loam_material_destroy(more.get(), material), LOAM_OK);
    const Bytes bytes = snapshots::save(more.get()); /* what is gone does not count */
    EXPECT_EQ(loam_snapshot_restore(world(), bytes.data(), bytes.size()), LOAM_OK) << loam_last_error();
  }
}

TEST_F(SmallWorld, ASnapshotIsSavedButNotRestoredWhileBuffersAreMapped) {
  loam_particle_view view = {};
  view.struct_size = sizeof view;
  ASSERT_EQ(loam_particles_map(world(), &view), LOAM_OK);
  const Bytes saved = snapshots::save(world());
  refused(LOAM_ERROR_IN_USE, {"map"}, [&] { return loam_snapshot_restore(world(), saved.data(), saved.size()); });
  ASSERT_EQ(loam_particles_unmap(world()), LOAM_OK);
  EXPECT_EQ(loam_snapshot_restore(world(), saved.data(), saved.size()), LOAM_OK);
}

TEST_F(SmallWorld, AnEmptyWorldHasASnapshotToo) {
  const scenes::World empty(definition(scene_)), other(definition(scene_));
  const Bytes saved = snapshots::save(empty.get());
  EXPECT_EQ(loam_snapshot_restore(other.get(), saved.data(), saved.size()), LOAM_OK);
  EXPECT_EQ(other.state_hash(), empty.state_hash());
  EXPECT_EQ(loam_world_step(other.get(), 0.01f), LOAM_OK);
}

/* Saving and restoring over and over asks the allocator for nothing; steps in between neither. */
TEST_F(SmallWorld, SnapshotsTakeNoMemory) {
  hooks::Allocator allocator;
  loam_world_def def = definition(scene_);
  def.allocator = allocator.hooks();
  {
    scenes::World other(def, scene_);
    other.step(1e-3f);
    const Bytes saved = snapshots::save(other.get());
    const std::uint64_t requests = allocator.requests;
    for (int k = 0; k < 10; ++k) {
      snapshots::restore(other.get(), saved);
      other.step(1e-3f);
      EXPECT_GT(snapshots::save(other.get()).size(), 0u);
    }
    EXPECT_EQ(allocator.requests, requests);
  }
  EXPECT_EQ(allocator.blocks_in_use(), 0u);
}

} // namespace
} // namespace loam
