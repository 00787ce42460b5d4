// XSPH (equation 20 of the XPBI paper): v_p += c sum_b V (v_b - v_p) W, with c = velocity_smoothing * h.
//
// As printed the equation leaks momentum unless m_p V_b = m_b V_p. Here the pair's weight is symmetric: the mean of the two volumes and the
// reduced mass, m_p dv_p = - m_b dv_b = c V W 2 m_p m_b / (m_p + m_b) (v_b - v_p).
#pragma once

#include "kernels/neighbours/meetings.h"
#include "kernels/neighbours/smoothing_kernel.h"
#include "math/matrix.h"

namespace loam {

struct SmoothVelocities {
  const Row *positions;
  Row *smoothed;
  SmoothingKernel kernel;
  float coefficient;
  Meetings meetings;

  template <class Team> LOAM_FN void operator()(Team &team, typename Team::Item p) const {
    using Lane = typename Team::Lane;
    using Real = typename Team::Real;
    const Vec4<Real> own = team.velocity(p), x = team.own_row(p, positions);
    const Vec3<Lane> center = team.spread(x.xyz()), v = team.spread(own.xyz());
    const Lane own_volume = team.spread(x.w), own_w = team.spread(own.w), zero(0.0f), one(1.0f);
    Vec3<Lane> sum = {zero, zero, zero};
    for (auto k : team.unweighted_neighbours(p)) {
      const Vec4<Lane> other = team.neighbour_row(k, positions), u = team.neighbour_velocity(k);
      const Vec3<Lane> d = other.xyz() - center;
      const Lane weights = own_w + u.w;
      const auto movable = weights > zero;
      const Lane share = select(movable, own_w / select(movable, weights, one), zero);       // m_b / (m_p + m_b)
      Lane weight = kernel.value(square_root(dot(d, d))) * ((own_volume + other.w) * share); // mean volume times 2
      if (meetings.any()) weight = weight * meetings.shared(team, k);
      sum = sum + weight * (u.xyz() - v);
    }
    const Vec3<Real> u = own.xyz() + Real(coefficient) * team.sum(sum);
    team.set_own_row(p, smoothed, {u.x, u.y, u.z, own.w});
  }
};

} // namespace loam
