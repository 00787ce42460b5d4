// Vorticity confinement: eddies get back a share of the energy that the solve for pressure took from the motion.
//
// The force is Steinhoff's second form, a curl, so that as impulses between pairs it keeps momentum:
//
//   m_p dv_p = h rho / k sum_b V_p V_b F x cross (a_p + a_b),    x = x_b - x_p,  gradW = F x,  k what the sum makes of a gradient of 1
//
// with a_p along the vorticity, the same sum over differences of velocities: omega_p = 1/k sum_b V_b F x cross (v_b - v_p). They are adjoint, so to the first order
// the energy grows by h rho V_p a_p . omega_p for each particle, whatever the arrangement. So much a_p may be as is wanted, c r^2 |omega| times the harmonic mean of
// the neighbourhood's vorticity along its own. That is next to none where one of it turns the other way (a thousandth of its own stands for it): particles that shake
// must not be fed, or water that is stirred once never comes to rest. And no more than what its own density constraint took in this substep pays for,
//
//   E_p = lambda_p (C'_0 + C'_1) / 2,   C' = dC/dt with the velocities of the end of the last substep, and of this one,
//
// which over all particles is exactly the work of pressures. With the growth of the second order, bounded by rho h^2 a^2 / r^2 a volume, that is
// a omega + h a^2 / r^2 <= share E_p / (h rho V_p).
//
// Only the particles of one material act on each other.
#pragma once

#include "kernels/fluid/prepare_fluid.h"

namespace loam {

// marks: x: C'_0; fourth component: the material. vorticity: omega, and E / V.
struct ClearVorticity {
  const std::uint32_t *materials;
  Row *marks, *vorticity;
  LOAM_FN void operator()(int i) const {
    marks[i] = {0.0f, 0.0f, 0.0f, static_cast<float>(materials[i])};
    vorticity[i] = {0.0f, 0.0f, 0.0f, 0.0f};
  }
};

// Before the solve, without what gravity has given since the last substep: that is no loss.
struct MarkCompression {
  Vec3<float> gravity; // times h
  Row *marks;

  template <class Team> LOAM_FN void operator()(Team &team, typename Team::Item p) const {
    using Lane = typename Team::Lane;
    using Real = typename Team::Real;
    const Vec3<Real> v = team.velocity(p).xyz();
    const Vec3<Lane> own = team.spread(v);
    const Lane zero(0.0f);
    Vec3<Lane> total = {zero, zero, zero};
    Lane flow = zero;
    for (auto k : team.neighbours(p)) {
      const Vec3<Lane> g = team.gradient(k);
      total = total + g;
      flow = flow + dot(g, own - team.neighbour_velocity(k).xyz());
    }
    const Vec3<Real> walls = team.vector(p, FluidRecord::gradient) - team.sum(total);
    const Vec3<Real> before = v - Vec3<Real>{Real(gravity.x), Real(gravity.y), Real(gravity.z)};
    const Real none(0.0f);
    team.set_own_row(p, marks,
                     {team.sum(Vec3<Lane>{flow, zero, zero}).x + dot(walls, before), none, none, team.own_row(p, marks).w});
  }
};

struct VortexPair {
  const Row *positions, *marks;
  SmoothingKernel kernel;
  float material;

  // The volume of a neighbour of the same material.
  template <class T> LOAM_FN T volume(const Vec4<T> &other, const Vec4<T> &mark) const {
    const T difference = mark.w - T(material);
    return select(difference * difference < T(0.25f), other.w, T(0.0f));
  }
};

struct MeasureVorticity {
  VortexPair pair;
  float scale; // 1 / k
  Row *vorticity;

