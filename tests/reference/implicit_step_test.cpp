#include "from_scene.h"
#include "implicit_step.h"

#include <gtest/gtest.h>
#include <random>

namespace {

using namespace loam::reference;

Material<double> rubber(double youngs_modulus) {
  return Material<double>::from(loam::scenes::rubber(float(youngs_modulus)));
}

/* Lattice points (i + 1/2) spacing, first <= i < last, moved at random by up to `jitter` spacings. */
Vectors box(const int (&first)[3], const int (&last)[3], double jitter, unsigned seed = 1) {
  std::mt19937 random(seed);
  const auto offset = [&] { return jitter * (2 * (random() / 4294967296.0) - 1); };
  std::vector<double> points;
  for (int i = first[0]; i < last[0]; ++i)
    for (int j = first[1]; j < last[1]; ++j)
      for (int k = first[2]; k < last[2]; ++k)
        for (const int index : {i, j, k}) points.push_back(0.01 * (index + 0.5 + offset()));
  return Eigen::Map<Vectors>(points.data(), 3, Eigen::Index(points.size() / 3));
}

Vectors random_velocities(Eigen::Index count, double speed, unsigned seed = 7) {
  std::mt19937 random(seed);
  Vectors velocities(3, count);
  for (Eigen::Index i = 0; i < velocities.size(); ++i) velocities.data()[i] = speed * (random() / 2147483648.0 - 1);
  return velocities;
}

constexpr double volume = 1e-6;

/* A small block with strain, drift and a pinned particle in it, and a step's energy on it. */
struct Block {
  Particles<double> particles;
  Neighbourhoods<double> neighbourhoods;
  StepEnergy energy;

