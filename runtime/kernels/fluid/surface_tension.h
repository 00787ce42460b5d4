// Surface tension, as the stress that it is (continuum surface stress): where the density falls, fluid pulls along its surface,
//
//   T_p = tau_p (2 - n n^T),  tau_p = sigma max(|s_p| - 1/10r, 0),  n along s_p, the gradient of the density constraint (walls and other matter count)
//
// The part across the surface, (1 + 1) - 1, holds the outermost layer, which a fluid that comes apart freely would lose. Pairs pull with the sum of their stresses, each way, so momentum is
// exact:
//
//   m_p dv_p/dt = sum_b V_p V_b K(q) (T_p + T_b) x,   K = 8 (1 - q/2)^3 (q - 0.85) / r^5,   x = x_b - x_p,  q = |x| / r.
//
// K changes its sign where particles are too near, or they would gather in clumps; with the 8 its second moment is 1, as that of a gradient.
//
// Explicit: the stress of a pair is cut to what both its particles can carry in a substep.
#pragma once

#include "kernels/fluid/density_constraint.h"
#include "kernels/inelastic/record.h"

namespace loam {

// Drops of 4 to 6 r oscillate with the period that their tension asks for (Rayleigh 1879) within 8 % if it is this many times as large: the outermost
// layer is thin, and its density falls short.
constexpr float surface_calibration = 1.91f;

// Of each particle: sqrt(tau) n, and the greatest tau that it can carry; under 0 for what is no fluid.
struct ClearSurface {
  const std::uint32_t *materials;
  const float *is_fluid; // of each material: 1 or 0
  Row *surface;
  LOAM_FN void operator()(int i) const { surface[i] = {0.0f, 0.0f, 0.0f, is_fluid[materials[i]] > 0.0f ? 1e30f : -1.0f}; }
};

struct FindSurface {
  float tension;  // sigma, calibrated
  float inside;   // |s| that is none
  float greatest; // tau
  Row *surface;

  template <class Team> LOAM_FN void operator()(Team &team, typename Team::Item p) const {
    using Real = typename Team::Real;
    const Vec3<Real> s = team.vector(p, FluidRecord::gradient);
    const Real size = length(s), zero(0.0f);
    const Real stress = Real(tension) * maximum(size - Real(inside), zero);
    const Vec3<Real> a = (square_root(stress) / maximum(size, Real(inside))) * s;
    team.set_own_row(p, surface, {a.x, a.y, a.z, select(team.velocity(p).w > zero, Real(greatest), Real(1e30f))});
  }
};

struct PullSurface {
  const Row *positions, *surface;
  float inverse_radius;
  float scale; // 8 h / r^5
  static constexpr float least_distance = 0.85f;

  template <class Team> LOAM_FN void operator()(Team &team, typename Team::Item p) const {
    using Lane = typename Team::Lane;
    using Real = typename Team::Real;
    const Vec4<Real> own = team.own_row(p, positions), mark = team.own_row(p, surface);
    const Vec3<Lane> center = team.spread(own.xyz()), a = team.spread(mark.xyz());
    const Lane most = team.spread(mark.w), stress = dot(a, a), zero(0.0f), one(1.0f);
    Vec3<Lane> sum = {zero, zero, zero};
    for (auto k : team.unweighted_neighbours(p)) {
      const Vec4<Lane> other = team.neighbour_row(k, positions), b = team.neighbour_row(k, surface);
      const Vec3<Lane> x = other.xyz() - center;
      const Lane q = Lane(inverse_radius) * square_root(dot(x, x)), u = maximum(one - Lane(0.5f) * q, zero);
      const Lane other_stress = dot(b.xyz(), b.xyz());
      const Lane carried = maximum(select(most < b.w, most, b.w), zero); // 0 beside what is no fluid
      const Lane share = carried / maximum(maximum(stress, other_stress), maximum(carried, Lane(1e-30f)));
      const Lane weight = (share * other.w) * ((u * u * u) * (q - Lane(least_distance)));
      const Lane both_stresses = stress + other_stress;
      sum = sum + weight * ((both_stresses + both_stresses) * x - (dot(a, x) * a + dot(b.xyz(), x) * b.xyz()));
    }
    const Vec4<Real> v = team.velocity(p);
    const Vec3<Real> u = v.xyz() + (Real(scale) * (v.w * own.w)) * team.sum(sum);
    team.set_velocity(p, {u.x, u.y, u.z, v.w});
  }
};

} // namespace loam