  template <class Team> LOAM_FN void operator()(Team &team, typename Team::Item p) const {
    using Lane = typename Team::Lane;
    using Real = typename Team::Real;
    const Vec4<Real> own = team.own_row(p, pair.positions);
    const Vec3<Real> velocity = team.velocity(p).xyz();
    const Vec3<Lane> center = team.spread(own.xyz()), v = team.spread(velocity);
    const Lane zero(0.0f);
    Vec3<Lane> sum = {zero, zero, zero};
    Lane flow = zero;
    for (auto k : team.neighbours(p)) {
      const Vec4<Lane> other = team.neighbour_row(k, pair.positions);
      const Vec3<Lane> x = other.xyz() - center, u = team.neighbour_velocity(k).xyz();
      const Lane volume = pair.volume(other, team.neighbour_row(k, pair.marks));
      sum = sum + (pair.kernel.gradient_factor(square_root(dot(x, x))) * volume) * cross(x, u - v);
      flow = flow + dot(team.gradient(k), u);
    }
    const Vec3<Real> curl = Real(scale) * team.sum(sum);
    const Real compression = dot(team.vector(p, FluidRecord::gradient), velocity) - team.sum(Vec3<Lane>{flow, zero, zero}).x;
    const Real lost = Real(0.5f) * team.field(p, FluidRecord::multiplier) * (team.own_row(p, pair.marks).x + compression);
    team.set_own_row(p, vorticity, {curl.x, curl.y, curl.z, lost / own.w});
  }
};

// a
struct WeighVorticity {
  VortexPair pair;
  const Row *vorticity;
  float strength;   // c r^2
  float affordable; // share / (h rho)
  float second;     // h / r^2
  Row *sources;
  static constexpr float least_share = 1e-3f;

  template <class Team> LOAM_FN void operator()(Team &team, typename Team::Item p) const {
    using Lane = typename Team::Lane;
    using Real = typename Team::Real;
    const Vec4<Real> omega = team.own_row(p, vorticity);
    const Real size = length(omega.xyz()), tiny(1e-20f);
    const Vec3<Real> direction = (Real(1.0f) / maximum(size, tiny)) * omega.xyz();
    const Vec4<Real> own = team.own_row(p, pair.positions);
    const Vec3<Lane> center = team.spread(own.xyz()), along = team.spread(direction);
    const Lane least = team.spread(maximum(Real(least_share) * size, tiny)), zero(0.0f);
    Lane weights = zero, inverses = zero;
    for (auto k : team.unweighted_neighbours(p)) {
      const Vec4<Lane> other = team.neighbour_row(k, pair.positions);
      const Vec3<Lane> x = other.xyz() - center;
      const Lane distance = square_root(dot(x, x)), volume = pair.volume(other, team.neighbour_row(k, pair.marks));
      // the list ends in the particle itself, which counts once
      const Lane weight = select(distance > zero, pair.kernel.value(distance) * volume, zero);
      weights = weights + weight;
      inverses = inverses + weight / maximum(dot(team.neighbour_row(k, vorticity).xyz(), along), least);
    }
    const Vec3<Real> sums = team.sum(Vec3<Lane>{weights, inverses, zero});
    const Real weight = pair.kernel.value(Real(0.0f)) * own.w;
    const Real mean = (sums.x + weight) / maximum(sums.y + weight / maximum(size, tiny), tiny);
    const Real wanted = (Real(strength) * size) * mean;
    const Real energy = usable_multiplier(Real(affordable) * omega.w);
    const Real paid_for = (energy + energy) / maximum(size + square_root(size * size + Real(4.0f * second) * energy), tiny);
    const Vec3<Real> a = minimum(wanted, paid_for) * direction;
    team.set_own_row(p, sources, {a.x, a.y, a.z, Real(0.0f)});
  }
};

struct ConfineVorticity {
  VortexPair pair;
  const Row *sources;
  float scale; // h rho / k

  template <class Team> LOAM_FN void operator()(Team &team, typename Team::Item p) const {
    using Lane = typename Team::Lane;
    using Real = typename Team::Real;
    const Vec4<Real> own = team.own_row(p, pair.positions), v = team.velocity(p);
    const Vec3<Lane> center = team.spread(own.xyz()), a = team.spread(team.own_row(p, sources).xyz());
    const Lane zero(0.0f);
    Vec3<Lane> sum = {zero, zero, zero};
    for (auto k : team.unweighted_neighbours(p)) {
      const Vec4<Lane> other = team.neighbour_row(k, pair.positions);
      const Vec3<Lane> x = other.xyz() - center;
      const Lane volume = pair.volume(other, team.neighbour_row(k, pair.marks));
      sum = sum + (pair.kernel.gradient_factor(square_root(dot(x, x))) * volume) *
                      cross(x, a + team.neighbour_row(k, sources).xyz());
    }
    const Vec3<Real> u = v.xyz() + (Real(scale) * (own.w * v.w)) * team.sum(sum);
    team.set_velocity(p, {u.x, u.y, u.z, v.w});
  }
};

} // namespace loam
