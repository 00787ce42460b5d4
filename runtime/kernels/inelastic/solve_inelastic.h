// One Gauss-Seidel visit of an inelastic constraint: line 8 to 12 of algorithm 1 of the XPBI paper.
//
// The text knows neither width nor machine. Teams of one colour run at once; the particles that two such teams write never overlap.
#pragma once

#include "kernels/inelastic/kinematics.h"
#include "kernels/inelastic/record.h"
#include "kernels/inelastic/scalar_multiplier.h"

namespace loam {

// Gathers what a visit needs from the team's record and the neighbours' velocities.
template <class Team>
LOAM_FN Constraint<typename Team::Real> gather_constraint(Team &team, typename Team::Item p, float substep,
                                                          Vec3<typename Team::Real> own) {
  Constraint<typename Team::Real> c;
  c.gradient_sum = team.vector(p, Record::gradient_sum);
  c.H = velocity_gradient_step(team, p, substep, own, c.gradient_sum);
  c.trial = advance_strain(team.symmetric(p, Record::strain), c.H);
  c.gradient_square = team.symmetric(p, Record::gradient_square);
  c.inverse_mass = team.field(p, Record::inverse_mass);
  c.inverse_volume = team.field(p, Record::inverse_volume);
  c.history = team.field(p, Record::history);
  c.substep = substep;
  return c;
}

template <class Law, class Multiplier> struct SolveInelastic {
  Law law;
  StrainLimit limit;
  float substep;

  template <class Team> LOAM_FN void operator()(Team &team, typename Team::Item p) const {
    using Lane = typename Team::Lane;
    using Real = typename Team::Real;
    const Vec4<Real> own = team.velocity(p);
    const Constraint<Real> c = gather_constraint(team, p, substep, own.xyz());

    Real state[Multiplier::state_count];
    for (int i = 0; i < Multiplier::state_count; ++i) state[i] = team.field(p, Record::multiplier + i);
    const Mat3<Real> dT = Multiplier::impulse(law, limit, c, state);
    for (int i = 0; i < Multiplier::state_count; ++i) team.set_field(p, Record::multiplier + i, state[i]);

    const Mat3<Lane> spread = team.spread(dT);
    for (auto k : team.neighbours(p)) {
      const Vec4<Lane> v = team.neighbour_velocity(k);
      const Vec3<Lane> u = v.xyz() + spread * (v.w * team.gradient(k));
      team.set_neighbour_velocity(k, {u.x, u.y, u.z, v.w});
    }
    const Vec3<Real> u = own.xyz() - own.w * (dT * c.gradient_sum);
    team.set_velocity(p, {u.x, u.y, u.z, own.w});
  }
};

} // namespace loam
