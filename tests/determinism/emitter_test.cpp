/* Streams go on from snapshots, wake what sleeps, and move with the origin. */
#include <gtest/gtest.h>

#include "support/snapshots.h"
#include "support/streams.h"

namespace loam {
namespace {

using streams::disc;
using streams::EmptyWorld;
using streams::instruction_sets;

loam_emitter_def stream(loam_material_id material) {
  loam_emitter_def def = disc(material, 0.03f);
  def.velocity_jitter = 0.1f;
  def.flow = 0.001f;
  return def;
}

/* Saved between two layers, and where a layer has just been dropped in part. */
TEST(SnapshotOfAStream, GoesOnWithTheSameBits) {
  for (const std::uint64_t capacity : {2000u, 60u}) {
    EmptyWorld straight(capacity), other(capacity, 3);
    loam_emitter_def def = stream(straight.material);
    def.when_full = LOAM_FULL_DROP;
    const loam_emitter_id id = straight.add(def);
    for (int frame = 0; frame < 5; ++frame) straight.world.step(0.007f);
    const snapshots::Bytes saved = snapshots::save(straight.world.get());
    const std::uint64_t then = straight.world.state_hash();
    for (int frame = 0; frame < 5; ++frame) straight.world.step(0.007f);
    const std::uint64_t expected = straight.world.state_hash();
    const loam_emitter_report report = straight.report(id);
    EXPECT_NE(then, expected);
    EXPECT_EQ(report.dropped > 0, capacity == 60);

    def.material = other.material;
    const loam_emitter_id same = other.add(def);
    other.world.step(0.01f); // something else to forget
    for (EmptyWorld *world : {&straight, &other}) {
      snapshots::restore(world->world.get(), saved);
      EXPECT_EQ(world->world.state_hash(), then);
      for (int frame = 0; frame < 5; ++frame) world->world.step(0.007f);
      EXPECT_EQ(world->world.state_hash(), expected);
      EXPECT_EQ(world->report(world == &straight ? id : same).entered, report.entered);
      EXPECT_EQ(world->report(world == &straight ? id : same).dropped, report.dropped);
      EXPECT_EQ(world->world.statistics().capacity_needed, straight.world.statistics().capacity_needed);
    }
    // A world whose stream is another is none for it.
    EmptyWorld without(capacity), faster(capacity);
    def.material = faster.material;
    def.speed = 1.01f;
    (void)faster.add(def);
    for (const EmptyWorld *world : {&without, &faster})
      EXPECT_EQ(loam_snapshot_restore(world->world.get(), saved.data(), saved.size()), LOAM_ERROR_SNAPSHOT_MISMATCH)
          << loam_last_error();
  }
}

TEST(Stream, HasTheSameBitsOnEveryInstructionSet) {
  std::uint64_t expected = 0;
  for (const std::uint32_t set : instruction_sets()) {
    EmptyWorld world(2000, 2, LOAM_SOLVER_GAUSS_SEIDEL, set);
    (void)world.add(stream(world.material));
    for (int frame = 0; frame < 5; ++frame) world.world.step(0.01f);
    EXPECT_GT(world.world.statistics().particles, 50u);
    if (expected == 0) expected = world.world.state_hash();
    EXPECT_EQ(world.world.state_hash(), expected) << set;
  }
}

TEST(Stream, MovesWithTheOrigin) {
  const float far[3] = {1024, 0, -2048};
  EmptyWorld here(2000), there(2000);
  (void)here.add(stream(here.material));
  loam_emitter_def def = stream(there.material);
  for (int k = 0; k < 3; ++k) def.position[k] += far[k];
  (void)there.add(def);
  scenes::require(loam_world_shift_origin(there.world.get(), far), "shift");
  for (int frame = 0; frame < 5; ++frame) {
    here.world.step(0.01f);
    there.world.step(0.01f);
  }
  EXPECT_GT(here.world.statistics().particles, 50u);
  EXPECT_EQ(here.world.state_hash(), there.world.state_hash());
}

TEST(Stream, WakesWhatItFallsOn) {
  const scenes::Scene layer = scenes::slab(scenes::sand(), 12, 0.3f, 5);
  loam_world_def world_def = scenes::world_def(layer);
  world_def.particle_capacity = 4000;
  world_def.substeps = 8;
  world_def.sleep_speed = 0.05f;
  world_def.sleep_delay = 0.05f;
  scenes::World world(world_def);
  const loam_material_id sand = world.add(layer);
  for (int frame = 0; frame < 90 && world.statistics().sleeping < layer.count(); ++frame) world.step(1.0f / 60);
  ASSERT_EQ(world.statistics().sleeping, layer.count());
  loam_emitter_def def = disc(sand, 0.02f);
  def.position[0] = 0.06f;
  def.position[1] = 0.15f;
  def.position[2] = 0.025f;
  loam_emitter_id id = 0;
  scenes::require(loam_emitter_create(world.get(), &def, &id), "emitter");
  std::uint64_t least = layer.count();
  for (int frame = 0; frame < 12; ++frame) {
    world.step(1.0f / 60);
    least = std::min(least, world.statistics().sleeping);
  }
  EXPECT_LT(least + 20, layer.count());
  EXPECT_GT(world.statistics().particles, layer.count() + 50);
}

} // namespace
} // namespace loam
