#include "hencky_solid.h"

#include <limits>

namespace loam::reference {

namespace {

/* F = left diag(stretch) right^T, for det F > 0. */
struct Stretches {
  Vector3<double> stretch, hencky;
  Matrix3<double> left, right;
};

Stretches stretches(const Matrix3<double> &F) {
  // From C - I, so that small strains keep their precision.
  const Matrix3<double> H = F - Matrix3<double>::Identity();
  const Eigen::SelfAdjointEigenSolver<Matrix3<double>> eigen(H + H.transpose() + H.transpose() * H);
  Stretches result;
  result.right = eigen.eigenvectors();
  for (int axis = 0; axis < 3; ++axis) result.hencky[axis] = std::log1p(eigen.eigenvalues()[axis]) / 2;
  result.stretch = result.hencky.array().exp();
  result.left = F * result.right * result.stretch.cwiseInverse().asDiagonal();
  return result;
}

/* (log a - log b) / (a - b). */
double slope_of_logarithm(double a, double b) {
  const double x = (a - b) / b;
  return (std::fabs(x) < 1e-4 ? 1 - x / 2 + x * x / 3 : std::log1p(x) / x) / b;
}

} // namespace

HenckySolid HenckySolid::from_youngs_modulus(double youngs_modulus, double poissons_ratio) {
  return {youngs_modulus / (2 * (1 + poissons_ratio)),
          youngs_modulus * poissons_ratio / ((1 + poissons_ratio) * (1 - 2 * poissons_ratio))};
}

double HenckySolid::energy_density(const Matrix3<double> &F) const {
  if (!(F.determinant() > 0)) return std::numeric_limits<double>::infinity();
  const Vector3<double> hencky = stretches(F).hencky;
  return shear_modulus * hencky.squaredNorm() + lame_lambda / 2 * hencky.sum() * hencky.sum();
}

Matrix3<double> HenckySolid::stress(const Matrix3<double> &F) const {
  const Stretches s = stretches(F);
  const Vector3<double> tau = 2 * shear_modulus * s.hencky + Vector3<double>::Constant(lame_lambda * s.hencky.sum());
  return s.left * tau.cwiseQuotient(s.stretch).asDiagonal() * s.right.transpose();
}

Matrix9 HenckySolid::stiffness(const Matrix3<double> &F, bool definite) const {
  const Stretches s = stretches(F);
  const double pressure = lame_lambda * s.hencky.sum();
  const auto clamped = [definite](double value) { return definite ? std::max(value, 0.0) : value; };

  Matrix3<double> diagonal; // psi_ij
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      diagonal(i, j) = lame_lambda / (s.stretch[i] * s.stretch[j]);
      if (i == j) diagonal(i, i) += (2 * shear_modulus * (1 - s.hencky[i]) - pressure) / (s.stretch[i] * s.stretch[i]);
    }
  if (definite) {
    const Eigen::SelfAdjointEigenSolver<Matrix3<double>> eigen(diagonal);
    diagonal = eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0).asDiagonal() * eigen.eigenvectors().transpose();
  }

  Matrix9 in_axes = Matrix9::Zero(); // of the principal stretches
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) in_axes(4 * i, 4 * j) = diagonal(i, j);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < i; ++j) {
      const double a = s.stretch[i], b = s.stretch[j];
      const double tau_a = 2 * shear_modulus * s.hencky[i] + pressure, tau_b = 2 * shear_modulus * s.hencky[j] + pressure;
      // (tau_a / a - tau_b / b) / (a - b), also where a = b.
      const double difference = clamped((2 * shear_modulus * b * slope_of_logarithm(a, b) - tau_b) / (a * b));
      const double sum = clamped((tau_a / a + tau_b / b) / (a + b));
      const int ij = i + 3 * j, ji = j + 3 * i;
      in_axes(ij, ij) = in_axes(ji, ji) = (difference + sum) / 2;
      in_axes(ij, ji) = in_axes(ji, ij) = (difference - sum) / 2;
    }

  Matrix9 to_axes; // of dF, to U^T dF V
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k)
        for (int l = 0; l < 3; ++l) to_axes(i + 3 * j, k + 3 * l) = s.left(k, i) * s.right(l, j);
  return to_axes.transpose() * in_axes * to_axes;
}

} // namespace loam::reference
