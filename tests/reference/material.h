/* The constitutive laws in principal Hencky strains e (logarithms of the elastic principal stretches).
 *
 * All share the Saint Venant-Kirchhoff energy in Hencky strain,
 *   psi(e) = mu |e|^2 + lambda/2 tr(e)^2,   Kirchhoff stress tau = 2 mu e + lambda tr(e) 1,
 * and differ in the return mapping that brings a trial strain back to the yield surface:
 *   Von Mises        |2 mu dev e| <= sqrt(2/3) yield stress; the deviator is scaled back (Simo 1992).
 *   Drucker-Prager   |2 mu dev e| <= alpha 3K (tip - tr e), a cone with alpha = sqrt(2/3) 2 sin(phi) / (3 - sin(phi))
 *                    (Klar et al. 2016); its tip lies at the volumetric strain c cot(phi) / K, and volume that expansion past the
 *                    tip created is given back before new pressure arises (Tampubolon et al. 2017). */
#pragma once

#include <algorithm>
#include <cmath>
#include <Eigen/Dense>
#include <loam/material.h>

namespace loam::reference {

template <typename Real> using Vector3 = Eigen::Matrix<Real, 3, 1>;
template <typename Real> using Matrix3 = Eigen::Matrix<Real, 3, 3>;

enum class Law { elastic, von_mises, drucker_prager };

/* What a return mapping gives: the strain on or inside the yield surface and the history variable that goes with it. */
template <typename Real> struct ReturnMapping {
  Vector3<Real> strain;
  Real volume_correction;
  bool yielded;
};

template <typename Real> struct Material {
  Law law = Law::elastic;
  Real density = 1000;
  Real shear_modulus = 0;      // mu
  Real lame_lambda = 0;        // lambda
  Real bulk_modulus = 0;       // K = lambda + 2 mu / 3
  Real yield_bound = 0;        // Von Mises: the Frobenius norm that |2 mu dev e| may reach
  Real cone_slope = 0;         // Drucker-Prager: alpha
  Real cone_tip = 0;           // Drucker-Prager: tr(e) at the tip of the cone
  bool corrects_volume = true; // Drucker-Prager: Tampubolon's correction

  static Material from(const loam_material_def &def) {
    Material material;
    const Real youngs_modulus = Real(def.youngs_modulus), poissons_ratio = Real(def.poissons_ratio);
    material.law = def.law == LOAM_LAW_VON_MISES        ? Law::von_mises
                   : def.law == LOAM_LAW_DRUCKER_PRAGER ? Law::drucker_prager
                                                        : Law::elastic;
    material.density = Real(def.density);
    material.shear_modulus = youngs_modulus / (2 * (1 + poissons_ratio));
    material.lame_lambda = youngs_modulus * poissons_ratio / ((1 + poissons_ratio) * (1 - 2 * poissons_ratio));
    material.bulk_modulus = material.lame_lambda + Real(2) / 3 * material.shear_modulus;
    material.yield_bound = std::sqrt(Real(2) / 3) * Real(def.yield_stress);
    const Real sine = std::sin(Real(def.friction_angle));
    material.cone_slope = std::sqrt(Real(2) / 3) * 2 * sine / (3 - sine);
    if (def.cohesion > 0)
      material.cone_tip =
          Real(def.cohesion) / (std::tan(std::max(Real(def.friction_angle), Real(1e-3))) * material.bulk_modulus);
    return material;
  }

  Vector3<Real> kirchhoff_stress(const Vector3<Real> &strain) const {
    return 2 * shear_modulus * strain + Vector3<Real>::Constant(lame_lambda * strain.sum());
  }

  Real energy_density(const Vector3<Real> &strain) const {
    const Real trace = strain.sum();
    return shear_modulus * strain.squaredNorm() + lame_lambda / 2 * trace * trace;
  }

  ReturnMapping<Real> project(const Vector3<Real> &trial, Real volume_correction) const {
    switch (law) {
    case Law::von_mises:
      return project_von_mises(trial);
    case Law::drucker_prager:
      return project_drucker_prager(trial, volume_correction);
    default:
      return {trial, Real(0), false};
    }
  }

private:
  static Vector3<Real> deviator(const Vector3<Real> &strain) { return strain - Vector3<Real>::Constant(strain.sum() / 3); }

  ReturnMapping<Real> project_von_mises(const Vector3<Real> &trial) const {
    const Vector3<Real> trial_deviator = deviator(trial);
    const Real stress = 2 * shear_modulus * trial_deviator.norm();
    if (stress <= yield_bound) return {trial, Real(0), false};
    return {trial - (1 - yield_bound / stress) * trial_deviator, Real(0), true};
  }

  ReturnMapping<Real> project_drucker_prager(const Vector3<Real> &trial, Real volume_correction) const {
    const Vector3<Real> strain = trial + Vector3<Real>::Constant(volume_correction / 3);
    const bool shifted = volume_correction != 0;
    const Real trace = strain.sum();
    if (trace >= cone_tip)
      return {Vector3<Real>::Constant(cone_tip / 3), corrects_volume ? trace - cone_tip : Real(0), true};
    const Vector3<Real> strain_deviator = deviator(strain);
    const Real length = strain_deviator.norm();
    const Real bound = cone_slope * 3 * bulk_modulus * (cone_tip - trace) / (2 * shear_modulus);
    if (length <= bound) return {strain, Real(0), shifted};
    return {strain - (1 - bound / length) * strain_deviator, Real(0), true};
  }
};

} // namespace loam::reference
