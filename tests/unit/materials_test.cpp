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

/* The factor on both moduli. */
double stiffness(const loam_material_def &def, double history) {
  return def.law == LOAM_LAW_STOMAKHIN_SNOW ? std::exp(-double(def.hardening_factor) * history) : 1;
}

constexpr double substep = 1e-3;

/* p0 over K of NACC. */
double nacc_size(const loam_material_def &def, double alpha) {
  return 1e-5 + std::sinh(double(def.hardening_factor) * std::max(-alpha, 0.0));
}
Vector project_nacc(const loam_material_def &def, const Vector &e, double alpha) {
  const Lame lame = lame_of(def);
  const double beta = double(def.cohesion_ratio), M = double(def.critical_state_slope), p = -e.sum();
  double size = nacc_size(def, alpha);
  if (p > size) { // the tip and alpha together, by bisection
    double low = alpha - 1, high = alpha;
    for (int k = 0; k < 100; ++k) {
      const double middle = (low + high) / 2;
      (middle - alpha + p - nacc_size(def, middle) > 0 ? high : low) = middle;
    }
    size = nacc_size(def, low);
    return Vector::Constant(-size / 3);
  }
  if (p < -beta * size) return Vector::Constant(beta * size / 3);
  const Vector dev = e.array() - e.sum() / 3;
  const double q = std::sqrt(1.5) * 2 * lame.mu * dev.norm() / lame.bulk();
  const double most = M * std::sqrt((p + beta * size) * (size - p) / (1 + 2 * beta));
  return (dev * std::min(1.0, most / q)).array() + e.sum() / 3;
}
/* |dev e| after a substep of flow, by bisection. */
double herschel_bulkley_norm(const loam_material_def &def, double norm, double share = 1) {
  const double mu = lame_of(def).mu, n = double(def.flow_exponent);
  const double bound = std::sqrt(2.0) * double(def.shear_yield_stress) / (2 * mu);
  const double eta = std::pow(2, (n + 1) / 2) * double(def.consistency) / (2 * mu);
  if (norm <= bound) return norm;
  double low = bound, high = norm;
  for (int k = 0; k < 100; ++k) {
    const double middle = (low + high) / 2;
    (middle - bound > eta * std::pow((norm - middle) / (share * substep), n) ? high : low) = middle;
  }
  return low;
}

