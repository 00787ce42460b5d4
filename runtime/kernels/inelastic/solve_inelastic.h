// One Gauss-Seidel visit of an inelastic constraint: line 8 to 12 of algorithm 1 of the XPBI paper.
//
// The text knows neither width nor machine. Teams of one colour run at once; the particles that two such teams write never overlap.
#pragma once

#include "kernels/inelastic/constraint.h"
#include "kernels/materials/project.h"

namespace loam {

// A visit's impulses on the velocities of the particle, `own` before it, and of its neighbours.
template <bool NonAffine, class Team>
LOAM_FN void push_neighbours(Team &team, typename Team::Item p, const Vec4<typename Team::Real> &own,
                             const SpreadImpulse<typename Team::Real> &impulse) {
  using Lane = typename Team::Lane;
  using Real = typename Team::Real;
  const Mat3<Lane> tensor = team.spread(impulse.tensor);
  if constexpr (!NonAffine) {
    for (auto k : team.neighbours(p)) {
      const Vec4<Lane> v = team.neighbour_velocity(k);
      const Vec3<Lane> u = v.xyz() + tensor * (v.w * team.gradient(k));
      team.set_neighbour_velocity(k, {u.x, u.y, u.z, v.w});
    }
  } else {
    const Vec3<Lane> along = team.spread(impulse.along);
    for (auto k : team.neighbours(p)) {
      const Vec4<Lane> v = team.neighbour_velocity(k);
      const Vec3<Lane> g = team.gradient(k);
      const Vec3<Lane> u = v.xyz() + v.w * (tensor * g - dot(g, g) * along);
      team.set_neighbour_velocity(k, {u.x, u.y, u.z, v.w});
    }
  }
  const Vec3<Real> u = own.xyz() + own.w * impulse.own;
  team.set_velocity(p, {u.x, u.y, u.z, own.w});
}

template <class Law, class Multiplier> struct SolveInelastic {
  Law law;
  StrainLimit limit;
  float substep;
  Multiplier multiplier;

  template <class Team> LOAM_FN void operator()(Team &team, typename Team::Item p) const {
    using Real = typename Team::Real;
    const Vec4<Real> own = team.velocity(p);
    const Constraint<Real> c = gather_constraint<Multiplier::non_affine>(team, p, substep, own.xyz());
    const auto impulse = spread_impulse<Multiplier::non_affine>(visit_constraint(multiplier, law, limit, team, p, c), c);
    push_neighbours<Multiplier::non_affine>(team, p, own, impulse);
  }
};

} // namespace loam
