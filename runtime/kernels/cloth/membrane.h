// The cloth in its plane: stretch along warp and weft, and shear, of one triangle (Baraff and Witkin 1998, as XPBD constraints in velocities).
//
// The edges e1, e2 of a triangle give the images of the unit vectors along warp and weft, w_u = a e1 + b e2 and w_v = c e1 + d e2. Three constraints,
//
//   C_u = |w_u| - 1     C_v = |w_v| - 1     C_s = w_u . w_v
//
// with the energy area/2 (k_stretch C_u^2 + k_stretch C_v^2 + k_shear C_s^2): strains and shear angle, so both stiffnesses are forces per width. They are solved
// one after the other at the end of the substep, x + h v. Each multiplier f is a force times a length that tends to -area k C; damping adds tau dC/dt to C.
#pragma once

#include "kernels/cloth/constraints.h"

namespace loam {

struct MembraneStiffness {
  float stretch, shear; // N/m
  float damping;        // tau / h
};

// Air that moves past the cloth, on each triangle of area A with the normal n, turned to the side that the air goes to (u is its velocity past the cloth):
//   drag = rho/2 C_D A |u| (n . u) u / |u|     lift = rho/2 C_L A |u| (n . u) (u x n) x u / |u|^2
struct Air {
  Vec3<float> velocity;
  float drag, lift; // h rho / (2 areal density) times the coefficient; s/m
  float areal_density;
  LOAM_FN bool any() const { return drag > 0.0f || lift > 0.0f; }
};

template <class Real> struct Triangle {
  Vec4<Real> v[3];   // velocities; w is the inverse mass
  Vec3<Real> e1, e2; // edges at the end of the substep
  Real a, b, c, d;   // see above

  // The impulse j times the gradients g1, g2 (and minus their sum) of vertices 1, 2 (and 0).
  LOAM_FN void push(float substep, Vec3<Real> g1, Vec3<Real> g2) {
    const Vec3<Real> d1 = v[1].w * g1, d2 = v[2].w * g2, d0 = v[0].w * (g1 + g2);
    add(v[1], d1);
    add(v[2], d2);
    subtract(v[0], d0);
    e1 = e1 + Real(substep) * (d1 + d0);
    e2 = e2 + Real(substep) * (d2 + d0);
  }
  LOAM_FN static void add(Vec4<Real> &v, Vec3<Real> d) {
    v.x = v.x + d.x;
    v.y = v.y + d.y;
    v.z = v.z + d.z;
  }
  LOAM_FN static void subtract(Vec4<Real> &v, Vec3<Real> d) {
    v.x = v.x - d.x;
    v.y = v.y - d.y;
    v.z = v.z - d.z;
  }
};

// The direction of w; 0 where it has none.
template <class Real> LOAM_FN Vec3<Real> direction(Vec3<Real> w, Real size) {
  const auto some = size > Real(1e-6f);
  return select(some, Real(1.0f) / select(some, size, Real(1.0f)), Real(0.0f)) * w;
}

template <class Team>
LOAM_FN Triangle<typename Team::Real> load_triangle(Team &team, const ClothConstraints &constraints, typename Team::Item i,
                                                    const Row *velocities) {
  using F = MembraneField;
  return {{team.template row<F>(constraints, i, 0, velocities), team.template row<F>(constraints, i, 1, velocities),
           team.template row<F>(constraints, i, 2, velocities)},
          team.template vector<F>(constraints, i, F::first_edge),
          team.template vector<F>(constraints, i, F::second_edge),
          team.template field<F>(constraints, i, F::warp_of_first),
          team.template field<F>(constraints, i, F::warp_of_second),
          team.template field<F>(constraints, i, F::weft_of_first),
          team.template field<F>(constraints, i, F::weft_of_second)};
}
template <class Team>
LOAM_FN void store_triangle(Team &team, const ClothConstraints &constraints, typename Team::Item i, Row *velocities,
                            const Triangle<typename Team::Real> &t) {
  for (int k = 0; k < 3; ++k) team.template set_row<MembraneField>(constraints, i, k, velocities, t.v[k]);
}

// Once a substep: the edges, and the air.
struct PrepareMembrane {
  ClothConstraints constraints;
  const Row *positions;
  Row *velocities;
  Air air;

