// Bending across an edge that two triangles share (Bergou et al. 2006: A quadratic bending model for inextensible surfaces).
//
// The mean curvature of the hinge is a fixed linear combination of its four vertices, sum_i q_i x_i with the cotangents of the rest shape as weights, and the energy is
//
//   B/2 |sum_i q_i x_i|^2 / (A_1 + A_2)
//
// which for a cylinder is B/2 curvature^2 area on equilateral triangles in any direction, and nearly so along the sides of a grid of right ones. (Written with a 3 in the numerator it
// counts every triangle three times.) Being linear it is solved exactly by each visit, in any state of the triangles, and has no angle that could jump. Cloth that is not flat
// at rest bends about its rest shape: the sum's rest length along the hinge's present normal is taken off.
#pragma once

#include "kernels/cloth/constraints.h"

namespace loam {

template <class Real> struct Hinge {
  Real q[4]; // over the root of A_1 + A_2
  template <class Team> LOAM_FN static Hinge load(Team &team, const ClothConstraints &constraints, typename Team::Item i) {
    const Vec3<Real> q = team.template vector<HingeField>(constraints, i, HingeField::weight);
    return {{Real(0.0f) - (q.x + (q.y + q.z)), q.x, q.y, q.z}};
  }
  // The sum over the vertices, from differences: it keeps its digits far from the origin.
  LOAM_FN Vec3<Real> sum(const Vec4<Real> *rows) const {
    const Vec3<Real> from = rows[0].xyz();
    return q[1] * (rows[1].xyz() - from) + (q[2] * (rows[2].xyz() - from) + q[3] * (rows[3].xyz() - from));
  }
};

// Once a substep.
struct PrepareHinges {
  ClothConstraints constraints;
  const Row *positions;

  template <class Team> LOAM_FN void operator()(Team &team, typename Team::Item i) const {
    using F = HingeField;
    using Real = typename Team::Real;
    const auto hinge = Hinge<Real>::load(team, constraints, i);
    Vec4<Real> x[4];
    load_vertices<F>(team, constraints, i, positions, x);
    const Vec3<Real> edge = x[1].xyz() - x[0].xyz();
    const Vec3<Real> normal = cross(edge, x[2].xyz() - x[0].xyz()) + cross(x[3].xyz() - x[0].xyz(), edge);
    const Real size = length(normal), rest = team.template field<F>(constraints, i, F::rest);
    const auto some = size > Real(1e-18f);
    const Real scale = select(some, rest / select(some, size, Real(1.0f)), Real(0.0f));
    team.template set_vector<F>(constraints, i, F::offset, hinge.sum(x) - scale * normal);
  }
};

struct SolveHinges {
  ClothConstraints constraints;
  Row *velocities;
  float substep;
  float stiffness; // N m
  float damping;   // tau / h

  template <class Team> LOAM_FN void operator()(Team &team, typename Team::Item i) const {
    using F = HingeField;
    using Real = typename Team::Real;
    const Real h(substep), k(stiffness), grown(1.0f + damping), one(1.0f);
    const auto hinge = Hinge<Real>::load(team, constraints, i);
    Vec4<Real> v[4];
    load_vertices<F>(team, constraints, i, velocities, v);
    const Real square = (v[0].w * (hinge.q[0] * hinge.q[0]) + v[1].w * (hinge.q[1] * hinge.q[1])) +
                        (v[2].w * (hinge.q[2] * hinge.q[2]) + v[3].w * (hinge.q[3] * hinge.q[3]));
    const Vec3<Real> offset = team.template vector<F>(constraints, i, F::offset);
    const Vec3<Real> missing = offset + (h * grown) * hinge.sum(v);
    const Vec3<Real> change = (one / (one + (h * h) * (grown * (k * square)))) * missing;
    team.template set_vector<F>(constraints, i, F::offset, offset - change);
    const Vec3<Real> impulse = (Real(0.0f) - h * k) * change;
    for (int n = 0; n < 4; ++n) add_velocity(v[n], (v[n].w * hinge.q[n]) * impulse);
    store_vertices<F>(team, constraints, i, velocities, v);
  }
};

} // namespace loam
