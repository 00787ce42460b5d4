// Viscosity: impulses between pairs along the line of their centres (Monaghan's form), so that momentum and angular momentum are exact.
//
//   m_p dv_p/dt = sum_b K_pb ((v_b - v_p) . x) x,    K_pb = 10 eta V_p V_b F / (x^2 + 0.01 r^2),    x = x_b - x_p, gradW = F x
//
// 10 is 2 (d + 2). That is A v with a matrix A that damps all motion but rigid motion. It is solved once a substep, by `stages` explicit ones that
// together do what one does and stay stable for a substep (s^2 + s) / 2 times as long: a Runge-Kutta-Legendre method of the first
// order (Meyer, Balsara and Aslam 2012),
//
//   Y_0 = v,  Y_j = a_j Y_{j-1} + (1 - a_j) Y_{j-2} + 2 a_j / (s^2 + s) h A Y_{j-1},  a_j = (2j - 1) / j.
//
// Stability asks for h |A| <= s^2 + s. With D_p = w_p sum_b h K_pb x x^T the norm of h A is at most twice the greatest |D_p|; a pair whose
// particles would exceed it has its coefficient cut, so it holds for any arrangement, any masses and any viscosity.
//
// Between two fluids the harmonic mean of their viscosities acts; other matter counts as viscous as the fluid that touches it.
#pragma once

#include "kernels/neighbours/smoothing_kernel.h"
#include "math/matrix.h"

namespace loam {

constexpr float viscous_softening = 0.01f; // of r^2: below a tenth of r, impulses fade

// A particle as a viscous neighbour: x: the bound of |D_p|; y: its viscosity, under 0 for what is no fluid.
struct MarkViscosity {
  const std::uint32_t *materials;
  const float *of_material;
  const Row *positions, *velocities;
  float most; // kinematic, that the stages can carry
  Row *marks, *measured;
  LOAM_FN void operator()(int i) const {
    const float mass_of_volume = positions[i].w * velocities[i].w; // 0 for what is pinned
    float viscosity = of_material[materials[i]];
    if (mass_of_volume > 0.0f) viscosity = minimum(viscosity, most / mass_of_volume);
    marks[i] = measured[i] = {0.0f, viscosity, 0.0f, 0.0f};
  }
};

struct ViscousPair {
  const Row *positions, *marks;
  SmoothingKernel kernel;
  float scale;     // 10 h, calibrated
  float softening; // 0.01 r^2

  // h K
  template <class T> LOAM_FN T coefficient(Vec3<T> x, T own, T other, T volume, T other_volume) const {
    const T zero(0.0f), squared = dot(x, x);
    const T least = select(own < other, own, other), greatest = maximum(own, other);
    const T mean = (least + least) * greatest / maximum(least + greatest, T(1e-30f));
    const T viscosity = select(least < zero, maximum(greatest, zero), mean);
    const T factor = select(volume < other_volume, volume, other_volume) * kernel.gradient_factor(square_root(squared));
    return (T(scale) * viscosity) * ((factor * maximum(volume, other_volume)) / (squared + T(softening)));
  }
};

// The bound of |D_p|: its greatest sum along a row.
struct MeasureViscosity {
  ViscousPair pair;
  Row *measured;

  template <class Team> LOAM_FN void operator()(Team &team, typename Team::Item p) const {
    using Lane = typename Team::Lane;
    using Real = typename Team::Real;
    const Vec4<Real> own = team.own_row(p, pair.positions), mark = team.own_row(p, pair.marks);
    const Vec3<Lane> center = team.spread(own.xyz());
    const Lane viscosity = team.spread(mark.y), volume = team.spread(own.w), zero(0.0f);
    Vec3<Lane> along = {zero, zero, zero}, across = {zero, zero, zero};
    for (auto k : team.unweighted_neighbours(p)) {
      const Vec4<Lane> other = team.neighbour_row(k, pair.positions);
      const Vec3<Lane> x = other.xyz() - center;
      const Lane c = pair.coefficient(x, viscosity, team.neighbour_row(k, pair.marks).y, volume, other.w);
      along = along + Vec3<Lane>{(c * x.x) * x.x, (c * x.y) * x.y, (c * x.z) * x.z};
      across = across + Vec3<Lane>{(c * x.y) * x.z, (c * x.z) * x.x, (c * x.x) * x.y};
    }
    const Vec3<Real> d = team.sum(along), sums = team.sum(across);
    const Vec3<Real> o = {absolute(sums.x), absolute(sums.y), absolute(sums.z)};
    const Real most = maximum(maximum(d.x + o.y + o.z, d.y + o.z + o.x), d.z + o.x + o.y);
    team.set_own_row(p, measured, {team.velocity(p).w * most, mark.y, mark.z, mark.w});
  }
};

// One explicit stage, from the velocities of the visit to `result`, which holds those of the stage before.
struct DiffuseVelocities {
  ViscousPair pair;
  float most;                  // |D_p|
  float share, before, change; // a_j, 1 - a_j, 2 a_j / (s^2 + s)
  Row *result;

  template <class Team> LOAM_FN void operator()(Team &team, typename Team::Item p) const {
    using Lane = typename Team::Lane;
    using Real = typename Team::Real;
    const Vec4<Real> own = team.own_row(p, pair.positions), mark = team.own_row(p, pair.marks), v = team.velocity(p);
    const Vec3<Lane> center = team.spread(own.xyz()), velocity = team.spread(v.xyz());
    const Lane viscosity = team.spread(mark.y), size = team.spread(mark.x), volume = team.spread(own.w), zero(0.0f);
    Vec3<Lane> sum = {zero, zero, zero};
    for (auto k : team.unweighted_neighbours(p)) {
      const Vec4<Lane> other = team.neighbour_row(k, pair.positions), other_mark = team.neighbour_row(k, pair.marks);
      const Vec3<Lane> x = other.xyz() - center;
      const Lane c = pair.coefficient(x, viscosity, other_mark.y, volume, other.w);
      const Lane greatest = maximum(maximum(size, other_mark.x), Lane(most));
      sum = sum + (c * (Lane(most) / greatest) * dot(team.neighbour_velocity(k).xyz() - velocity, x)) * x;
    }
    const Vec3<Real> u =
        Real(share) * v.xyz() + Real(before) * team.own_row(p, result).xyz() + (Real(change) * v.w) * team.sum(sum);
    team.set_own_row(p, result, {u.x, u.y, u.z, v.w});
  }
};

} // namespace loam
