/* Sleep: what rests is held at no cost, stays where it was to within the bound, and wakes when something reaches it. */
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <string>

#include "support/meshes.h"
#include "support/scenes.h"

namespace loam {
namespace {

constexpr float step_seconds = 1.0f / 120;
constexpr float sleep_speed = 5e-3f; // half of r a second

loam_world_def definition(const scenes::Scene &scene, bool sleep = true) {
  loam_world_def def = scenes::world_def(scene);
  def.particle_capacity = scene.count() + 1000;
  def.substeps = 8;
  def.sleep_speed = sleep ? sleep_speed : 0;
  def.sleep_delay = 0.2f;
  return def;
}

/* A layer of sand on the ground, 60 spacings long. */
scenes::Scene layer() { return scenes::slab(scenes::sand(), 60, 0.08f, 5); }

/* Steps until all particles sleep; the number of steps, or 0 if they never do. */
int fall_asleep(scenes::World &world) {
  for (int step = 1; step <= 480; ++step) {
    world.step(step_seconds);
    const loam_statistics now = world.statistics();
    if (now.sleeping == now.particles) return step;
  }
  return 0;
}

struct Sleeping : testing::Test {
  scenes::Scene scene = layer();
  scenes::World world{definition(scene)};
  loam_material_id material = world.add(scene);

