/* A layer of sand on a rough plane that is tilted slowly starts to flow at the slope of its friction angle: the cone is drawn through triaxial
 * compression, a long slope shears in plane strain, so tan(slope) = 2 sqrt(3) sin(phi) / (3 - sin(phi)). Gravity is tilted rather than the plane.
 *
 * The lower end of the layer is free and slumps at any slope, and what slumps takes away the support of what lies above it: the layer is
 * 15 times as long as high, and only its upper part is watched, for less time than the slump needs to get there. The walls at its sides have no
 * friction. An elastic wave crosses 1.3 r a substep: with E = 1 MPa (2.9 r) five iterations leave the layer creeping 2 degrees below its slope, at
 * twice the iterations or half the substep no longer. */
#include "granular.h"

#include <gtest/gtest.h>
#include <string>

namespace loam {
namespace {

using test::degree;

class TiltedLayer {
public:
  TiltedLayer(float friction_angle, double slope)
      : scene_(scenes::slab(scenes::sand(friction_angle, 2e5f), length, double(height) / length, 3, 100)),
        world_(definition(scene_), scene_), start_(world_.snapshot()), slope_(slope) {
    set_gravity();
    run(0.2); // settle
  }

  /* To `slope` degrees, by 20 degrees a second: 1.6 degrees in the time in which sand falls by the layer's height. */
  void tilt(double slope) {
    while (slope_ < slope) {
      slope_ = std::min(slope, slope_ + 20 * double(frame));
      set_gravity();
      world_.step(frame);
    }
  }

  struct Motion {
    double moved;    // down the slope, in r
    double balanced; // the slope, in degrees, at which it would have gone on without acceleration
  };
  Motion watch() {
    const auto [x, v] = middle();
    run(seconds);
    const auto [now_x, now_v] = middle();
    const double acceleration = (now_v - v) / seconds, gravity = 9.81;
    const double down = gravity * std::sin(slope_ * degree), into = gravity * std::cos(slope_ * degree);
    return {(now_x - x) / double(scene_.spacing), std::atan((down - acceleration) / into) / degree};
  }

private:
  static constexpr int length = 90, height = 6; // spacings
  static constexpr float frame = 0.01f;         // 10 substeps of 1 ms
  static constexpr double seconds = 0.3;

  static loam_world_def definition(const scenes::Scene &scene) {
    loam_world_def def = scenes::world_def(scene);
    def.substeps = 10;
    def.velocity_smoothing = 0;
    return def;
  }
  void set_gravity() {
    const float gravity[3] = {float(9.81 * std::sin(slope_ * degree)), float(-9.81 * std::cos(slope_ * degree)), 0};
    scenes::require(loam_world_set_gravity(world_.get(), gravity), "loam_world_set_gravity");
  }
  void run(double duration) {
    for (int k = 0; k < int(std::lround(duration / double(frame))); ++k) world_.step(frame);
  }
  /* Mean x and velocity along x of what started between 0.08 and 0.35 of the length. */
  std::pair<double, double> middle() const {
    const scenes::Snapshot now = world_.snapshot();
    const float from = 0.08f * length * scene_.spacing, to = 0.35f * length * scene_.spacing;
    double x = 0, v = 0;
    int count = 0;
    for (std::size_t i = 0; i < now.positions.size(); i += 3) {
      if (start_.positions[i] < from || start_.positions[i] > to) continue;
      x += double(now.positions[i]);
      v += double(now.velocities[i]);
      ++count;
    }
    return {x / count, v / count};
  }

  scenes::Scene scene_;
  scenes::World world_;
  scenes::Snapshot start_;
  double slope_;
};

double critical_slope(double friction_angle) {
  const double sine = std::sin(friction_angle * degree);
  return std::atan(2 * std::sqrt(3.0) * sine / (3 - sine)) / degree;
}

void record(const std::string &what, double value) { testing::Test::RecordProperty(what, std::to_string(value)); }

constexpr double still = 0.5, flowing = 2; // r in 0.3 s

TEST(TiltedLayer, RestsTwoDegreesUnderItsSlopeAndFlowsTwoDegreesOver) {
  for (const auto &[phi, slope] : {std::pair(20.0f, 24.0), std::pair(30.0f, 34.7), std::pair(40.0f, 43.4)}) {
    EXPECT_NEAR(slope, critical_slope(double(phi)), 0.05);
    const std::string angle = std::to_string(int(phi));
    TiltedLayer layer(phi, slope - 6);
    layer.tilt(slope - 2);
    const double under = layer.watch().moved;
    record("under_" + angle, under);
    EXPECT_LT(under, still) << phi;
    layer.tilt(slope + 2);
    const auto [over, balanced] = layer.watch();
    record("over_" + angle, over);
    record("balanced_" + angle, balanced);
    EXPECT_GT(over, flowing) << phi;
    EXPECT_NEAR(balanced, slope, 1) << phi; // it flows with the friction that held it
  }
}

TEST(TiltedLayer, OfAnotherFrictionAngleFlowsBelowOrRestsAbove) { // the control: 5 degrees either way
  TiltedLayer weak(25, 34.7 - 6);
  weak.tilt(34.7 - 2);
  const double under = weak.watch().moved;
  record("under_25", under);
  EXPECT_GT(under, flowing);
  TiltedLayer strong(35, 34.7 - 2);
  strong.tilt(34.7 + 2);
  const double over = strong.watch().moved;
  record("over_35", over);
  EXPECT_LT(over, still);
}

} // namespace
} // namespace loam
