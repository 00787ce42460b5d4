// The Jacobi form of the inelastic solve, in two gathers, so that no list of "who writes to me" is needed.
//
//   JacobiImpulse   every particle computes its impulse tensor dT_p from the velocities before the iteration, and keeps dT_p L_p and its own
//                   velocity change - w_p dT_p s_p
//   JacobiApply     every particle sums what its neighbours' impulses do to it: w_p dT_b G_bp with G_bp = V_p L_b grad W(x_p - x_b), so
//                   w_p V_p (dT_b L_b) grad W, where the raw gradient is computed anew
//
// Stability: masses are split among the constraints that move them (Tonge, Benevolenski, Voroshilov 2012): each constraint sees the
// inverse masses times the number of constraints that share the particle, so the sum of all changes never overshoots.
#pragma once

#include "kernels/inelastic/solve_inelastic.h"
#include "kernels/neighbours/smoothing_kernel.h"

namespace loam {

// Per particle, three rows: the columns of dT L, and in their fourth components the particle's own velocity change.
struct JacobiRows {
  Row *column[3];
};

template <class Law, class Multiplier> struct JacobiImpulse {
  Law law;
  StrainLimit limit;
  float substep;
  const float *corrections; // 6 a particle: L
  JacobiRows rows;

  template <class Team> LOAM_FN void operator()(Team &team, typename Team::Item p) const {
    using Real = typename Team::Real;
    const Vec4<Real> own = team.velocity(p);
    const Constraint<Real> c = gather_constraint(team, p, substep, own.xyz());
    Real state[Multiplier::state_count];
    for (int i = 0; i < Multiplier::state_count; ++i) state[i] = team.field(p, Record::multiplier + i);
    const Mat3<Real> dT = Multiplier::impulse(law, limit, c, state);
    for (int i = 0; i < Multiplier::state_count; ++i) team.set_field(p, Record::multiplier + i, state[i]);

    Real l[6];
    for (int i = 0; i < 6; ++i) l[i] = team.own_value(p, corrections, 6, i);
    const Mat3<Real> product = dT * full(Sym3<Real>{l[0], l[1], l[2], l[3], l[4], l[5]});
    const Vec3<Real> change = own.w * (dT * c.gradient_sum);
    const Real zero(0.0f), components[3] = {zero - change.x, zero - change.y, zero - change.z};
    for (int j = 0; j < 3; ++j)
      team.set_own_row(p, rows.column[j], {product.m[0][j], product.m[1][j], product.m[2][j], components[j]});
  }
};

struct JacobiApply {
  JacobiRows rows;
  const Row *positions; // fourth component: volume
  SmoothingKernel kernel;

  template <class Team> LOAM_FN void operator()(Team &team, typename Team::Item p) const {
    using Lane = typename Team::Lane;
    using Real = typename Team::Real;
    const Vec4<Real> own = team.velocity(p), x = team.own_row(p, positions);
    Vec3<Lane> sum = {Lane(0.0f), Lane(0.0f), Lane(0.0f)};
    const Vec3<Lane> center = team.spread(x.xyz());
    for (auto k : team.unweighted_neighbours(p)) {
      const Vec3<Lane> d = center - team.neighbour_row(k, positions).xyz();
      const Vec3<Lane> g = kernel.gradient_factor(square_root(dot(d, d))) * d;
      const Vec3<Lane> a = team.neighbour_row(k, rows.column[0]).xyz(), b = team.neighbour_row(k, rows.column[1]).xyz(),
                       c = team.neighbour_row(k, rows.column[2]).xyz();
      sum = sum + ((g.x * a) + ((g.y * b) + (g.z * c)));
    }
    const Vec3<Real> gathered = (own.w * x.w) * team.sum(sum);
    const Vec3<Real> change = {team.own_row(p, rows.column[0]).w, team.own_row(p, rows.column[1]).w,
                               team.own_row(p, rows.column[2]).w};
    const Vec3<Real> u = own.xyz() + change + gathered;
    team.set_velocity(p, {u.x, u.y, u.z, own.w});
  }
};

} // namespace loam