/* The return mappings once more, in double, on principal strains. */
Vector project(const loam_material_def &def, Vector e, double history) {
  const Lame lame = lame_of(def);
  const Vector dev = e.array() - e.sum() / 3;
  if (def.law == LOAM_LAW_VON_MISES) {
    const double hardening = double(def.hardening_modulus),
                 over = 2 * lame.mu * std::sqrt(1.5) * dev.norm() - double(def.yield_stress) - hardening * history;
    const double strain = std::max(0.0, over / (3 * lame.mu + hardening)); // equivalent plastic
    return (dev * (1 - std::sqrt(1.5) * strain / dev.norm())).array() + e.sum() / 3;
  }
  if (def.law == LOAM_LAW_NACC) return project_nacc(def, e, history);
  if (def.law == LOAM_LAW_HERSCHEL_BULKLEY)
    return (dev * (herschel_bulkley_norm(def, dev.norm()) / dev.norm())).array() + e.sum() / 3;
  if (def.law == LOAM_LAW_STOMAKHIN_SNOW)
    return e.cwiseMax(std::log(1 - double(def.critical_compression))).cwiseMin(std::log(1 + double(def.critical_stretch)));
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
  const double factor = stiffness(def, history);
  const Lame lame = {factor * lame_of(def).mu, factor * lame_of(def).lambda};
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
        std::visit([&](const auto &law) { return respond(law, strain_limit(2), trial, H, float(history), float(substep)); },
                   make_law(def));
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

TEST(Materials, HardeningVonMisesResponseWhileYielding) {
  loam_material_def def = default_material(LOAM_LAW_VON_MISES);
  def.yield_stress = 1e4f;
  def.hardening_modulus = 2e5f;
  for (const double history : {0.0, 0.05}) {
    const Errors errors = response_errors(def, 0.05, 0.03, 0, history);
    EXPECT_GT(errors.yielding, 300);
    EXPECT_LT(errors.value, 1e-5);
    EXPECT_LT(errors.derivative, 1e-4);
  }
}

TEST(Materials, NaccResponseInAllItsCases) {
  loam_material_def def = default_material(LOAM_LAW_NACC);
  def.hardening_factor = 10;
  for (const double alpha : {-0.01, -0.002})
    for (const double volume : {-0.03, 0.0, 0.02}) { // mostly to the compressive tip, onto the side, to the tensile tip
      const Errors errors = response_errors(def, 0.03, 0.02, volume, alpha);
      EXPECT_GT(errors.yielding, 100) << volume;
      EXPECT_LT(errors.value, 1e-4) << volume;
      // The volume that a tip discards enters the ratio of stretches to third order only.
      EXPECT_LT(errors.derivative, 2e-3) << volume;
    }
}

TEST(Materials, HerschelBulkleyResponseWhileFlowing) {
  for (const float n : {0.3f, 1.0f, 3.0f}) {
    loam_material_def def = default_material(LOAM_LAW_HERSCHEL_BULKLEY);
    def.youngs_modulus = 1e6f;
    def.shear_yield_stress = 5e3f;
    def.flow_exponent = n;
    def.consistency = 1e4f / std::pow(50.0f, n); // as much again at 50 / s
    const Errors errors = response_errors(def, 0.05, 0.03, 0);
    EXPECT_GT(errors.yielding, 300) << n;
    EXPECT_LT(errors.value, 1e-5) << n;
    EXPECT_LT(errors.derivative, 1e-4) << n;
  }
}

TEST(Materials, StomakhinSnowResponseInTheBoxAndBeyond) {
  loam_material_def def = default_material(LOAM_LAW_STOMAKHIN_SNOW);
  def.youngs_modulus = 1e6f;
  for (const double history : {0.0, -0.1, 0.1}) {
    const Errors errors = response_errors(def, 0.02, 0.01, 0, history);
    EXPECT_GT(errors.yielding, 300) << history;
    EXPECT_LT(errors.value, 1e-4) << history;
    EXPECT_LT(errors.derivative, 1e-3) << history;
  }
}

/* Within the iterations only a share of the modulus answers to plastic strain, and what appears as plastic strain is the change over the share. */
TEST(Materials, PlasticStrainIsTheChangeOverTheShare) {
  loam_material_def metal = default_material(LOAM_LAW_VON_MISES), foam = default_material(LOAM_LAW_HERSCHEL_BULKLEY),
                    clay = default_material(LOAM_LAW_NACC);
  metal.hardening_modulus = 2e5f;
  foam.youngs_modulus = 1e6f;
  for (const float share : {1.0f, 0.3f, 0.01f}) {
    const Flow<float> flow = {float(substep), share, share};
    const auto hard = std::get<VonMisesHardening>(make_law(metal)).map(0.0f, 0.04f, 0.01f, flow);
    const double strain = std::sqrt(2.0 / 3) * (1 - double(hard.scale)) * 0.04 / double(share);
    EXPECT_NEAR(double(hard.history), 0.01 + strain, 1e-6 + 1e-5 * strain) << share;
    const double stress = 2 * lame_of(metal).mu * std::sqrt(1.5) * 0.04 * double(hard.scale);
    EXPECT_NEAR(stress, 5e3 + 2e5 * double(hard.history), 1e-4 * stress) << share;
    for (const float n : {0.3f, 1.0f, 3.0f}) {
      foam.flow_exponent = n;
      foam.consistency = 1e4f / std::pow(50.0f, n);
      const auto flowed = std::get<HerschelBulkley>(make_law(foam)).map(0.0f, 0.1f, 0.0f, flow);
      EXPECT_NEAR(0.1 * double(flowed.scale), herschel_bulkley_norm(foam, 0.1f, double(share)), 1e-6) << n << " " << share;
    }
    const auto crushed = std::get<Nacc>(make_law(clay)).map(-0.1f, 0.01f, -0.002f, flow);
    EXPECT_EQ(crushed.scale, 0.0f);
    EXPECT_NEAR(double(crushed.trace), -nacc_size(clay, double(crushed.history)), 1e-6) << share;
    EXPECT_NEAR(double(crushed.history), -0.002 + (-0.1 - double(crushed.trace)) / double(share), 1e-5) << share;
  }
}

TEST(Materials, NaccThatIsLooseTakesVolumeUntilItIsDense) {
  const Nacc law = std::get<Nacc>(make_law(default_material(LOAM_LAW_NACC)));
  const Flow<float> flow = {float(substep), 1, 1};
  const Mapped<float> still_loose = law.map(-0.02f, 0.0f, 0.05f, flow);
  EXPECT_NEAR(still_loose.trace, -1e-5f, 1e-8f);
  EXPECT_NEAR(still_loose.history, 0.03f, 2e-5f);
  const Mapped<float> dense = law.map(-0.07f, 0.0f, 0.05f, flow);
  EXPECT_NEAR(double(dense.trace) + double(dense.history), -0.02, 1e-6);
  EXPECT_LT(dense.history, 0);
}

TEST(Materials, HistoriesStayBoundedAndFinite) {
  const float infinity = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
  const Flow<float> flow = {float(substep), 1, 1};
  loam_material_def metal = default_material(LOAM_LAW_VON_MISES);
  metal.hardening_modulus = 1e5f;
  for (const loam_material_def &def : {metal, default_material(LOAM_LAW_NACC), default_material(LOAM_LAW_HERSCHEL_BULKLEY)})
    std::visit(
        [&](const auto &law) {
          if constexpr (std::remove_cvref_t<decltype(law)>::plastic && !std::remove_cvref_t<decltype(law)>::principal)
            for (const float trace : {-1.5f, 0.0f, 1.5f})
              for (const float norm : {0.0f, 1e-20f, 0.7f}) {
                const Mapped<float> mapped = law.map(trace, norm, law.initial_history(), flow);
                EXPECT_LE(std::fabs(mapped.trace), 1.5f);
                EXPECT_GE(mapped.scale, 0.0f);
                EXPECT_LE(mapped.scale, 1.0f);
                EXPECT_LE(std::fabs(mapped.history), 1.0f);
              }
        },
        make_law(def));
  const StomakhinSnow snow = std::get<StomakhinSnow>(make_law(default_material(LOAM_LAW_STOMAKHIN_SNOW)));
  for (const float history : {-0.9f, 0.0f, 9.0f, infinity, -infinity, nan}) {
    EXPECT_GE(snow.stiffness(history), 0.0497f);
    EXPECT_LE(snow.stiffness(history), 20.1f);
  }
}

TEST(Materials, ResponseAtRestIsZeroAndFinite) {
  for (std::uint32_t law = 0; law <= LOAM_LAW_STOMAKHIN_SNOW; ++law) {
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
    const Matrix dT = test::widen(ScalarMultiplier().visit(law, strain_limit(2), c, state).tensor);
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
