/* What a collider is told of the momentum that matter lost to it: a closed balance without gravity, for every kind, at rest and moving. */
#include <cmath>
#include <gtest/gtest.h>

#include "support/cloths.h"
#include "support/scenes.h"
#include "support/solids.h"

namespace loam {
namespace {

using Vector = std::array<double, 3>;

struct Balance {
  Vector lost{}, lost_moment{}, impulse{}, torque{}; // moments about the world's origin
  std::uint64_t most_contacts = 0;
  std::vector<double> all; // every figure of every step
};

double size(const Vector &v) { return std::hypot(v[0], v[1], v[2]); }
double apart(const Vector &a, const Vector &b) { return size({a[0] - b[0], a[1] - b[1], a[2] - b[2]}); }

void add_momentum(const scenes::World &world, double sign, Vector &momentum, Vector &moment) {
  const scenes::Snapshot now = world.snapshot();
  for (std::size_t i = 0; i < now.count(); ++i) {
    const double mass = sign / double(now.inverse_masses[i]);
    const float *x = &now.positions[3 * i], *v = &now.velocities[3 * i];
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t a = (k + 1) % 3, b = (k + 2) % 3;
      momentum[k] += mass * double(v[k]);
      moment[k] += mass * (double(x[a]) * double(v[b]) - double(x[b]) * double(v[a]));
    }
  }
}

loam_collider_reaction reaction_of(const scenes::World &world, loam_collider_id id) {
  loam_collider_reaction reaction = {};
  reaction.struct_size = sizeof reaction;
  scenes::require(loam_collider_get_reaction(world.get(), id, &reaction), "loam_collider_get_reaction");
  return reaction;
}

/* Sand falls from all of the upper side at 2 m/s; `spacing` in kernel radii: from 3 on it does not act on itself. */
Balance run(const solids::Solid &solid, bool moving, float spacing, std::uint32_t threads = 1) {
  scenes::Scene sand = scenes::drop_block(scenes::sand(), 5, 0, 2);
  sand.planes.clear();
  for (std::size_t i = 0; i < sand.positions.size(); i += 3) {
    sand.positions[i] *= spacing / 2;
    sand.positions[i + 1] = 0.12f + spacing * sand.positions[i + 1];
    sand.positions[i + 2] *= spacing / 2;
  }
  loam_world_def def = scenes::world_def(sand);
  def.gravity[1] = 0;
  def.thread_count = threads;
  scenes::World world(def, sand);
  loam_collider_def collider = solid.definition();
  collider.reaction = 1;
  collider.restitution = 0.3f;
  collider.position[1] = 0.03f;
  loam_collider_id id = 0;
  scenes::require(loam_collider_create(world.get(), &collider, &id), "collider");

  Balance balance;
  add_momentum(world, 1, balance.lost, balance.lost_moment);
  Vector at = {0, double(0.03f), 0};
  for (int frame = 0; frame < 30; ++frame) {
    const Vector from = at;
    if (moving) {
      const float time = float(frame + 1) / 120, half = solid.name == "plane" ? 0 : 2 * time; // 4 rad/s
      const float position[3] = {0.2f * time, 0.03f + 0.5f * time, 0}, turn[4] = {std::sin(half), 0, 0, std::cos(half)};
      scenes::require(loam_collider_move(world.get(), id, position, turn), "move");
      at = {double(position[0]), double(position[1]), 0};
    }
    world.step(1.0f / 120);
    const loam_collider_reaction reaction = reaction_of(world, id);
    balance.most_contacts = std::max(balance.most_contacts, reaction.contacts);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t a = (k + 1) % 3, b = (k + 2) % 3;
      const double middle_a = 0.5 * (from[a] + at[a]), middle_b = 0.5 * (from[b] + at[b]);
      balance.impulse[k] += reaction.impulse[k];
      balance.torque[k] += reaction.torque[k] + middle_a * reaction.impulse[b] - middle_b * reaction.impulse[a];
      balance.all.insert(balance.all.end(), {reaction.impulse[k], reaction.torque[k]});
    }
  }
  EXPECT_EQ(world.statistics().speed_limited, 0u);
  add_momentum(world, -1, balance.lost, balance.lost_moment);
  return balance;
}

