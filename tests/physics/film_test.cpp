/* A film of Bingham fluid that gravity pulls along a rough wall. With t the shear yield stress and k the consistency it is sheared over the depth
 * hs = H - t / (rho g), and the rest of it slides on top as a plug at rho g hs^2 / (2 k). There is no flow while rho g H < t.
 *
 * The film has ends. Gravity is along the wall, so nothing pushes on them; but within about H of an end the wall holds the film back less, which makes all of it
 * faster by a share that falls as 1 / length (measured in the middle third: 1.056, 1.018, 0.999 of the closed form at 6, 10, 15 H, and 1.057, 1.019, 1.000 by this rule with
 * 0.962 for an endless film). Two lengths tell the endless film's. */

#include <algorithm>

#include "solid.h"

namespace loam {
namespace {

using test::Points;
using test::Solid;

constexpr int layers = 8, depth = 5;
constexpr double spacing = 0.01, density = 1000, gravity = 9.81, thickness = layers * spacing;

struct Film {
  double yield_share = 0.25; // t over rho g H
  double consistency = 200;

  double sheared() const { return thickness * (1 - yield_share); }
  double plug_speed() const { return density * gravity * sheared() * sheared() / (2 * consistency); }

  struct Flow {
    double plug;         // speed of the outermost two layers, m/s
    double half_depth;   // where three quarters of that speed are reached, m: half of the sheared depth
    double displacement; // of the outermost two layers, m
  };

  Flow run(int length, double seconds = 0.15) const {
    loam_material_def material;
    scenes::require(loam_material_def_default(LOAM_LAW_HERSCHEL_BULKLEY, &material, sizeof material), "default");
    material.density = float(density);
    material.youngs_modulus = 2e5f;
    material.poissons_ratio = 0.3f;
    material.shear_yield_stress = float(density * gravity * thickness * yield_share);
    material.consistency = float(consistency);
    material.flow_exponent = 1;
    Points points;
    points.flush[2] = true;
    const std::vector<float> start = points.box({0, 0, 0}, {length, layers, depth});
    Solid film(material, start);
    points.seed = 2;
    film.held = points.box({-4, -3, 0}, {length + 6, 0, depth}); // the wall: matter of the same kind that does not move
    film.scene.planes = {{{0, 0, 0}, {0, 0, 1}, 0}, {{0, 0, depth * 0.01f}, {0, 0, -1}, 0}};
    film.def.gravity[0] = float(gravity);
    film.def.substeps = 20;
    film.def.velocity_smoothing = 0;
    scenes::World world = film.make();
    for (int frame = 0; frame < int(std::lround(seconds / 0.01)); ++frame) world.step(0.01f);

    // Layers of the middle third, by where their matter started.
    const scenes::Snapshot now = world.snapshot();
    double speed[layers] = {}, height[layers] = {}, count[layers] = {}, moved = 0;
    for (std::size_t i = 0; i < start.size(); i += 3) {
      const double x = double(start[i]) / spacing;
      if (x < length / 3.0 || x > 2 * length / 3.0) continue;
      const int layer = std::clamp(int(std::floor(double(start[i + 1]) / spacing)), 0, layers - 1);
      speed[layer] += double(now.velocities[i]);
      height[layer] += double(now.positions[i + 1]);
      ++count[layer];
      if (layer >= layers - 2) moved += double(now.positions[i] - start[i]);
    }
    for (int layer = 0; layer < layers; ++layer) {
      speed[layer] /= count[layer];
      height[layer] /= count[layer];
    }
    Flow flow = {(speed[layers - 1] + speed[layers - 2]) / 2, 0, moved / (count[layers - 1] + count[layers - 2])};
    for (int layer = 0; layer + 1 < layers; ++layer) {
      const double share = (0.75 * flow.plug - speed[layer]) / (speed[layer + 1] - speed[layer]);
      if (share >= 0 && share < 1 && flow.half_depth == 0)
        flow.half_depth = height[layer] + share * (height[layer + 1] - height[layer]);
    }
    return flow;
  }

  /* Of a film without ends. */
  Flow endless() const {
    const int few = 6 * layers, many = 10 * layers;
    const Flow a = run(few), b = run(many);
    const auto limit = [&](double at_few, double at_many) { return (many * at_many - few * at_few) / (many - few); };
    return {limit(a.plug, b.plug), limit(a.half_depth, b.half_depth), limit(a.displacement, b.displacement)};
  }
};

TEST(BinghamFilm, ShearedDepthAndPlugSpeedMeetTheClosedForm) {
  const Film film;
  const Film::Flow flow = film.endless();
  RecordProperty("plug", std::to_string(flow.plug / film.plug_speed()));
  RecordProperty("sheared", std::to_string(2 * flow.half_depth / film.sheared()));
  EXPECT_NEAR(flow.plug, film.plug_speed(), 0.05 * film.plug_speed());
  EXPECT_NEAR(2 * flow.half_depth, film.sheared(), 0.05 * film.sheared());
}

/* The control: a quarter more of yield stress leaves both bands. */
TEST(BinghamFilm, AnotherYieldStressDoesNot) {
  const Film film;
  Film other;
  other.yield_share *= 1.25;
  const Film::Flow flow = other.endless();
  RecordProperty("plug", std::to_string(flow.plug / film.plug_speed()));
  RecordProperty("sheared", std::to_string(2 * flow.half_depth / film.sheared()));
  EXPECT_LT(flow.plug, 0.85 * film.plug_speed());
  EXPECT_LT(2 * flow.half_depth, 0.94 * film.sheared());
}

TEST(BinghamFilm, DoesNotFlowUnderItsYieldStress) {
  Film stands;
  stands.yield_share = 1.1;
  const double flows = Film().run(6 * layers).displacement, moved = stands.run(6 * layers).displacement;
  RecordProperty("moved", std::to_string(moved / flows));
  EXPECT_GT(flows, 0.5 * Film().plug_speed() * 0.15); // from rest
  EXPECT_LT(moved, 0.1 * flows);                      // elastically
}

} // namespace
} // namespace loam
