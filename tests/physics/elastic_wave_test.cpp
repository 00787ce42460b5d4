/* The speed of a front behind a piston: sqrt((lambda + 2 mu) / rho) where the sides are held, sqrt(E / rho) in a thin bar. */
#include "solid.h"

namespace loam::test {
namespace {

struct Bar {
  int length = 64, width = 4; // spacings
  bool held_sides = true;
  float youngs_modulus = 1e5f, zero_energy_stiffness = 10, jitter = 0.12f;
  double density = 1000, poissons_ratio = 0.3;

  /* Between 1/4 and 5/8 of the length, from when the mean velocity of a slice passes half the piston's. */
  double wave_speed() const {
    Points points = {0.01f, jitter};
    points.flush[0] = true;
    points.flush[1] = points.flush[2] = held_sides;
    Solid bar(scenes::rubber(youngs_modulus), points.box({0, 0, 0}, {length, width, width}));
    bar.scene.material.density = float(density);
    bar.scene.material.poissons_ratio = float(poissons_ratio);
    if (held_sides) {
      const float end = 0.01f * float(width);
      bar.scene.planes = {
          {{0, 0, 0}, {0, 1, 0}, 0}, {{0, end, 0}, {0, -1, 0}, 0}, {{0, 0, 0}, {0, 0, 1}, 0}, {{0, 0, end}, {0, 0, -1}, 0}};
    }
    const double expected = std::sqrt(double(youngs_modulus) / density), step = 0.1 * 0.01 / expected;
    const float piston = float(0.005 * expected); // a strain of half a percent
    bar.def.zero_energy_stiffness = zero_energy_stiffness;
    bar.def.substeps = 2;
    // The piston is the first two slices, which keep their velocity.
    const std::size_t slice = std::size_t(width * width), count = 2 * 3 * slice;
    auto &free = bar.scene.positions;
    bar.held.assign(free.begin(), free.begin() + long(count));
    free.erase(free.begin(), free.begin() + long(count));
    bar.held_velocity[0] = piston;
    scenes::World world = bar.make();

    const std::size_t stations[2] = {std::size_t(length / 4), std::size_t(length * 5 / 8)};
    double passed[2] = {0, 0}, before[2] = {0, 0}, place[2] = {0, 0};
    for (std::size_t s = 0; s < 2; ++s)
      for (std::size_t i = 0; i < slice; ++i) place[s] += double(free[3 * ((stations[s] - 2) * slice + i)]) / double(slice);
    const double frame = 2 * step;
    for (double t = 0; passed[1] <= 0 && t < 2 * 0.01 * length / expected; t += frame) {
      world.step(float(frame));
      const scenes::Snapshot now = world.snapshot();
      for (std::size_t s = 0; s < 2; ++s) {
        double mean = 0;
        for (std::size_t i = 0; i < slice; ++i)
          mean += double(now.velocities[3 * ((stations[s] - 2) * slice + i)]) / double(slice) / double(piston);
        if (passed[s] <= 0 && mean > 0.5) passed[s] = t + frame * (0.5 - before[s]) / (mean - before[s]);
        before[s] = mean;
      }
    }
    return (place[1] - place[0]) / (passed[1] - passed[0]);
  }
  double confined() const {
    const double nu = poissons_ratio;
    return std::sqrt(double(youngs_modulus) * (1 - nu) / ((1 + nu) * (1 - 2 * nu)) / density);
  }
  double thin() const { return std::sqrt(double(youngs_modulus) / density); }
};

TEST(ElasticWave, BetweenHeldSidesItIsThePressureWaves) {
  Bar bar;
  bar.width = 6; // walls hold the centres of the outermost layers: 3.1 % slow over 4 spacings, 2.3 % over 6, 2.0 % over 8
  const double ratio = bar.wave_speed() / bar.confined();
  RecordProperty("ratio", std::to_string(ratio));
  EXPECT_NEAR(ratio, 1, 0.03);
  EXPECT_GT(bar.confined() / bar.thin(), 1.1); // the control: the other closed form is far off
  bar.jitter = 0.02f;
  const double ordered = bar.wave_speed() / bar.confined();
  RecordProperty("ordered", std::to_string(ordered));
  EXPECT_NEAR(ordered, 1, 0.03);
}

TEST(ElasticWave, InAThinBarItIsYoungsModuluss) {
  Bar bar;
  bar.held_sides = false;
  const double ratio = bar.wave_speed() / bar.thin();
  RecordProperty("ratio", std::to_string(ratio));
  EXPECT_NEAR(ratio, 1, 0.03);
  bar.zero_energy_stiffness = 0; // the control: disorder softens matter
  const double uncontrolled = bar.wave_speed() / bar.thin();
  RecordProperty("uncontrolled", std::to_string(uncontrolled));
  EXPECT_LT(uncontrolled, 0.95);
}

} // namespace
} // namespace loam::test
