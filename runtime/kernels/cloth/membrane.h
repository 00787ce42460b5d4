// The cloth in its plane: stretch along warp and weft, and shear, of one triangle (Baraff and Witkin 1998, as XPBD constraints in velocities).
//
// The edges e1, e2 of a triangle give the images of the unit vectors along warp and weft, w_u = a e1 + b e2 and w_v = c e1 + d e2. Three constraints,
//
//   C_u = |w_u| - 1     C_v = |w_v| - 1     C_s = w_u . w_v
//
// with the energy area/2 (k_stretch C_u^2 + k_stretch C_v^2 + k_shear C_s^2): strains and shear angle, so both stiffnesses are forces per width. They are solved at the end of
// the substep, x + h v, first the stretches, both at once (w_u and w_v stand nearly across each other, and one hardly changes the other's length), then the shear. Each multiplier f is
// a force times a length that tends to -area k C; damping adds tau dC/dt to C.
//
// All is done on w_u and w_v: an impulse j on w_u is an impulse a j on vertex 1, b j on vertex 2, and minus their sum on vertex 0. What is kept of a multiplier is
// -f / (area k) + tau / h times C at the start of the substep, which tends to (1 + tau / h) C.
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

// Once a substep: the strains, and the air.
struct PrepareMembrane {
  ClothConstraints constraints;
  const Row *positions;
  Row *velocities;
  float damping; // tau / h
  Air air;

  template <class Team> LOAM_FN void operator()(Team &team, typename Team::Item i) const {
    using F = MembraneField;
    using Real = typename Team::Real;
    Vec4<Real> x[3];
    load_vertices<F>(team, constraints, i, positions, x);
    const Vec3<Real> e1 = x[1].xyz() - x[0].xyz(), e2 = x[2].xyz() - x[0].xyz();
    const Vec3<Real> warp = team.template field<F>(constraints, i, F::warp_of_first) * e1 +
                            team.template field<F>(constraints, i, F::warp_of_second) * e2;
    const Vec3<Real> weft = team.template field<F>(constraints, i, F::weft_of_first) * e1 +
                            team.template field<F>(constraints, i, F::weft_of_second) * e2;
    team.template set_vector<F>(constraints, i, F::warp, warp);
    team.template set_vector<F>(constraints, i, F::weft, weft);
    const Real tau(damping), one(1.0f);
    team.template set_field<F>(constraints, i, F::answered, tau * (length(warp) - one));
    team.template set_field<F>(constraints, i, F::answered + 1, tau * (length(weft) - one));
    team.template set_field<F>(constraints, i, F::answered + 2, tau * dot(warp, weft));
    if (!air.any()) return;
    Vec4<Real> v[3];
    load_vertices<F>(team, constraints, i, velocities, v);
    blow(v, e1, e2, team.template field<F>(constraints, i, F::area));
    store_vertices<F>(team, constraints, i, velocities, v);
  }

private:
  template <class Real> LOAM_FN void blow(Vec4<Real> *v, Vec3<Real> e1, Vec3<Real> e2, Real area) const {
    const Real zero(0.0f), one(1.0f), third(1.0f / 3.0f);
    const Vec3<Real> mean = third * (v[0].xyz() + (v[1].xyz() + v[2].xyz()));
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
    for (int k = 0; k < 3; ++k) add_velocity(v[k], (mass * v[k].w) * change);
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
    Vec4<Real> v[3];
    load_vertices<F>(team, constraints, i, velocities, v);
    const Real a = team.template field<F>(constraints, i, F::warp_of_first);
    const Real b = team.template field<F>(constraints, i, F::warp_of_second);
    const Real c = team.template field<F>(constraints, i, F::weft_of_first);
    const Real d = team.template field<F>(constraints, i, F::weft_of_second), ab = a + b, cd = c + d;
    const Vec3<Real> v1 = v[1].xyz() - v[0].xyz(), v2 = v[2].xyz() - v[0].xyz();
    Vec3<Real> warp = team.template vector<F>(constraints, i, F::warp) + h * (a * v1 + b * v2);
    Vec3<Real> weft = team.template vector<F>(constraints, i, F::weft) + h * (c * v1 + d * v2);
    // How fast an impulse of 1 on one makes it, and the other.
    const Real uu = v[0].w * (ab * ab) + (v[1].w * (a * a) + v[2].w * (b * b));
    const Real vv = v[0].w * (cd * cd) + (v[1].w * (c * c) + v[2].w * (d * d));
    const Real uv = v[0].w * (ab * cd) + (v[1].w * (a * c) + v[2].w * (b * d));
    const Real area = team.template field<F>(constraints, i, F::area);
    const Real stretch = Real(stiffness.stretch) * area, shear = Real(stiffness.shear) * area;

    Vec3<Real> on_warp = stretched(team, i, F::answered, stretch, warp, uu);
    Vec3<Real> on_weft = stretched(team, i, F::answered + 1, stretch, weft, vv);
    warp = warp + h * (uu * on_warp + uv * on_weft);
    weft = weft + h * (uv * on_warp + vv * on_weft);
    const Real angle = dot(warp, weft), product = uv * angle;
    const Real square = uu * dot(weft, weft) + (vv * dot(warp, warp) + (product + product));
    const Real impulse = answer(team, i, F::answered + 2, shear, angle, square, Real(1.0f));
    on_warp = on_warp + impulse * weft;
    on_weft = on_weft + impulse * warp;

    add_velocity(v[0], (Real(0.0f) - v[0].w) * (ab * on_warp + cd * on_weft));
    add_velocity(v[1], v[1].w * (a * on_warp + c * on_weft));
    add_velocity(v[2], v[2].w * (b * on_warp + d * on_weft));
    store_vertices<F>(team, constraints, i, velocities, v);
  }

private:
  // The impulse over `size` that a constraint of value `now` asks for; `square` is the sum of w |grad C|^2.
  template <class Team, class Real>
  LOAM_FN Real answer(Team &team, typename Team::Item i, int field, Real k, Real now, Real square, Real size) const {
    const Real h(substep), grown(1.0f + stiffness.damping), one(1.0f);
    const Real answered = team.template field<MembraneField>(constraints, i, field);
    const Real per_size = (grown * now - answered) / ((one + (h * h) * (grown * (k * square))) * size);
    team.template set_field<MembraneField>(constraints, i, field, answered + per_size * size);
    return (Real(0.0f) - h * k) * per_size;
  }
  // The impulse on w that brings its length to 1. None where it has no direction.
  template <class Team, class Real>
  LOAM_FN Vec3<Real> stretched(Team &team, typename Team::Item i, int field, Real k, Vec3<Real> w, Real square) const {
    const Real size = length(w), one(1.0f);
    const auto some = size > Real(1e-6f);
    return select(some, answer(team, i, field, k, size - one, square, select(some, size, one)), Real(0.0f)) * w;
  }
};

} // namespace loam
