/* The elastic energy of every law here as a function of the deformation gradient, with its first two derivatives.
 *
 *   psi(F) = mu |e|^2 + lambda/2 tr(e)^2,   e_i = log s_i,   F = U diag(s) V^T
 * (Hencky 1928; Klar et al. 2016, section 6.1). First Piola-Kirchhoff stress P = U diag(tau_i / s_i) V^T with tau_i = 2 mu e_i + lambda tr(e). Its derivative by
 * F acts on A = U^T dF V componentwise (Stomakhin et al. 2012, "Energetically consistent invertible elasticity"):
 *   B_ii = sum_j psi_ij A_jj,   B_ij = a_ij A_ij + b_ij A_ji,   a +- b = (psi_i -+ psi_j) / (s_i -+ s_j),   dP = U B V^T. */
#pragma once

#include "material.h"

namespace loam::reference {

using Matrix9 = Eigen::Matrix<double, 9, 9>;

struct HenckySolid {
  double shear_modulus, lame_lambda;

  static HenckySolid from(const Material<double> &material) { return {material.shear_modulus, material.lame_lambda}; }
  static HenckySolid from_youngs_modulus(double youngs_modulus, double poissons_ratio);

  /* Infinite where F is inverted or flat. */
  double energy_density(const Matrix3<double> &F) const;

  /* P, for det F > 0. */
  Matrix3<double> stress(const Matrix3<double> &F) const;

  /* dP/dF on matrices column by column: entry (i + 3 j, k + 3 l) is dP_ij / dF_kl. `definite`: with negative eigenvalues set to 0. */
  Matrix9 stiffness(const Matrix3<double> &F, bool definite) const;
};

} // namespace loam::reference
