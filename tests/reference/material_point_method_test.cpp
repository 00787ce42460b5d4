#include "material_point_method.h"
#include "strain.h"

#include "../support/scenes.h"
#include <gtest/gtest.h>
#include <numbers>

namespace {

using namespace loam::reference;
namespace scenes = loam::scenes;

constexpr double cell = 0.01;

/* Points at the middles of 8 equal parts of each cell, first <= cell < last. */
void add_box(MaterialPointMethod &method, const int (&first)[3], const int (&last)[3],
             const Vector3<double> &velocity = {0, 0, 0}) {
  for (int i = 2 * first[0]; i < 2 * last[0]; ++i)
    for (int j = 2 * first[1]; j < 2 * last[1]; ++j)
      for (int k = 2 * first[2]; k < 2 * last[2]; ++k)
        method.add_point(cell / 2 * Vector3<double>(i + 0.5, j + 0.5, k + 0.5), velocity, std::pow(cell / 2, 3));
}

MaterialPointMethod::Settings weightless() {
  MaterialPointMethod::Settings settings;
  settings.gravity.setZero();
  return settings;
}

/* Affine transfers keep angular momentum too: that of the points and of the motion around each of them, m (d^2 / 4) C. */
TEST(MaterialPointMethod, ConservesMomentum) {
  MaterialPointMethod method(weightless(), Material<double>::from(scenes::plasticine(5e2f, 1e5f)));
  add_box(method, {0, 0, 0}, {3, 3, 3}, {1, 0.2, 0});
  add_box(method, {4, 1, 1}, {6, 3, 3}, {-1.5, 0, 0.3});
  Vector3<double> linear, angular, centre; // the last times the mass
  const auto measure = [&] {
    linear.setZero(), angular.setZero(), centre.setZero();
    for (const MaterialPointMethod::Point &point : method.points()) {
      const Matrix3<double> &C = point.affine;
      linear += point.mass * point.velocity;
      centre += point.mass * point.position;
      angular += point.mass * point.position.cross(point.velocity);
      angular += point.mass * cell * cell / 4 * Vector3<double>(C(2, 1) - C(1, 2), C(0, 2) - C(2, 0), C(1, 0) - C(0, 1));
    }
  };
  measure();
  const Vector3<double> linear_before = linear, angular_before = angular, centre_before = centre;
  method.run(0.03); // they collide
  measure();
  EXPECT_LT((linear - linear_before).norm(), 1e-12 * linear_before.norm());
  EXPECT_LT((angular - angular_before).norm(), 1e-12 * angular_before.norm());
  EXPECT_LT((centre - centre_before - 0.03 * linear).norm(), 1e-12 * linear.norm());
  double moved = 0;
  for (const MaterialPointMethod::Point &point : method.points()) moved = std::max(moved, point.strain.norm());
  EXPECT_GT(moved, 0.05);
}

/* At rest between smooth walls: p = rho g (H - y) in compression by its own weight, and nu / (1 - nu) of it across. */
TEST(MaterialPointMethod, ConfinedColumnCarriesItsWeight) {
  const int height = 12;
  const auto material = Material<double>::from(scenes::rubber(2e5f));
  MaterialPointMethod::Settings settings;
  MaterialPointMethod method(settings, material);
  add_box(method, {0, 0, 0}, {2, height, 2});
  for (int axis = 0; axis < 3; ++axis) {
    const Vector3<double> normal = Vector3<double>::Unit(axis);
    method.add_plane({0, 0, 0}, normal, Boundary::slip);
    if (axis != 1) method.add_plane(2 * cell * normal, -normal, Boundary::slip);
  }
  // Slowly loaded, over some six of its periods, so that it hardly swings.
  const double wave = std::sqrt((material.lame_lambda + 2 * material.shear_modulus) / material.density);
  const double period = 4 * height * cell / wave;
  for (int part = 1; part <= 30; ++part) {
    method.set_gravity({0, -9.81 * part / 30, 0});
    method.run(period / 5);
  }
  double upright = 0, side = 0, weight = 0;
  for (int sample = 0; sample < 10; ++sample) {
    method.run(period / 10);
    for (std::size_t k = 0; k < method.points().size(); ++k) {
      const MaterialPointMethod::Point &point = method.points()[k];
      const double depth = height * cell - cell / 2 * (double(k / 4 % (2 * height)) + 0.5); // of the undeformed column
      if (depth < 2 * cell || depth > (height - 2) * cell) continue;
      const auto principal = principal_hencky_strain(point.strain, 1.0);
      const Matrix3<double> stress =
          compose(principal.directions, material.kirchhoff_stress(principal.strain)) / std::exp(principal.strain.sum());
      upright -= stress(1, 1);
      side -= (stress(0, 0) + stress(2, 2)) / 2;
      weight += material.density * 9.81 * depth;
    }
  }
  const double ratio = material.lame_lambda / (material.lame_lambda + 2 * material.shear_modulus);
  RecordProperty("pressure", std::to_string(upright / weight));
  RecordProperty("side", std::to_string(side / upright / ratio));
  EXPECT_NEAR(upright / weight, 1, 0.03);
  EXPECT_NEAR(side / upright, ratio, 0.03 * ratio);
}

/* The lowest longitudinal mode of a free bar, c pi / L: its first quarter of a period. */
TEST(MaterialPointMethod, WavesHaveTheirSpeed) {
  for (const bool confined : {false, true}) {
    const int length = 30;
    const auto material = Material<double>::from(scenes::rubber(1e5f));
    const double mu = material.shear_modulus, lambda = material.lame_lambda;
    MaterialPointMethod method(weightless(), material);
    const double end = length * cell;
    for (int i = 0; i < 2 * length; ++i)
      for (int j = 0; j < 4; ++j)
        for (int k = 0; k < 4; ++k) {
          const Vector3<double> position = cell / 2 * Vector3<double>(i + 0.5, j + 0.5, k + 0.5);
          method.add_point(position, {0.01 * std::cos(std::numbers::pi * position[0] / end), 0, 0}, std::pow(cell / 2, 3));
        }
    if (confined)
      for (const int axis : {1, 2}) {
        method.add_plane({0, 0, 0}, Vector3<double>::Unit(axis), Boundary::slip);
        method.add_plane({2 * cell, 2 * cell, 2 * cell}, -Vector3<double>::Unit(axis), Boundary::slip);
      }
    const auto amplitude = [&] {
      double sum = 0;
      for (const MaterialPointMethod::Point &point : method.points())
        sum += point.velocity[0] * std::cos(std::numbers::pi * point.position[0] / end);
      return sum;
    };
    const double h = method.stable_step() / 2;
    double time = 0, now = amplitude(), before = now;
    while (now > 0) {
      method.advance(h);
      time += h;
      before = std::exchange(now, amplitude());
    }
    const double quarter = time - h * now / (now - before), speed = end / (2 * quarter);
    const double expected =
        std::sqrt((confined ? lambda + 2 * mu : mu * (3 * lambda + 2 * mu) / (lambda + mu)) / material.density);
    RecordProperty(confined ? "confined" : "bar", std::to_string(speed / expected));
    EXPECT_NEAR(speed / expected, 1, 0.03) << confined;
  }
}

/* The speed, along the plane, of a block after 0.1 s on a plane inclined by 30 degrees, over g t. */
double slide(double friction) {
  const double angle = std::numbers::pi / 6, time = 0.1;
  MaterialPointMethod::Settings settings;
  settings.gravity = 9.81 * Vector3<double>(std::sin(angle), -std::cos(angle), 0);
  MaterialPointMethod method(settings, Material<double>::from(scenes::rubber(2e5f)));
  add_box(method, {0, 0, 0}, {4, 3, 4});
  method.add_plane({0, 0, 0}, {0, 1, 0}, Boundary::coulomb, friction);
  method.run(time);
  double speed = 0;
  for (const MaterialPointMethod::Point &point : method.points()) speed += point.velocity[0];
  return speed / double(method.points().size()) / (9.81 * time);
}

TEST(MaterialPointMethod, BlockSlidesByCoulombsLaw) {
  const double sine = 0.5, cosine = std::sqrt(0.75);
  EXPECT_NEAR(slide(0), sine, 0.01 * sine);
  for (const double friction : {0.2, 0.4}) {
    const double expected = sine - friction * cosine, measured = slide(friction);
    RecordProperty("ratio_" + std::to_string(friction), std::to_string(measured / expected));
    EXPECT_NEAR(measured, expected, 0.05 * expected);
  }
  EXPECT_NEAR(slide(0.7), 0, 0.005);
}

/* A block that is pulled apart evenly yields at the bound and keeps its volume. */
TEST(MaterialPointMethod, VonMisesBlockYieldsAtItsStress) {
  const auto material = Material<double>::from(scenes::plasticine(2e3f, 1e6f));
  MaterialPointMethod method(weightless(), material);
  for (int k = 0; k < 512; ++k) {
    const Vector3<double> position = cell / 2 * Vector3<double>(k % 8 - 3.5, k / 8 % 8 - 3.5, k / 64 - 3.5);
    method.add_point(position, 20 * Vector3<double>(position[0], -position[1] / 2, -position[2] / 2), std::pow(cell / 2, 3));
  }
  method.run(4e-4);
  for (const MaterialPointMethod::Point &point : method.points()) {
    if (point.position.norm() > cell) continue; // waves of release come in from the surface
    const auto principal = principal_hencky_strain(point.strain, 1.0);
    const Vector3<double> stress = material.kirchhoff_stress(principal.strain);
    EXPECT_NEAR(principal.strain.sum(), 0, 5e-4);
    EXPECT_NEAR(stress[2] - (stress[0] + stress[1]) / 2, 2e3, 40);
  }
}

/* How far the foremost point of a column of sand ran, over its radius, which is `cells` cells; a quarter of it, by symmetry. */
double run_out(int cells, double friction_angle_degrees) {
  MaterialPointMethod::Settings settings;
  const double radius = 0.1, width = radius / cells;
  settings.cell = width;
  MaterialPointMethod method(settings, Material<double>::from(scenes::sand(float(friction_angle_degrees), 1e5f)));
  for (int i = 0; i < 2 * cells; ++i)
    for (int j = 0; j < 2 * cells; ++j)
      for (int k = 0; k < 2 * cells; ++k) {
        const Vector3<double> position = width / 2 * Vector3<double>(i + 0.5, j + 0.5, k + 0.5);
        if (std::hypot(position[0], position[2]) < radius) method.add_point(position, {0, 0, 0}, std::pow(width / 2, 3));
      }
  method.add_plane({0, 0, 0}, {1, 0, 0}, Boundary::slip);
  method.add_plane({0, 0, 0}, {0, 0, 1}, Boundary::slip);
  method.add_plane({0, 0, 0}, {0, 1, 0}, Boundary::coulomb, std::tan(std::numbers::pi / 6));
  method.run(0.35);
  double farthest = 0;
  for (const MaterialPointMethod::Point &point : method.points())
    farthest = std::max(farthest, std::hypot(point.position[0], point.position[2]));
  return farthest / radius - 1;
}

/* Lube et al. 2004: a column as high as its radius runs out by 1.24 radii. Their sand starts to flow at about 30 degrees, as the cone does whose triaxial friction angle is
 * 25.4: tan 30 = 2 sqrt(3) sin / (3 - sin). The run-out converges slowly, with the first power of the cells (.70, .83, .93, 1.02 at 4, 6, 8, 12 cells a radius), so it
 * is extrapolated to none: 1.22 from the finest two, 1.10 from the coarsest. */
TEST(MaterialPointMethod, SandColumnRunsOutAsInTheExperiment) {
  const auto extrapolated = [](double angle) {
    const double coarse = run_out(4, angle), fine = run_out(6, angle);
    return fine + (fine - coarse) * 4 / (6 - 4);
  };
  const double measured = extrapolated(25.4);
  RecordProperty("run_out", std::to_string(measured));
  EXPECT_NEAR(measured, 1.24, 0.2 * 1.24);
  const double steep = extrapolated(36); // the control
  RecordProperty("run_out_36", std::to_string(steep));
  EXPECT_LT(steep, 0.8 * 1.24);
}

} // namespace
