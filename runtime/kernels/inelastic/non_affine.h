// Motion that a velocity gradient does not see, and what resists it.
//
// A particle's stress answers to the velocity gradient of its neighbourhood. A zig-zag of neighbours has none: it costs no energy, and disordered matter
// escapes into it, so bodies depend on the lattice that they were sampled on and yield too early. The part of a particle's motion that no linear field
// explains is
//
//   n_p = sum_b phi_b (v_p - v_b),   phi_b = kappa |G_b|^2 - m . G_b,
//
// with G_b the corrected kernel gradients, kappa = 1 / sum_b |G_b|^2 and m = kappa sum_b |G_b|^2 (x_b - x_p). Since sum_b G_b (x_b - x_p)^T = I, n_p is 0
// for every linear velocity field, and an impulse along n_p, phi_b of it against each neighbour, changes neither momentum (the shares sum up) nor
// angular momentum (sum_b phi_b (x_b - x_p) = 0). The displacement that n_p adds up to, the drift u_p, is state like the strain: it turns with the matter,
// and has the energy
//
//   V0 mu stiffness |u_p|^2 / r^2,
//
// that of a deviatoric strain of norm sqrt(stiffness) |u_p| / r. Where matter yields, the drift is scaled back with the strain. It takes only a small share in the
// yield criterion: enough to be bounded where nothing else strains the matter; with a full one it would use up the strength that the strain should show.
// All of it is independent of the substep and vanishes under refinement like r^2.
#pragma once

#include "math/matrix.h"

namespace loam {

// Of the drift's squared strain in the yield criterion. When a block (jitter 0.2, stiffness 1) was compressed between smooth platens by a logarithmic
// strain of 1.1, the lid carried 0.75 of the yield stress with 1, 0.81 with 0.1, 0.62 without any drift.
constexpr float drift_share = 0.1f;

// What one visit knows of its particle's non-affine motion.
template <class Real> struct NonAffineMotion {
  Vec3<Real> drift;  // u at the end of the substep, for the velocities of the visit
  Vec3<Real> moment; // m
  Real scale;        // kappa
  Real response;     // nu: the drift's change over its impulse is - h nu
};

// The drift after a substep of length h: turned by the spin of H = h grad v, without change of its length, and moved by the non-affine velocity.
// `weighted_sum` is sum_b |G_b|^2 v_b.
template <class T>
LOAM_FN Vec3<T> advance_drift(Vec3<T> drift, const Mat3<T> &H, T substep, Vec3<T> own, Vec3<T> weighted_sum, Vec3<T> moment,
                              T scale) {
  const T half(0.5f), one(1.0f), tiny(1e-30f);
  const Vec3<T> spin = {half * (H.m[2][1] - H.m[1][2]), half * (H.m[0][2] - H.m[2][0]), half * (H.m[1][0] - H.m[0][1])};
  const Vec3<T> turned = drift + cross(spin, drift);
  const T shrink = square_root(dot(drift, drift) / maximum(dot(turned, turned), tiny));
  const Vec3<T> displacement = substep * (own - scale * weighted_sum) + H * moment;
  return minimum(shrink, one) * turned + displacement;
}

} // namespace loam