  template <class Team> LOAM_FN void operator()(Team &team, typename Team::Item i) const {
    using F = MembraneField;
    using Real = typename Team::Real;
    const Vec3<Real> x = team.template row<F>(constraints, i, 0, positions).xyz();
    const Vec3<Real> e1 = team.template row<F>(constraints, i, 1, positions).xyz() - x;
    const Vec3<Real> e2 = team.template row<F>(constraints, i, 2, positions).xyz() - x;
    team.template set_vector<F>(constraints, i, F::first_edge, e1);
    team.template set_vector<F>(constraints, i, F::second_edge, e2);
    for (int k = 0; k < 3; ++k) team.template set_field<F>(constraints, i, F::force + k, Real(0.0f));
    if (!air.any()) return;
    Triangle<Real> t = load_triangle(team, constraints, i, velocities);
    blow(t, e1, e2, team.template field<F>(constraints, i, F::area));
    store_triangle(team, constraints, i, velocities, t);
  }

private:
  template <class Real> LOAM_FN void blow(Triangle<Real> &t, Vec3<Real> e1, Vec3<Real> e2, Real area) const {
    const Real zero(0.0f), one(1.0f), third(1.0f / 3.0f);
    const Vec3<Real> mean = third * (t.v[0].xyz() + (t.v[1].xyz() + t.v[2].xyz()));
    const Vec3<Real> u = Vec3<Real>{Real(air.velocity.x), Real(air.velocity.y), Real(air.velocity.z)} - mean;
    const Vec3<Real> normal = cross(e1, e2);
    const Real size = length(normal);
    const auto some = size > Real(1e-18f);
    const Vec3<Real> n = select(some, one / select(some, size, one), zero) * normal;
    const Real along = dot(n, u), speed = length(u);
    const Real facing = absolute(along); // |u| cos
    // A share of 1 takes the cloth along with the air: more would overshoot.
    const Real drag = minimum(Real(air.drag) * facing, one);
    const Vec3<Real> across = cross(cross(u, n), u);
    const Real lift = minimum(Real(air.lift) * facing, one);
    const auto moving = speed > Real(1e-12f);
    const Real inverse = select(moving, one / select(moving, speed, one), zero);
    const Vec3<Real> side = select(along > zero, inverse * inverse, zero - inverse * inverse) * (speed * across);
    const Vec3<Real> change = drag * u + lift * side;
    // The triangle has a third of its mass at each vertex.
    const Real mass = third * Real(air.areal_density) * area;
    for (int k = 0; k < 3; ++k) Triangle<Real>::add(t.v[k], (mass * t.v[k].w) * change);
  }
};

struct SolveMembrane {
  ClothConstraints constraints;
  Row *velocities;
  float substep;
  MembraneStiffness stiffness;

  template <class Team> LOAM_FN void operator()(Team &team, typename Team::Item i) const {
    using F = MembraneField;
    using Real = typename Team::Real;
    const Real h(substep);
    Triangle<Real> t = load_triangle(team, constraints, i, velocities);
    const Vec3<Real> e1 = t.e1, e2 = t.e2;
    t.e1 = e1 + h * (t.v[1].xyz() - t.v[0].xyz());
    t.e2 = e2 + h * (t.v[2].xyz() - t.v[0].xyz());
    const Real area = team.template field<F>(constraints, i, F::area);
    const Real stretch = Real(stiffness.stretch) * area, shear = Real(stiffness.shear) * area;
    const Vec3<Real> u = t.a * e1 + t.b * e2, v = t.c * e1 + t.d * e2; // at the start, for the damping
    stretched(team, i, t, stretch, length(u), t.a, t.b, F::force);
    stretched(team, i, t, stretch, length(v), t.c, t.d, F::force + 1);

    const Vec3<Real> p = t.a * t.e1 + t.b * t.e2, q = t.c * t.e1 + t.d * t.e2;
    const Vec3<Real> g1 = t.a * q + t.c * p, g2 = t.b * q + t.d * p, g0 = g1 + g2;
    const Real square = t.v[0].w * dot(g0, g0) + (t.v[1].w * dot(g1, g1) + t.v[2].w * dot(g2, g2));
    const Real impulse = answer(team, i, F::force + 2, shear, dot(p, q), dot(u, v), square);
    t.push(substep, impulse * g1, impulse * g2);
    store_triangle(team, constraints, i, velocities, t);
  }

private:
  // The impulse that a constraint of value `now`, and `before` at the start of the substep, asks for; `square` is the sum of w |grad C|^2.
  template <class Team, class Real>
  LOAM_FN Real answer(Team &team, typename Team::Item i, int field, Real k, Real now, Real before, Real square) const {
    const Real h(substep), tau(stiffness.damping), one(1.0f);
    const Real force = team.template field<MembraneField>(constraints, i, field);
    const Real missing = k * (now + tau * (now - before)) + force;
    const Real change = (Real(0.0f) - missing) / (one + (h * h) * ((one + tau) * (k * square)));
    team.template set_field<MembraneField>(constraints, i, field, force + change);
    return h * change;
  }
  template <class Team, class Real>
  LOAM_FN void stretched(Team &team, typename Team::Item i, Triangle<Real> &t, Real k, Real before, Real a, Real b,
                         int field) const {
    const Vec3<Real> w = a * t.e1 + b * t.e2;
    const Real size = length(w), sum = a + b, one(1.0f);
    const Real square = t.v[0].w * (sum * sum) + (t.v[1].w * (a * a) + t.v[2].w * (b * b));
    const Real impulse = answer(team, i, field, k, size - one, before - one, square);
    const Vec3<Real> j = impulse * direction(w, size);
    t.push(substep, a * j, b * j);
  }
};

} // namespace loam
