/* How matter behaves on a collider, by the pair of collider and material: friction, restitution, stick. Lone particles, so that all has a closed form. */
#include <cmath>
#include <gtest/gtest.h>

#include "support/scenes.h"

namespace loam {
namespace {

constexpr float spacing = 0.01f, gravity = 9.81f;

/* A lone particle of each of two materials, a metre apart, over a collider. */
class Pair {
public:
  Pair(float height, float slope, float velocity_y, const loam_collider_contact &own,
       const loam_collider_contact &of_second) {
    scenes::Scene first;
    first.material = scenes::rubber();
    first.spacing = spacing;
    first.positions = {0, height, 0};
    first.velocities = {0, velocity_y, 0};
    scenes::Scene second = first;
    second.positions[2] = 1;
    loam_world_def def = scenes::world_def(first);
    def.particle_capacity = 2;
    def.gravity[0] = gravity * std::sin(slope); // the plane stays level, the world is tilted
    def.gravity[1] = -gravity * std::cos(slope);
    world_ = scenes::World(def);
    world_.add(first);
    material_ = world_.add(second);
    loam_collider_def collider;
    scenes::require(loam_collider_def_default(&collider, sizeof collider), "default");
    collider.friction = own.friction;
    collider.restitution = own.restitution;
    collider.stick = own.stick;
    if (velocity_y == 0 && height < 0) collider.rotation[2] = 1, collider.rotation[3] = 0; // a ceiling
    scenes::require(loam_collider_create(world_.get(), &collider, &collider_), "collider");
    scenes::require(loam_collider_set_contact(world_.get(), collider_, material_, &of_second), "contact");
  }
  void run(float seconds) {
    for (int frame = 0; frame < int(std::lround(seconds * 120)); ++frame) {
      world_.step(1.0f / 120);
      const scenes::Snapshot now = world_.snapshot();
      for (int i = 0; i < 2; ++i) highest[i] = std::max(highest[i], double(now.positions[3 * i + 1]));
    }
  }
  scenes::Snapshot now() const { return world_.snapshot(); }
  double highest[2] = {-1, -1};

private:
  scenes::World world_{scenes::world_def(scenes::drop_block(scenes::rubber(), 1, 0))};
  loam_material_id material_ = 0;
  loam_collider_id collider_ = 0;
};

loam_collider_contact contact(float friction, float restitution, float stick) {
  return {sizeof(loam_collider_contact), friction, restitution, stick};
}

TEST(ColliderContact, FrictionIsThatOfThePair) {
  const float slope = 0.4f; // tan 0.42
  Pair pair(0.5f * spacing, slope, 0, contact(1, 0, 0), contact(0.2f, 0, 0));
  pair.run(0.5f);
  EXPECT_NEAR(pair.now().positions[0], 0, 1e-5); // sticks
  const double slides = 0.5 * 0.5 * 0.5 * double(gravity) * (std::sin(0.4) - 0.2 * std::cos(0.4));
  EXPECT_NEAR(pair.now().positions[3], slides, 0.02 * slides);
}

/* From a speed of 2 m/s at the surface it rises to the square of the restitution's share of v^2 / 2g. */
TEST(ColliderContact, RestitutionIsThatOfThePair) {
  Pair pair(0.5f * spacing + 0.05f, 0, -2, contact(0, 0, 0), contact(0, 0.8f, 0));
  pair.run(0.05f);
  for (double &h : pair.highest) h = -1;
  pair.run(0.3f);
  const double speed_squared = 4 + 2 * double(gravity) * 0.05, start = 0.005;
  EXPECT_NEAR(pair.highest[0] - start, 0, 2e-4);
  EXPECT_NEAR(pair.highest[1] - start, 0.64 * speed_squared / (2 * double(gravity)), 0.03 * 0.14);
  pair.run(3); // and it comes to rest
  EXPECT_LT(std::abs(pair.now().velocities[4]), 1e-3);
}

/* A particle goes no farther than r in a substep, whatever speed it was given: it does not bounce off what only that speed would reach. */
TEST(ColliderContact, NothingBouncesOffWhatIsOutOfReach) {
  Pair pair(1, 0, -1e4f, contact(0, 0.5f, 0), contact(0, 0, 0)); // 100 spacings over it
  pair.run(1.0f / 120);
  EXPECT_LT(pair.now().positions[1], 1);
  EXPECT_EQ(pair.now().positions[1], pair.now().positions[4]); // the other, which never bounces
}

/* Under a ceiling a cube of r hangs by a stress of density g r: 5 % more holds it, 5 % less does not. */
TEST(ColliderContact, StickIsThatOfThePair) {
  const float weight = scenes::rubber().density * gravity * spacing;
  Pair pair(-0.5f * spacing, 0, 0, contact(0, 0, 0.95f * weight), contact(0, 0, 1.05f * weight));
  pair.run(0.5f);
  EXPECT_LT(pair.now().positions[1], -0.5); // it fell, somewhat held back at first
  EXPECT_NEAR(pair.now().positions[4], -0.5 * double(spacing), 1e-5);
  // Stuck to a steep wall, friction acts as if it were pressed on by the stress: tan(slope) = 10 needs a tenth of it at friction 1.
  const float steep = 1.4711277f;
  Pair wall(0.5f * spacing, steep, 0, contact(1, 0, 0.85f * weight), contact(1, 0, 0.95f * weight));
  wall.run(0.5f);
  EXPECT_GT(wall.now().positions[0], 0.01);
  EXPECT_NEAR(wall.now().positions[3], 0, 1e-5);
}

} // namespace
} // namespace loam
