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
#include "kernels/neighbours/meetings.h"
#include "kernels/neighbours/smoothing_kernel.h"

namespace loam {

// Per particle: the columns of dT L, and in their fourth components the particle's own velocity change. Where zero-energy modes are resisted, three
// rows more: kappa dl and the six entries of L; otherwise null.
struct JacobiRows {
  Row *column[3];
  Row *along_drift[3];
};

template <class Law, class Multiplier> struct JacobiImpulse {
  Law law;
  StrainLimit limit;
  float substep;
  Multiplier multiplier;
  const float *corrections; // 6 a particle: L
  JacobiRows rows;

  template <class Team> LOAM_FN void operator()(Team &team, typename Team::Item p) const {
    using Real = typename Team::Real;
    const Real zero(0.0f);
    const Vec4<Real> own = team.velocity(p);
    const Constraint<Real> c = gather_constraint<Multiplier::non_affine>(team, p, substep, own.xyz());
    const auto impulse = spread_impulse<Multiplier::non_affine>(visit_constraint(multiplier, law, limit, team, p, c), c);

    Real l[6];
    for (int i = 0; i < 6; ++i) l[i] = team.own_value(p, corrections, 6, i);
    if constexpr (Multiplier::non_affine) {
      team.set_own_row(p, rows.along_drift[0], {impulse.along.x, impulse.along.y, impulse.along.z, l[0]});
      team.set_own_row(p, rows.along_drift[1], {l[1], l[2], l[3], l[4]});
      team.set_own_row(p, rows.along_drift[2], {l[5], zero, zero, zero});
    } else if (rows.along_drift[0] != nullptr) { // beside matter that has some
      for (int j = 0; j < 3; ++j) team.set_own_row(p, rows.along_drift[j], {zero, zero, zero, zero});
    }
    const Mat3<Real> product = impulse.tensor * full(Sym3<Real>{l[0], l[1], l[2], l[3], l[4], l[5]});
    const Real components[3] = {own.w * impulse.own.x, own.w * impulse.own.y, own.w * impulse.own.z};
    for (int j = 0; j < 3; ++j)
      team.set_own_row(p, rows.column[j], {product.m[0][j], product.m[1][j], product.m[2][j], components[j]});
  }
};

template <bool NonAffine> struct JacobiApply {
  JacobiRows rows;
  const Row *positions; // fourth component: volume
  SmoothingKernel kernel;
  Meetings meetings;

  template <class Team> LOAM_FN void operator()(Team &team, typename Team::Item p) const {
    using Lane = typename Team::Lane;
    using Real = typename Team::Real;
    const Vec4<Real> own = team.velocity(p), x = team.own_row(p, positions);
    Vec3<Lane> sum = {Lane(0.0f), Lane(0.0f), Lane(0.0f)};
    const Vec3<Lane> center = team.spread(x.xyz());
    const Lane volume = team.spread(x.w);
    for (auto k : team.unweighted_neighbours(p)) {
      const Vec3<Lane> d = center - team.neighbour_row(k, positions).xyz();
      Vec3<Lane> g = kernel.gradient_factor(square_root(dot(d, d))) * d;
      if (meetings.any()) g = meetings.shared(team, k) * g;
      const Vec3<Lane> a = team.neighbour_row(k, rows.column[0]).xyz(), b = team.neighbour_row(k, rows.column[1]).xyz(),
                       c = team.neighbour_row(k, rows.column[2]).xyz();
      sum = sum + ((g.x * a) + ((g.y * b) + (g.z * c)));
      if constexpr (NonAffine) {
        const Vec4<Lane> first = team.neighbour_row(k, rows.along_drift[0]),
                         second = team.neighbour_row(k, rows.along_drift[1]);
        const Lane last = team.neighbour_row(k, rows.along_drift[2]).x;
        const Vec3<Lane> G = Sym3<Lane>{first.w, second.x, second.y, second.z, second.w, last} * g; // over V_p
        sum = sum - (volume * dot(G, G)) * first.xyz();
      }
    }
    const Vec3<Real> gathered = (own.w * x.w) * team.sum(sum);
    const Vec3<Real> change = {team.own_row(p, rows.column[0]).w, team.own_row(p, rows.column[1]).w,
                               team.own_row(p, rows.column[2]).w};
    const Vec3<Real> u = own.xyz() + change + gathered;
    team.set_velocity(p, {u.x, u.y, u.z, own.w});
  }
};

} // namespace loam
