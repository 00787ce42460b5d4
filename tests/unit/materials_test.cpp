/* The laws' return mappings, and the response of a constraint against a finite difference in double precision. */
#include <cmath>
#include <gtest/gtest.h>

#include "kernels/inelastic/kinematics.h"
#include "kernels/inelastic/scalar_multiplier.h"
#include "scene/material.h"
#include "support/tensors.h"

namespace loam {
namespace {

using test::Matrix;
using test::RandomTensors;
using test::Vector;

struct Lame {
  double mu, lambda;
  double bulk() const { return lambda + 2 * mu / 3; }
};

Lame lame_of(const loam_material_def &def) {
  const double E = double(def.youngs_modulus), nu = double(def.poissons_ratio);
  return {E / (2 * (1 + nu)), E * nu / ((1 + nu) * (1 - 2 * nu))};
}

/* C = sqrt(2 psi) of the principal Hencky strains. */
double constraint_value(const Matrix &F, const Lame &lame) {
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(F * F.transpose());
  const Vector e = 0.5 * eigen.eigenvalues().array().log();
  return std::sqrt(2 * lame.mu * e.squaredNorm() + lame.lambda * e.sum() * e.sum());
}

/* The return mappings once more, in double, on principal strains. */
Vector project(const loam_material_def &def, Vector e, double history) {
  const Lame lame = lame_of(def);
  const Vector dev = e.array() - e.sum() / 3;
  if (def.law == LOAM_LAW_VON_MISES) {
    const double bound = std::sqrt(2.0 / 3) * double(def.yield_stress) / (2 * lame.mu);
    return (dev * std::min(1.0, bound / dev.norm())).array() + e.sum() / 3;
  }
  if (def.law == LOAM_LAW_DRUCKER_PRAGER) {
    const double sine = std::sin(double(def.friction_angle)), cosine = std::cos(double(def.friction_angle));
    const double alpha = std::sqrt(2.0 / 3) * 2 * sine / (3 - sine), slope = alpha * 3 * lame.bulk() / (2 * lame.mu);
    const double tip = double(def.cohesion) * cosine / sine / lame.bulk(), trace = e.sum() + history;
    if (trace >= tip) return Vector::Constant(tip / 3);
    return (dev * std::min(1.0, slope * (tip - trace) / dev.norm())).array() + trace / 3;
  }
  return e;
}

/* A = dC/dF F^nT, with dC/dF by central differences at the projected F. */
Matrix finite_difference(const loam_material_def &def, const Matrix &F_n, const Matrix &H, double history, double &value) {
  const Lame lame = lame_of(def);
  const Eigen::JacobiSVD<Matrix> svd((Matrix::Identity() + H) * F_n, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Vector projected = project(def, svd.singularValues().array().log(), history);
  const Matrix F = svd.matrixU() * projected.array().exp().matrix().asDiagonal() * svd.matrixV().transpose();
  value = constraint_value(F, lame);
  Matrix gradient;
  constexpr double step = 1e-7;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      Matrix up = F, down = F;
      up(i, j) += step;
      down(i, j) -= step;
      gradient(i, j) = (constraint_value(up, lame) - constraint_value(down, lame)) / (2 * step);
    }
  return gradient * F_n.transpose();
}

/* The worst relative errors of C and of A over random states. `volume` biases the trace of the strain. */
struct Errors {
  double value = 0, derivative = 0;
  int yielding = 0;
};
Errors response_errors(const loam_material_def &def, double strain, double step, double volume, double history = 0) {
  RandomTensors random(21);
  Errors errors;
  for (int k = 0; k < 400; ++k) {
    const Matrix F_n = (1 + volume) * (Matrix::Identity() + random.matrix(strain));
    const Mat3<float> H = test::narrow_full(random.matrix(step));
    const Matrix D = Matrix::Identity() + test::widen(H);
    const Sym3<float> trial = test::narrow(D * F_n * F_n.transpose() * D.transpose() - Matrix::Identity());
    double value = 0;
    const Matrix expected = finite_difference(def, F_n, test::widen(H), history, value);
    if (value < 0.5) continue; // strains of a hundredth of those tried: by the tip, all is cancellation
    const auto found =
        std::visit([&](const auto &law) { return respond(law, strain_limit(2), trial, H, float(history), 1e-3f); }, make_law(def));
    errors.value = std::max(errors.value, std::fabs(double(found.value) - value) / value);
    errors.derivative = std::max(errors.derivative, (test::widen(found.derivative) - expected).norm() / expected.norm());
    const Vector e =
        0.5 * Eigen::SelfAdjointEigenSolver<Matrix>(D * F_n * (D * F_n).transpose()).eigenvalues().array().log();
    errors.yielding += (project(def, e, history) - e).norm() > 1e-9 ? 1 : 0;
  }
  return errors;
}

TEST(Materials, ElasticResponseIsTheDerivativeOfTheEnergy) {
  const loam_material_def def = default_material(LOAM_LAW_ELASTIC);
  const Errors errors = response_errors(def, 0.08, 0.03, 0);
  EXPECT_LT(errors.value, 2e-6);
  EXPECT_LT(errors.derivative, 1e-5);
  EXPECT_EQ(errors.yielding, 0);
  EXPECT_LT(response_errors(def, 0.25, 0.05, 0).derivative, 1e-3); // through the eigen-decomposition
}

TEST(Materials, VonMisesResponseWhileYielding) {
  loam_material_def def = default_material(LOAM_LAW_VON_MISES);
  def.yield_stress = 2e4f;
  const Errors errors = response_errors(def, 0.05, 0.03, 0);
  EXPECT_GT(errors.yielding, 300);
  EXPECT_LT(errors.value, 1e-5);
  EXPECT_LT(errors.derivative, 1e-4);
}

TEST(Materials, DruckerPragerResponseWhileYielding) {
  const loam_material_def def = default_material(LOAM_LAW_DRUCKER_PRAGER);
  for (const double history : {0.0, 0.02}) {
    const Errors errors = response_errors(def, 0.05, 0.03, -0.02, history);
    EXPECT_GT(errors.yielding, 100);
    EXPECT_LT(errors.value, 2e-4); // near the tip by cancellation
    EXPECT_LT(errors.derivative, 2e-4);
  }
}

TEST(Materials, CohesiveDruckerPragerResponseUpToItsTip) {
  loam_material_def def = default_material(LOAM_LAW_DRUCKER_PRAGER);
  def.cohesion = 5e3f;
  const Errors errors = response_errors(def, 0.05, 0.03, -0.02);
  EXPECT_GT(errors.yielding, 100);
  EXPECT_LT(errors.value, 2e-4);
  // The volume that the tip discards enters the ratio of stretches to first order only: t^2 / 18 for a trace of t.
  EXPECT_LT(errors.derivative, 2e-3);
}

TEST(Materials, ResponseAtRestIsZeroAndFinite) {
  for (std::uint32_t law = 0; law <= LOAM_LAW_DRUCKER_PRAGER; ++law) {
    std::visit(
        [](const auto &l) {
          const auto response = respond(l, strain_limit(0.5), zero_symmetric<float>(), zero_matrix<float>(), 0.0f, 1e-3f);
          EXPECT_EQ(response.value, 0.0f);
          EXPECT_EQ(test::widen(response.derivative).norm(), 0);
        },
        make_law(default_material(law)));
  }
}

/* A step of the multiplier solves its own linearised equation: C + gradient . change + alpha~ lambda = 0. */
TEST(Materials, TheMultiplierMeetsItsLinearisedConstraint) {
  RandomTensors random(33);
  const Elastic law = std::get<Elastic>(make_law(default_material(LOAM_LAW_ELASTIC)));
  for (int k = 0; k < 200; ++k) {
    Constraint<float> c;
    c.H = test::narrow_full(random.matrix(0.02));
    c.trial = advance_strain(test::narrow(random.symmetric(random.vector(0.05))), c.H);
    c.gradient_square = test::narrow(random.symmetric({2e7, 3e7, 4e7}));
    c.gradient_sum = {20, -30, 10};
    c.inverse_mass = 600;
    c.inverse_volume = 1e6f;
    c.history = 0;
    c.substep = 1e-3f;
    float state[1] = {0.01f};
    const ConstraintResponse<float> before = respond(law, strain_limit(2), c.trial, c.H, c.history, c.substep);
    const Matrix dT = test::widen(ScalarMultiplier::impulse(law, strain_limit(2), c, state));
    // dv_b = w_b dT G_b, dv_p = -w_p dT s: the change of C is h A : (sum_b dv_b G_b^T - dv_p s^T)
    const Vector s(20, -30, 10);
    const Matrix change = dT * (test::widen(c.gradient_square) + 600.0 * s * s.transpose());
    const double alpha = 1e6 / 1e-6;
    const double residual =
        double(before.value) + 1e-3 * test::widen(before.derivative).cwiseProduct(change).sum() + alpha * double(state[0]);
    EXPECT_LT(std::fabs(residual), 1e-4 * (double(before.value) + alpha * 0.01));
  }
}

} // namespace
} // namespace loam
