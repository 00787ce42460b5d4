#include "vanilla_sand.h"

#include <gtest/gtest.h>
#include <numbers>
#include <random>

namespace {

using namespace loam::reference;

constexpr double diameter = 0.01;

/* The speed of a grain on a plane inclined by 30 degrees after 0.2 s, over g t. */
double slide(double static_friction, double kinetic_friction) {
  const double angle = std::numbers::pi / 6, h = 1e-3;
  VanillaSand::Settings settings;
  settings.gravity = 9.81 * Vector3<double>(std::sin(angle), -std::cos(angle), 0);
  VanillaSand sand(settings);
  sand.add_grain({0, diameter / 2, 0}, {0, 0, 0}, 1e-3);
  sand.add_plane({0, 0, 0}, {0, 1, 0}, static_friction, kinetic_friction);
  for (int step = 0; step < 200; ++step) sand.advance(h);
  return sand.particles().motions[0].velocity[0] / (9.81 * 0.2);
}

TEST(VanillaSand, GrainsSlideByCoulombsLaw) {
  for (const double friction : {0.0, 0.2, 0.5}) {
    const double expected = 0.5 - friction * std::sqrt(0.75);
    EXPECT_NEAR(slide(friction, friction), expected, 0.002) << friction;
  }
  // tan 30 = .577
  EXPECT_LT(std::fabs(slide(0.6, 0.2)), 1e-12);
  EXPECT_NEAR(slide(0.55, 0.2), 0.5 - 0.2 * std::sqrt(0.75), 0.002);
}

/* A grain that runs over one that is much heavier loses the impulse that Coulomb allows: one step, by hand. */
TEST(VanillaSand, GrainsRubAgainstEachOther) {
  VanillaSand::Settings settings;
  settings.gravity.setZero();
  settings.iterations = 1;
  VanillaSand sand(settings);
  const double h = 1e-3, fall = 0.5, along = 2;
  sand.add_grain({0, 0, 0}, {0, 0, 0}, 1e9);
  // It ends the step straight above the other.
  sand.add_grain({-h * along, diameter, 0}, {along, -fall, 0}, 1e-3);
  sand.advance(h);
  const Particles<double> &after = sand.particles();
  const std::size_t grain = after.ids[0] == 1 ? 0 : 1;
  EXPECT_NEAR(after.motions[grain].velocity[1], 0, 1e-9);
  EXPECT_NEAR(after.motions[grain].velocity[0], along - 0.5 * fall, 1e-9);
}

TEST(VanillaSand, ConservesMomentum) {
  VanillaSand::Settings settings;
  settings.gravity.setZero();
  VanillaSand sand(settings);
  std::mt19937 random(3);
  Vector3<double> before = Vector3<double>::Zero();
  for (int k = 0; k < 125; ++k) {
    const Vector3<double> place(k % 5, k / 5 % 5, k / 25);
    const double mass = 1e-3 * (1 + random() % 10);
    const Vector3<double> velocity = Vector3<double>(1, 0, 0) - 0.5 * (place - Vector3<double>(2, 2, 2)); // it implodes
    sand.add_grain(diameter * place, velocity, mass);
    before += mass * velocity;
  }
  for (int step = 0; step < 30; ++step) sand.advance(1e-3);
  Vector3<double> after = Vector3<double>::Zero();
  for (const Motion<double> &motion : sand.particles().motions) after += motion.velocity / motion.inverse_mass;
  EXPECT_LT((after - before).norm(), 1e-12 * before.norm());
  EXPECT_LT((sand.particles().motions[0].velocity - sand.particles().motions[124].velocity).norm(), 1); // they had met
}

struct Heap {
  double run_out, speed, least_distance; // over the radius; the mean; over the diameter
};

/* A column as high as its radius, after 0.6 s. */
Heap heap(double friction) {
  const int radius = 5;
  VanillaSand::Settings settings;
  settings.static_friction = settings.kinetic_friction = friction;
  settings.iterations = 10;
  VanillaSand sand(settings);
  std::mt19937 random(5);
  for (int i = -radius; i < radius; ++i)
    for (int j = 0; j < radius; ++j)
      for (int k = -radius; k < radius; ++k) {
        Vector3<double> place(i + 0.5, j + 0.5, k + 0.5);
        if (std::hypot(place[0], place[2]) > radius) continue;
        for (double &coordinate : place) coordinate *= 1.2; // room for disorder
        place += 1e-3 * Vector3<double>(random() % 200, random() % 200, random() % 200);
        sand.add_grain(diameter * place, {0, 0, 0}, 1e-3);
      }
  sand.add_plane({0, 0, 0}, {0, 1, 0}, friction, friction);
  for (int step = 0; step < 300; ++step) sand.advance(2e-3);
  Heap heap = {0, 0, 2};
  const std::vector<Vector3<double>> &x = sand.particles().positions;
  std::vector<double> distances;
  for (std::size_t a = 0; a < x.size(); ++a) {
    distances.push_back(std::hypot(x[a][0], x[a][2]) / diameter / radius);
    heap.speed += sand.particles().motions[a].velocity.norm() / double(x.size());
    for (std::size_t b = 0; b < a; ++b) heap.least_distance = std::min(heap.least_distance, (x[a] - x[b]).norm() / diameter);
  }
  std::sort(distances.begin(), distances.end());
  heap.run_out = distances[distances.size() * 9 / 10];
  return heap;
}

TEST(VanillaSand, ComesToRestInAHeapThatFrictionHolds) {
  const Heap rough = heap(0.6), smooth = heap(0.2);
  RecordProperty("rough", std::to_string(rough.run_out));
  RecordProperty("smooth", std::to_string(smooth.run_out));
  RecordProperty("speed", std::to_string(rough.speed));
  RecordProperty("least_distance", std::to_string(rough.least_distance));
  EXPECT_LT(rough.run_out, 1.4);
  EXPECT_GT(smooth.run_out, rough.run_out + 0.3);
  EXPECT_LT(rough.speed, 2e-3);
  EXPECT_GT(rough.least_distance, 0.95);
}

/* Grains that sleep stay where they are. */
TEST(VanillaSand, SleepingGrainsDoNotCreep) {
  VanillaSand::Settings settings;
  settings.sleep_speed = 0.02; // over g h
  VanillaSand sand(settings);
  sand.add_grain({0, 0, 0}, {0, 0, 0}, 1e-3); // nothing holds it
  sand.advance(1e-3);
  EXPECT_EQ(sand.particles().positions[0].norm(), 0);
  for (int step = 0; step < 5; ++step) sand.advance(1e-3);
  EXPECT_LT(sand.particles().positions[0][1], -1e-5); // until it is fast enough
}

} // namespace
