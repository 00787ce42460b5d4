// The multiplier form of the XPBI paper: one scalar Lagrange multiplier a particle for the constraint C = sqrt(2 psi(F)).
//
// A multiplier form is a type with
//   state_count                              floats a particle that live through a substep
//   non_affine                               whether it resists zero-energy modes
//   visit(law, limit, constraint, state)     the impulses of one visit
//   residual(law, limit, constraint, state)  how far the state is from where visits end
// and is a template argument of the solve stages. The other form, the projected impulse tensor, sits beside this file.
#pragma once

#include "kernels/inelastic/constraint.h"
#include "kernels/inelastic/deformation.h"
#include "kernels/materials/project.h"

namespace loam {

// Value and derivative of C at the projected strain: A = dC/dF F^nT = tau D^-T / C, with each principal stress times the ratio of trial to
// projected stretch where the return mapping moved it.
template <class Real> struct ConstraintResponse {
  Real value;
  Mat3<Real> derivative;
};

template <class Law, class Real>
LOAM_FN ConstraintResponse<Real> respond(const Law &law, StrainLimit limit, Sym3<Real> trial, const Mat3<Real> &H,
                                         Real history, float substep) {
  const Real third(1.0f / 3.0f), half(0.5f), zero(0.0f), one(1.0f);
  auto limited = zero > zero;
  const HenckyStrain<Real> strain = hencky_strain(trial, limit, limited);
  const HenckyStrain<Real> elastic = {law.elastic_trace(strain.trace, history), strain.deviator};
  const HenckyStrain<Real> projected = project(law, elastic, zero, history, Flow<Real>{substep, one, one}).strain;

  const Real stiffness = law.stiffness(history);
  const Real twice_mu = Real(law.twice_mu()) * stiffness, bulk = Real(law.bulk()) * stiffness;
  const Real deviator_squared = frobenius_squared(projected.deviator), trace_squared = projected.trace * projected.trace;
  const Real value = square_root(twice_mu * deviator_squared + bulk * trace_squared);
  // dC/dF is 0/0 at C = 0: strains below 1e-7 carry no constraint.
  const auto strained = deviator_squared + third * trace_squared > Real(1e-14f);
  const Real reciprocal = select(strained, one / select(strained, value, one), zero);

  Sym3<Real> tau = add_diagonal((twice_mu * reciprocal) * projected.deviator, bulk * projected.trace * reciprocal);
  if constexpr (Law::plastic) {
    // times exp(trial - projected): the deviator by its series, the trace to third order
    const Sym3<Real> E = expm1_traceless(strain.deviator + (zero - one) * projected.deviator);
    const Real t = (strain.trace - projected.trace) * third;
    tau = (one + t * (one + half * t * (one + third * t))) * (tau + multiply_commuting(tau, E));
  }
  return {select(strained, value, zero), full(tau) * deformation(H).inverse_transpose};
}

struct ScalarMultiplier {
  static constexpr bool non_affine = false;
  static constexpr int state_count = 1;

  // Equations 10 and 14 of the paper with the denominator in O(1): sum_b w_b |A G_b|^2 = tr(A M A^T), and the particle's own w_p |A s|^2.
  // (A stands for dC/dF F^nT here.) `state` is the multiplier lambda.
  template <class Law, class Real>
  LOAM_FN Impulse<Real> visit(const Law &law, StrainLimit limit, const Constraint<Real> &c,
                              Real (&state)[state_count]) const {
    const ConstraintResponse<Real> response = respond(law, limit, c.trial, c.H, c.history, c.substep);
    const Mat3<Real> &A = response.derivative;
    const Mat3<Real> AM = A * full(c.gradient_square);
    const Real h(c.substep);
    const Real compliance = c.inverse_volume / (h * h);
    Real denominator = compliance;
    for (int i = 0; i < 3; ++i)
      denominator = denominator + (A.m[i][0] * AM.m[i][0] + (A.m[i][1] * AM.m[i][1] + A.m[i][2] * AM.m[i][2]));
    const Vec3<Real> own = A * c.gradient_sum;
    denominator = denominator + c.inverse_mass * dot(own, own);
    const Real zero(0.0f);
    Real change = (zero - response.value - compliance * state[0]) / denominator;
    change = select(response.value > zero, change, zero);
    state[0] = state[0] + change;
    return {(change / h) * A, {}};
  }

  template <class Law, class Real>
  LOAM_FN Residual<Real> residual(const Law &law, StrainLimit limit, const Constraint<Real> &c,
                                  Real (&state)[state_count]) const {
    const Real value = respond(law, limit, c.trial, c.H, c.history, c.substep).value, h(c.substep);
    const Real residual = value + c.inverse_volume / (h * h) * state[0];
    return {residual * residual, value * value};
  }
};

} // namespace loam
