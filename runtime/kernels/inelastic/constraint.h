// What a visit of an inelastic constraint knows, and what it answers. The gather that fills it in serves every multiplier form.
#pragma once

#include "kernels/inelastic/kinematics.h"
#include "kernels/inelastic/non_affine.h"
#include "kernels/inelastic/record.h"
#include "math/tensor_functions.h"

namespace loam {

template <class Real> struct Constraint {
  Sym3<Real> trial;           // b - I of the trial elastic strain, D b D^T - I
  Mat3<Real> H;               // D = I + H
  Sym3<Real> gradient_square; // M
  Vec3<Real> gradient_sum;    // s
  Real inverse_mass;          // w_p
  Real inverse_volume;        // 1 / V0
  Real history;
  Vec3<Real> unknown;           // directions, see kinematics.h
  float substep;                // h
  NonAffineMotion<Real> motion; // where the form resists zero-energy modes
};

// The impulses of one visit: v_b += w_b dT G_b, v_p -= w_p dT s, and along the non-affine motion v_b -= w_b phi_b dl, v_p += w_p (sum phi) dl.
template <class Real> struct Impulse {
  Mat3<Real> tensor;
  Vec3<Real> along_drift; // dl, where the form resists zero-energy modes
};

// The same as the walk over the neighbours uses it: v_b += w_b (tensor G_b - |G_b|^2 along), v_p += w_p own.
template <class Real> struct SpreadImpulse {
  Mat3<Real> tensor;
  Vec3<Real> along, own;
};
template <bool NonAffine, class Real>
LOAM_FN SpreadImpulse<Real> spread_impulse(const Impulse<Real> &impulse, const Constraint<Real> &c) {
  SpreadImpulse<Real> result;
  if constexpr (NonAffine) {
    result.tensor = restrict_impulse(impulse.tensor + outer(impulse.along_drift, c.motion.moment), c.unknown);
    result.along = c.motion.scale * impulse.along_drift;
    // without any gradient kappa is 0, and nothing balances the own share
    const auto held = c.motion.scale > Real(0.0f);
    const Vec3<Real> own = result.tensor * c.gradient_sum;
    result.own = select(held, impulse.along_drift, Vec3<Real>{Real(0.0f), Real(0.0f), Real(0.0f)}) - own;
  } else {
    result.tensor = restrict_impulse(impulse.tensor, c.unknown);
    result.own = Real(-1.0f) * (result.tensor * c.gradient_sum);
  }
  return result;
}

// Squares of what the next visit would change and of what it would change it to, for the residual.
template <class Real> struct Residual { Real change, value; };

// The velocity gradient's step H and, where asked for, the drift: one walk over the neighbours.
template <bool NonAffine, class Team>
LOAM_FN void gather_motion(Team &team, typename Team::Item p, float substep, Vec3<typename Team::Real> own,
                           Vec3<typename Team::Real> gradient_sum, Vec3<typename Team::Real> unknown,
                           Mat3<typename Team::Real> &H, NonAffineMotion<typename Team::Real> &motion) {
  using Lane = typename Team::Lane;
  using Real = typename Team::Real;
  if constexpr (!NonAffine) {
    H = complete_gradient(velocity_gradient_step(team, p, substep, own, gradient_sum), unknown);
  } else {
    Mat3<Lane> sum = zero_matrix<Lane>();
    const Lane zero(0.0f);
    Vec3<Lane> weighted = {zero, zero, zero};
    for (auto k : team.neighbours(p)) {
      const Vec3<Lane> v = team.neighbour_velocity(k).xyz(), g = team.gradient(k);
      add_outer(sum, v, g);
      weighted = weighted + dot(g, g) * v;
    }
    H = complete_gradient(Real(substep) * (team.sum(sum) - outer(own, gradient_sum)), unknown);
    motion.moment = team.vector(p, Record::weight_moment);
    motion.scale = team.field(p, Record::weight_scale);
    motion.response = team.field(p, Record::drift_response);
    motion.drift =
        advance_drift(team.vector(p, Record::drift), H, Real(substep), own, team.sum(weighted), motion.moment, motion.scale);
  }
}

// Gathers what a visit needs from the team's record and the neighbours' velocities.
template <bool NonAffine, class Team>
LOAM_FN Constraint<typename Team::Real> gather_constraint(Team &team, typename Team::Item p, float substep,
                                                          Vec3<typename Team::Real> own) {
  Constraint<typename Team::Real> c;
  c.gradient_sum = team.vector(p, Record::gradient_sum);
  c.unknown = team.vector(p, Record::unknown);
  gather_motion<NonAffine>(team, p, substep, own, c.gradient_sum, c.unknown, c.H, c.motion);
  c.trial = advance_strain(team.symmetric(p, Record::strain), c.H);
  c.gradient_square = team.symmetric(p, Record::gradient_square);
  c.inverse_mass = team.field(p, Record::inverse_mass);
  c.inverse_volume = team.field(p, Record::inverse_volume);
  c.history = team.field(p, Record::history);
  c.substep = substep;
  return c;
}

// One visit's impulses by a multiplier form, whose state is kept in the record.
template <class Multiplier, class Law, class Team>
LOAM_FN Impulse<typename Team::Real> visit_constraint(const Multiplier &multiplier, const Law &law, StrainLimit limit,
                                                      Team &team, typename Team::Item p,
                                                      const Constraint<typename Team::Real> &c) {
  typename Team::Real state[Multiplier::state_count];
  for (int i = 0; i < Multiplier::state_count; ++i) state[i] = team.field(p, Record::multiplier + i);
  const Impulse<typename Team::Real> impulse = multiplier.visit(law, limit, c, state);
  for (int i = 0; i < Multiplier::state_count; ++i) team.set_field(p, Record::multiplier + i, state[i]);
  return impulse;
}

} // namespace loam