TEST(ColliderReaction, IsTheMomentumThatMatterLost) {
  for (const solids::Solid &solid : solids::of_every_kind())
    for (const bool moving : {false, true}) {
      SCOPED_TRACE(solid.name + (moving ? ", moving" : ""));
      const Balance apart_from_each_other = run(solid, moving, 3);
      const Balance &b = apart_from_each_other;
      EXPECT_GT(size(b.lost), 0.01 * 0.0016 * 2); // a few of 125 particles of 1.6 g
      EXPECT_LT(apart(b.impulse, b.lost), 0.01 * size(b.lost));
      EXPECT_LT(apart(b.torque, b.lost_moment), 0.01 * std::max(size(b.lost_moment), 0.03 * size(b.lost)));
      EXPECT_GT(b.most_contacts, 0u);
      const Balance heap = run(solid, moving, 1); // and as sand
      EXPECT_LT(apart(heap.impulse, heap.lost), 0.01 * size(heap.lost));
    }
}

TEST(ColliderReaction, HasTheSameBitsForAnyNumberOfThreads) {
  const solids::Solid ball = solids::sphere(0.03f);
  const std::vector<double> one = run(ball, true, 1).all;
  EXPECT_EQ(one, run(ball, true, 1, 2).all);
  EXPECT_EQ(one, run(ball, true, 1, 3).all);
}

/* A pile on the ground: a scale that the host might build. */
TEST(ColliderReaction, OfAPileAtRestIsItsWeightTimesTheStep) {
  scenes::Scene pile = scenes::resting_pile(scenes::sand(), 6);
  pile.planes.clear();
  loam_world_def def = scenes::world_def(pile);
  def.substeps = 8;
  scenes::World world(def, pile);
  loam_collider_def plane = solids::plane().definition();
  plane.friction = 1;
  plane.reaction = 1;
  loam_collider_id id = 0;
  scenes::require(loam_collider_create(world.get(), &plane, &id), "collider");
  const double step = 1.0 / 60, weight = double(pile.material.density) * double(pile.volume()) * double(pile.count()) * 9.81;
  for (int frame = 0; frame < 60; ++frame) world.step(float(step));
  double sum = 0;
  for (int frame = 0; frame < 30; ++frame) {
    world.step(float(step));
    const loam_collider_reaction reaction = reaction_of(world, id);
    EXPECT_NEAR(reaction.impulse[1], -weight * step, 0.05 * weight * step) << frame; // grains still creep
    EXPECT_GT(reaction.contacts, 50u);
    sum += reaction.impulse[1];
  }
  EXPECT_NEAR(sum, -weight * 30 * step, 0.01 * weight * 30 * step);
}

TEST(ColliderReaction, CountsCloth) {
  loam_world_def def = cloths::world_def(10, 4);
  def.gravity[1] = 0;
  scenes::World world(def);
  loam_collider_def ball = solids::sphere(0.1f).definition();
  ball.reaction = 1;
  ball.position[1] = -0.15f;
  loam_collider_id id = 0;
  scenes::require(loam_collider_create(world.get(), &ball, &id), "collider");
  const cloths::Grid grid(16, 16, 0.02f);
  const cloths::Cloth sheet(world.get(), cloths::definition(grid));
  const auto momentum = [&] {
    Vector sum{};
    const cloths::Cloth::Vertices now = sheet.vertices();
    for (std::size_t i = 0; i < now.count(); ++i)
      for (std::size_t k = 0; k < 3; ++k) sum[k] += double(now.velocities[3 * i + k]) / double(now.inverse_masses[i]);
    return sum;
  };
  // Up to speed by gravity, then without.
  const float down[3] = {0.5f, -60, 0}, none[3] = {0, 0, 0};
  scenes::require(loam_world_set_gravity(world.get(), down), "gravity");
  world.step(1.0f / 60);
  scenes::require(loam_world_set_gravity(world.get(), none), "gravity");
  const Vector before = momentum();
  Vector impulse{};
  for (int frame = 0; frame < 20; ++frame) {
    world.step(1.0f / 120);
    const loam_collider_reaction reaction = reaction_of(world, id);
    for (std::size_t k = 0; k < 3; ++k) impulse[k] += reaction.impulse[k];
  }
  EXPECT_EQ(world.statistics().speed_limited, 0u);
  const Vector after = momentum(), lost = {before[0] - after[0], before[1] - after[1], before[2] - after[2]};
  EXPECT_GT(size(lost), 0.2 * size(before));
  EXPECT_LT(apart(impulse, lost), 0.01 * size(lost));
}

} // namespace
} // namespace loam