  static ImplicitStep moved() {
    ImplicitStep solver({}, rubber(1e5));
    const Vectors points = box({0, 0, 0}, {4, 4, 4}, 0.15);
    solver.add_particles(points, random_velocities(points.cols(), 0.5), volume);
    solver.add_particles(Vectors::Constant(3, 1, -0.005), Vectors::Zero(3, 1), volume, true);
    for (int step = 0; step < 3; ++step) solver.advance(2e-3);
    return solver;
  }
  Block() : Block(moved()) {}
  explicit Block(const ImplicitStep &solver)
      : particles(solver.particles()), neighbourhoods(found(particles)),
        energy(HenckySolid::from(rubber(1e5)), particles, neighbourhoods, 3, 1e9, {0, -9.81, 0}, 2e-3) {
    Vectors drifts(3, Eigen::Index(particles.size()));
    for (std::size_t p = 0; p < particles.size(); ++p) drifts.col(Eigen::Index(p)) = solver.drifts()[particles.ids[p]];
    energy.set_drifts(drifts);
  }
  static Neighbourhoods<double> found(Particles<double> &particles) {
    const WendlandKernel<double> kernel(0.01);
    Neighbourhoods<double> result;
    find_neighbours(particles, sort_by_cell(particles, kernel.support()), kernel, 0.0, result);
    compute_gradients(particles, kernel, 0.01, result);
    return result;
  }
};

TEST(StepEnergy, DerivativesAreThoseOfItsValue) {
  Block block;
  const auto count = Eigen::Index(block.particles.size());
  const Vectors at = random_velocities(count, 0.2), gradient = block.energy.gradient(at);
  block.energy.linearise(at, false);
  for (unsigned seed = 20; seed < 24; ++seed) {
    Vectors direction = random_velocities(count, 1, seed);
    for (std::size_t p = 0; p < block.particles.size(); ++p)
      if (block.particles.motions[p].inverse_mass == 0) direction.col(Eigen::Index(p)).setZero();
    const double d = 1e-4;
    const double slope = (block.energy.value(at + d * direction) - block.energy.value(at - d * direction)) / (2 * d);
    EXPECT_NEAR(gradient.cwiseProduct(direction).sum() / slope, 1, 1e-6);
    const Vectors change = (block.energy.gradient(at + d * direction) - block.energy.gradient(at - d * direction)) / (2 * d);
    EXPECT_LT((block.energy.multiply(direction) - change).norm(), 1e-6 * change.norm());
  }
}

TEST(StepEnergy, LinearFieldsHaveTheirGradientAndNoNonAffinePart) {
  const Block block;
  Matrix3<double> field;
  field << 1, -2, 3, 0.5, 4, -1, 2, 0.25, -3;
  Vectors velocities(3, Eigen::Index(block.particles.size()));
  for (std::size_t p = 0; p < block.particles.size(); ++p)
    velocities.col(Eigen::Index(p)) = field * block.particles.positions[p];
  for (std::size_t p = 0; p < block.particles.size(); ++p) {
    if (block.particles.motions[p].inverse_mass == 0) continue; // it stands apart from the block
    EXPECT_LT((block.energy.gradient_step(p, velocities) - 2e-3 * field).norm(), 1e-12);
    EXPECT_LT(block.energy.non_affine_step(p, velocities).norm(), 1e-14);
  }
}

/* A flat sheet knows its motion in its plane only; it turns with the sheet all the same. */
TEST(StepEnergy, ASheetThatTurnsIsNotStrained) {
  Particles<double> particles;
  {
    ImplicitStep solver({}, rubber(1e5));
    const Vectors points = box({0, 0, 0}, {1, 5, 5}, 0);
    solver.add_particles(points, Vectors::Zero(3, points.cols()), volume);
    particles = solver.particles();
  }
  const Neighbourhoods<double> neighbourhoods = Block::found(particles);
  const StepEnergy energy(HenckySolid::from(rubber(1e5)), particles, neighbourhoods, 3, 1e9, {0, 0, 0}, 2e-3);
  const Vector3<double> spin(1, -2, 0.5);
  Matrix3<double> expected;
  expected << 0, -spin[2], spin[1], spin[2], 0, -spin[0], -spin[1], spin[0], 0;
  Vectors velocities(3, Eigen::Index(particles.size()));
  for (std::size_t p = 0; p < particles.size(); ++p) velocities.col(Eigen::Index(p)) = spin.cross(particles.positions[p]);
  for (std::size_t p = 0; p < particles.size(); ++p) {
    EXPECT_LT((energy.gradient_step(p, velocities) - 2e-3 * expected).norm(), 1e-10);
    EXPECT_LT(energy.non_affine_step(p, velocities).norm(), 1e-12);
  }
}

TEST(ImplicitStep, ConservesMomentumAndLosesEnergy) {
  ImplicitStep::Settings settings;
  settings.gravity.setZero();
  ImplicitStep solver(settings, rubber(1e5));
  const Vectors points = box({0, 0, 0}, {5, 4, 4}, 0.15);
  solver.add_particles(points, random_velocities(points.cols(), 0.5), volume);
  const HenckySolid solid = HenckySolid::from(rubber(1e5));
  const auto momentum = [&] {
    Vector3<double> sum = Vector3<double>::Zero();
    for (const Motion<double> &motion : solver.particles().motions) sum += motion.velocity / motion.inverse_mass;
    return sum;
  };
  const auto energy = [&] {
    double sum = 0;
    for (std::size_t p = 0; p < solver.particles().size(); ++p) {
      const Motion<double> &motion = solver.particles().motions[p];
      const auto principal = principal_hencky_strain(solver.particles().strains[p], 10.0);
      sum += motion.velocity.squaredNorm() / (2 * motion.inverse_mass) +
             volume * (rubber(1e5).energy_density(principal.strain) +
                       solid.shear_modulus * 10 / 1e-4 * solver.drifts()[solver.particles().ids[p]].squaredNorm());
    }
    return sum;
  };
  const Vector3<double> before = momentum();
  double last = energy();
  for (int step = 0; step < 10; ++step) {
    solver.advance(1e-3);
    const double now = energy();
    EXPECT_LT(now, last);
    last = now;
  }
  EXPECT_LT((momentum() - before).norm(), 1e-8 * before.norm());
}

/* Two particles see each other's motion along their line only: D = 1 + h w / d with w the speed at which they part, and
 *   m / 2 (w - w0) + 2 V0 (lambda + 2 mu) log(D) / D h / d = 0. */
TEST(ImplicitStep, ParticlePairHasItsClosedForm) {
  const double h = 1e-3, d = 0.012, parting = 3;
  ImplicitStep::Settings settings;
  settings.gravity.setZero();
  settings.fewest_neighbours = 1;
  settings.gradient_cutoff = 1e-3;
  settings.tolerance = 1e-12;
  const Material<double> material = rubber(1e5);
  ImplicitStep solver(settings, material);
  Vectors positions = Vectors::Zero(3, 2), velocities = positions;
  positions(0, 1) = d;
  velocities(0, 0) = -parting / 2;
  velocities(0, 1) = parting / 2;
  solver.add_particles(positions, velocities, volume);
  solver.advance(h);
  const auto force = [&](double w) {
    const double D = 1 + h * w / d;
    return material.density * volume / 2 * (w - parting) +
           2 * volume * (material.lame_lambda + 2 * material.shear_modulus) * std::log(D) / D * h / d;
  };
  double low = -parting, high = parting;
  for (int halving = 0; halving < 60; ++halving) (force((low + high) / 2) > 0 ? high : low) = (low + high) / 2;
  const Vectors moved = solver.positions_by_id();
  EXPECT_LT(low, 0.8 * parting);
  EXPECT_NEAR((moved.col(1) - moved.col(0)).norm(), d + h * low, 1e-12);
}

/* At a step so short that one iteration of the method comes close to the solution. */
TEST(ImplicitStep, IsWhatTheMethodConvergesToAtShortSteps) {
  const double h = 1e-4;
  Settings method;
  method.gravity[1] = -9.81;
  method.iterations = 100;
  method.velocity_smoothing = 0;
  method.minimum_distance = 0;
  method.hencky_bound = 10;
  ImplicitStep::Settings exact;
  exact.zero_energy_stiffness = 0;
  const Material<double> material = rubber(2e4);
  ScalarSolver<double> iterative(method, material);
  ImplicitStep solver(exact, material);
  const Vectors points = box({0, 0, 0}, {5, 5, 5}, 0.12);
  std::vector<float> positions, velocities;
  for (Eigen::Index p = 0; p < points.cols(); ++p)
    for (int axis = 0; axis < 3; ++axis) {
      positions.push_back(float(points(axis, p)));
      velocities.push_back(float((axis == 0 ? 20 : 5) * points(0, p))); // m/s: stretched and sheared
    }
  iterative.add_particles(positions.data(), velocities.data(), positions.size() / 3, volume);
  const auto doubles = [](const std::vector<float> &values) {
    return Vectors(
        Eigen::Map<const Eigen::Matrix<float, 3, Eigen::Dynamic>>(values.data(), 3, Eigen::Index(values.size() / 3))
            .cast<double>());
  };
  solver.add_particles(doubles(positions), doubles(velocities), volume);
  for (int step = 0; step < 20; ++step) {
    iterative.substep(h);
    solver.advance(h);
  }
  const Vectors free = doubles(positions) + 20 * h * doubles(velocities), moved = solver.positions_by_id();
  Vectors other = moved;
  for (std::size_t p = 0; p < iterative.particles().size(); ++p)
    other.col(Eigen::Index(iterative.particles().ids[p])) = iterative.particles().positions[p];
  const double answered = (moved - free).norm();
  RecordProperty("difference", std::to_string((other - moved).norm() / answered));
  EXPECT_GT(answered, 0.05 * (20 * h * doubles(velocities)).norm());
  EXPECT_LT((other - moved).norm(), 0.01 * answered);
}

double settled_drop(int increments, bool dynamic) {
  ImplicitStep::Settings settings;
  settings.tolerance = 1e-7;
  ImplicitStep beam(settings, rubber(6e4));
  const Vectors free = box({0, 0, 0}, {8, 3, 3}, 0.12), held = box({-2, 0, 0}, {0, 3, 3}, 0.12, 2);
  beam.add_particles(free, Vectors::Zero(3, free.cols()), volume);
  beam.add_particles(held, Vectors::Zero(3, held.cols()), volume, true);
  if (dynamic)
    for (int step = 0; step < 60; ++step) beam.advance(0.02); // implicit Euler damps what sways in that time
  else
    beam.settle(increments, 100);
  return (free - beam.positions_by_id().leftCols(free.cols())).row(1).rightCols(9).mean();
}

TEST(ImplicitStep, SettlesWhereMotionEnds) {
  const double coarse = settled_drop(4, false), fine = settled_drop(8, false), swayed = settled_drop(0, true);
  RecordProperty("coarse", std::to_string(coarse / fine));
  RecordProperty("swayed", std::to_string(swayed / fine));
  EXPECT_GT(fine, 0.01);
  EXPECT_NEAR(coarse / fine, 1, 0.02);
  EXPECT_NEAR(swayed / fine, 1, 0.02);
}

} // namespace