  void SetUp() override { ASSERT_GT(fall_asleep(world), 0); }
  std::uint64_t awake_after_a_step() {
    world.step(step_seconds);
    return world.statistics().particles - world.statistics().sleeping;
  }
};

TEST_F(Sleeping, CostsNoVisitAndChangesNothing) {
  const std::uint64_t hash = world.state_hash();
  for (int step = 0; step < 20; ++step) world.step(step_seconds);
  EXPECT_EQ(world.state_hash(), hash);
  EXPECT_EQ(world.statistics().pair_visits, 0u);
  EXPECT_EQ(world.statistics().max_speed, 0);
  EXPECT_EQ(world.statistics().substeps_done, 8u);
}

TEST(Sleep, StopsOnlyWhatCreeps) {
  const scenes::Scene scene = layer();
  scenes::World sleepy(definition(scene), scene), awake(definition(scene, false), scene);
  const int steps = fall_asleep(sleepy);
  ASSERT_GT(steps, 0);
  for (int step = 0; step < steps; ++step) awake.step(step_seconds);
  EXPECT_EQ(awake.statistics().sleeping, 0u);
  const auto a = sleepy.snapshot(), b = awake.snapshot();
  double farthest = 0, sum = 0;
  for (std::size_t i = 0; i < a.positions.size(); i += 3) {
    const double d = std::hypot(double(a.positions[i] - b.positions[i]), double(a.positions[i + 1] - b.positions[i + 1]),
                                double(a.positions[i + 2] - b.positions[i + 2]));
    farthest = std::max(farthest, d);
    sum += d;
  }
  // The bound: both at the speed for all of the time, in opposite directions.
  EXPECT_LT(farthest, 2 * double(sleep_speed) * steps * double(step_seconds));
  EXPECT_LT(sum / double(a.count()), 0.02 * double(scene.spacing));
}

TEST_F(Sleeping, WakesWhereItIsHitWithinAStepAndNowhereElse) {
  scenes::Scene stone = scenes::drop_block(scenes::sand(), 3, 0);
  stone.planes.clear();
  const float at[3] = {0.1f, 0.055f, 0.02f}; // a hair above the layer
  for (std::size_t i = 0; i < stone.positions.size(); ++i) stone.positions[i] += at[i % 3];
  stone.velocities.resize(stone.positions.size());
  for (std::size_t i = 1; i < stone.velocities.size(); i += 3) stone.velocities[i] = -3;
  loam_particles_def def;
  scenes::require(loam_particles_def_default(&def, sizeof def), "default");
  def.material = material;
  def.count = stone.count();
  def.positions = stone.positions.data();
  def.velocities = stone.velocities.data();
  def.volume = stone.volume();
  const auto before = world.snapshot();
  std::uint32_t first = 0;
  ASSERT_EQ(scenes::outcome(loam_particles_add(world.get(), &def, &first)), "LOAM_OK");
  EXPECT_GT(awake_after_a_step(), stone.count() + 20); // 3 m/s is 25 mm a step
  for (int step = 0; step < 20; ++step) world.step(step_seconds);
  const auto after = world.snapshot();
  double near = 0, far = 0;
  for (std::size_t i = 0; i < before.count(); ++i) {
    double moved = 0;
    for (std::size_t k = 0; k < 3; ++k)
      moved = std::max(moved, std::abs(double(after.positions[3 * i + k] - before.positions[3 * i + k])));
    double &most = std::abs(before.positions[3 * i] - at[0]) < 0.05f ? near : far;
    if (before.positions[3 * i] > 0.4f || &most == &near) most = std::max(most, moved);
  }
  EXPECT_GT(near, 0.5 * double(scene.spacing));
  EXPECT_EQ(far, 0); // three tenths of a metre away nobody woke
  EXPECT_GT(fall_asleep(world), 0);
}

TEST_F(Sleeping, WakesWhenTheHostChangesSomething) {
  const auto all = scene.count();
  const float sideways[3] = {1, -9.8f, 0};
  ASSERT_EQ(loam_world_set_gravity(world.get(), sideways), LOAM_OK);
  EXPECT_GT(awake_after_a_step(), all * 9 / 10);
  const float down[3] = {0, -9.81f, 0};
  ASSERT_EQ(loam_world_set_gravity(world.get(), down), LOAM_OK);
  ASSERT_GT(fall_asleep(world), 0);

  loam_material_def def = scene.material;
  def.friction_angle = 0.3f;
  ASSERT_EQ(scenes::outcome(loam_material_set(world.get(), material, &def)), "LOAM_OK");
  EXPECT_GT(awake_after_a_step(), all * 9 / 10);
  ASSERT_GT(fall_asleep(world), 0);

  ASSERT_EQ(loam_world_wake(world.get()), LOAM_OK);
  EXPECT_GT(awake_after_a_step(), all * 9 / 10);
}

TEST_F(Sleeping, WakesNearAColliderThatMoves) {
  const meshes::Mesh ball = meshes::icosphere(0.02f, 2);
  loam_collider_def def;
  scenes::require(loam_collider_def_default(&def, sizeof def), "default");
  def.kind = LOAM_COLLIDER_MESH;
  def.mesh = ball.view();
  const float high[3] = {0.1f, 0.5f, 0.02f}, turn[4] = {0, 0, 0, 1};
  std::copy(high, high + 3, def.position);
  loam_collider_id id = 0;
  ASSERT_EQ(scenes::outcome(loam_collider_create(world.get(), &def, &id)), "LOAM_OK");
  EXPECT_GT(awake_after_a_step(), 0u); // a new collider may be anywhere
  ASSERT_GT(fall_asleep(world), 0);
  const float less_high[3] = {0.1f, 0.3f, 0.02f}, inside[3] = {0.1f, 0.05f, 0.02f};
  ASSERT_EQ(loam_collider_move(world.get(), id, less_high, turn), LOAM_OK);
  EXPECT_EQ(awake_after_a_step(), 0u);
  ASSERT_EQ(loam_collider_move(world.get(), id, inside, turn), LOAM_OK);
  const std::uint64_t awake = awake_after_a_step();
  EXPECT_GT(awake, 20u);
  EXPECT_LT(awake, scene.count() / 2);
}

TEST(Sleep, TakesNothingWhereItIsOff) {
  const scenes::Scene scene = layer();
  scenes::World without(definition(scene, false), scene), with(definition(scene), scene);
  without.step(step_seconds);
  with.step(step_seconds);
  const auto has_stage = [](const scenes::World &world) {
    const auto stages = world.stages();
    return std::any_of(stages.begin(), stages.end(), [](const loam_stage &s) { return std::string(s.name) == "sleep"; });
  };
  EXPECT_FALSE(has_stage(without));
  EXPECT_TRUE(has_stage(with));
  EXPECT_LT(without.memory_bytes() + 8 * scene.count(), with.memory_bytes()); // two copies of a float a particle, and cells
}

} // namespace
} // namespace loam
