/* Winds, attractors and blasts against closed forms. */
#include <cmath>
#include <gtest/gtest.h>

#include "support/cloths.h"
#include "support/scenes.h"

namespace loam {
namespace {

/* Particles 5 kernel radii apart: none acts on another. */
scenes::Scene apart(int count) {
  scenes::Scene scene;
  scene.material = scenes::sand();
  scene.spacing = 0.01f;
  for (int i = 0; i < count; ++i) scene.positions.insert(scene.positions.end(), {0.05f * float(i + 1), 0, 0});
  return scene;
}

scenes::World world_of(const scenes::Scene &scene, float gravity, std::uint32_t substeps = 16) {
  loam_world_def def = scenes::world_def(scene);
  def.gravity[1] = gravity;
  def.substeps = substeps;
  return scenes::World(def, scene);
}

loam_field_def field(std::uint32_t kind) {
  loam_field_def def;
  scenes::require(loam_field_def_default(&def, sizeof def), "loam_field_def_default");
  def.kind = kind;
  return def;
}

loam_field_id add(const scenes::World &world, const loam_field_def &def) {
  loam_field_id id = 0;
  scenes::require(loam_field_create(world.get(), &def, &id), "loam_field_create");
  return id;
}

TEST(Field, MatterFallsAtItsTerminalVelocityInAWind) {
  scenes::World world = world_of(apart(3), -9.81f);
  loam_field_def wind = field(LOAM_FIELD_WIND);
  wind.velocity[0] = 2;
  wind.rate = 10;
  (void)add(world, wind);
  const double h = 1.0 / 60 / 16;
  double vx = 0, vy = 0;
  for (int frame = 0; frame < 60; ++frame) {
    world.step(1.0f / 60);
    for (int k = 0; k < 16; ++k) { // gravity, then the wind
      vx += (2 - vx) * (1 - std::exp(-10 * h));
      vy = (vy - 9.81 * h) * std::exp(-10 * h);
    }
    const scenes::Snapshot now = world.snapshot();
    for (std::size_t i = 0; i < now.count(); ++i) {
      EXPECT_NEAR(double(now.velocities[3 * i]), vx, 1e-5);
      EXPECT_NEAR(double(now.velocities[3 * i + 1]), vy, 1e-5);
    }
  }
  const scenes::Snapshot end = world.snapshot();
  EXPECT_NEAR(double(end.velocities[0]), 2, 0.001);
  EXPECT_NEAR(double(end.velocities[1]), -0.981, 0.981 * (0.5 * 10 * h + 0.001)); // g / rate
}

TEST(Field, AnAttractorIsASoftenedPointMass) {
  const scenes::Scene scene = apart(4);
  scenes::World world = world_of(scene, 0);
  loam_field_def mass = field(LOAM_FIELD_ATTRACTOR);
  mass.strength = 0.02f;
  mass.softening = 0.05f;
  mass.position[1] = 0.1f;
  (void)add(world, mass);
  const double seconds = 1e-3;
  world.step(float(seconds));
  const scenes::Snapshot now = world.snapshot();
  for (std::size_t i = 0; i < now.count(); ++i) {
    const double x = double(scene.positions[3 * i]), y = -0.1, squared = x * x + y * y + 0.05 * 0.05;
    const double factor = -0.02 / (squared * std::sqrt(squared)) * seconds;
    EXPECT_NEAR(double(now.velocities[3 * i]), factor * x, 1e-3 * std::abs(factor * x));
    EXPECT_NEAR(double(now.velocities[3 * i + 1]), factor * y, 1e-3 * std::abs(factor * y));
  }
}

/* Once, in the substep that its time falls into, and not again; then anew. */
TEST(Field, ABlastGivesItsMomentumOnce) {
  const scenes::Scene scene = apart(6);
  scenes::World world = world_of(scene, 0, 4);
  loam_field_def blast = field(LOAM_FIELD_BLAST);
  blast.speed = 3;
  blast.radius = 0.22f; // reaches four of six
  blast.time = 0.035f;
  const loam_field_id id = add(world, blast);
  double expected = 0;
  for (int i = 0; i < 4; ++i) expected += 3 * (1 - 0.05 * (i + 1) / 0.22);
  const auto speeds = [&] {
    double sum = 0;
    const scenes::Snapshot now = world.snapshot();
    for (std::size_t i = 0; i < now.count(); ++i) sum += double(now.velocities[3 * i]);
    return sum;
  };
  for (int frame = 0; frame < 3; ++frame) {
    world.step(0.01f);
    EXPECT_EQ(speeds(), 0);
  }
  for (int frame = 0; frame < 3; ++frame) {
    world.step(0.01f);
    EXPECT_NEAR(speeds(), expected, 1e-5 * expected);
  }
  const scenes::Snapshot now = world.snapshot();
  EXPECT_EQ(now.velocities[3 * 5], 0.0f);
  // In the third substep of the fourth step: it flies for two substeps of that, and for two steps.
  EXPECT_NEAR(double(now.positions[0]), 0.05 + 0.025 * double(now.velocities[0]), 1e-6);
  scenes::require(loam_field_set(world.get(), id, &blast), "set");
  world.step(0.01f);
  EXPECT_NEAR(speeds(), expected, 1e-5 * expected);
  for (int frame = 0; frame < 4; ++frame) world.step(0.01f);
  EXPECT_GT(speeds(), 1.1 * expected);
}

TEST(Field, ActsOnClothButForTheWind) {
  loam_world_def def = cloths::world_def(4, 4);
  def.gravity[1] = 0;
  scenes::World world(def);
  const cloths::Grid grid(2, 2, 0.05f);
  const cloths::Cloth sheet(world.get(), cloths::definition(grid));
  loam_field_def wind = field(LOAM_FIELD_WIND);
  wind.velocity[1] = 5;
  (void)add(world, wind);
  world.step(0.01f);
  EXPECT_EQ(sheet.vertices().fastest(), 0.0f);
  loam_field_def blast = field(LOAM_FIELD_BLAST);
  blast.speed = 2;
  blast.radius = 4; // as good as even over the sheet
  blast.position[1] = -2;
  (void)add(world, blast);
  world.step(0.01f);
  double momentum = 0, mass = 0;
  const cloths::Cloth::Vertices now = sheet.vertices();
  for (std::size_t i = 0; i < now.count(); ++i) {
    mass += 1 / double(now.inverse_masses[i]);
    momentum += double(now.velocities[3 * i + 1]) / double(now.inverse_masses[i]);
  }
  EXPECT_NEAR(momentum, 1.0 * mass, 0.01 * mass);
}

TEST(Field, ABlastWakesWhatSleeps) {
  const scenes::Scene pile = scenes::slab(scenes::sand(), 16, 0.2f, 5);
  loam_world_def def = scenes::world_def(pile);
  def.substeps = 8;
  def.sleep_speed = 0.05f;
  def.sleep_delay = 0.05f;
  scenes::World world(def, pile);
  loam_field_def blast = field(LOAM_FIELD_BLAST);
  blast.speed = 2;
  blast.radius = 0.03f;
  blast.time = 3;
  blast.position[2] = 0.025f;
  (void)add(world, blast);
  int frame = 0;
  for (; frame < 170 && world.statistics().sleeping < pile.count(); ++frame) world.step(1.0f / 60);
  ASSERT_EQ(world.statistics().sleeping, pile.count());
  for (; frame < 179; ++frame) world.step(1.0f / 60);
  EXPECT_EQ(world.statistics().sleeping, pile.count());
  double fastest = 0;
  for (; frame < 182; ++frame) {
    world.step(1.0f / 60);
    fastest = std::max(fastest, world.statistics().max_speed);
  }
  const loam_statistics statistics = world.statistics();
  EXPECT_LT(statistics.sleeping, pile.count() - 10);
  EXPECT_GT(statistics.sleeping, 50u); // those farther away
  EXPECT_GT(fastest, 0.3);
}

} // namespace
} // namespace loam
