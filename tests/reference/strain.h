/* Kinematics of the elastic left Cauchy-Green tensor b, stored as its distance from the identity.
 *
 * Every law here is isotropic, so b = F F^T carries all that the deformation gradient F would. Stored as b - I, updated without ever adding
 * I, and read through log1p, a small strain keeps its relative precision in single precision as well. */
#pragma once

#include "material.h"

namespace loam::reference {

/* Bounds that keep the logarithm and the exponential finite whatever the velocities. */
inline constexpr double smallest_eigenvalue = -0.9999; // of b - I
inline constexpr double largest_eigenvalue = 1e4;

/* (I + H) b (I + H)^T - I from S = b - I:  S + H + H^T + HH^T + HS + S H^T + H S H^T. */
template <typename Real> Matrix3<Real> advance(const Matrix3<Real> &strain, const Matrix3<Real> &velocity_gradient_step) {
  const Matrix3<Real> &h = velocity_gradient_step;
  const Matrix3<Real> h_strain = h * strain;
  const Matrix3<Real> linear = h + h_strain; // its transpose is H^T + S H^T
  const Matrix3<Real> quadratic = (h + h_strain) * h.transpose();
  return strain + linear + linear.transpose() + quadratic;
}

/* Principal Hencky strains and directions. */
template <typename Real> struct PrincipalStrain {
  Vector3<Real> strain;
  Matrix3<Real> directions; // in columns
  bool clamped;
};

template <typename Real> PrincipalStrain<Real> principal_hencky_strain(const Matrix3<Real> &strain, Real bound) {
  Eigen::SelfAdjointEigenSolver<Matrix3<Real>> solver;
  solver.computeDirect(strain);
  PrincipalStrain<Real> principal;
  principal.directions = solver.eigenvectors();
  principal.clamped = false;
  for (int axis = 0; axis < 3; ++axis) {
    const Real eigenvalue = std::clamp(solver.eigenvalues()[axis], Real(smallest_eigenvalue), Real(largest_eigenvalue));
    const Real logarithm = std::log1p(eigenvalue) / 2;
    principal.strain[axis] = std::clamp(logarithm, -bound, bound);
    principal.clamped |= principal.strain[axis] != logarithm;
  }
  return principal;
}

/* V diag(values) V^T. */
template <typename Real> Matrix3<Real> compose(const Matrix3<Real> &directions, const Vector3<Real> &values) {
  const Matrix3<Real> scaled = directions * values.asDiagonal();
  return scaled * directions.transpose();
}

/* The b - I that has these principal Hencky strains. */
template <typename Real> Matrix3<Real> strain_from_hencky(const Matrix3<Real> &directions, const Vector3<Real> &hencky) {
  const Vector3<Real> eigenvalues(std::expm1(2 * hencky[0]), std::expm1(2 * hencky[1]), std::expm1(2 * hencky[2]));
  return compose(directions, eigenvalues);
}

/* (I + H)^-T, or the identity where I + H is close to singular or inverted: there the direction would blow up. */
template <typename Real> Matrix3<Real> inverse_transpose_of_step(const Matrix3<Real> &velocity_gradient_step) {
  const Matrix3<Real> step = Matrix3<Real>::Identity() + velocity_gradient_step;
  Matrix3<Real> cofactors;
  cofactors.col(0) = step.col(1).cross(step.col(2));
  cofactors.col(1) = step.col(2).cross(step.col(0));
  cofactors.col(2) = step.col(0).cross(step.col(1));
  const Real determinant = step.col(0).dot(cofactors.col(0));
  if (determinant < Real(0.05)) return Matrix3<Real>::Identity();
  return cofactors / determinant;
}

} // namespace loam::reference
