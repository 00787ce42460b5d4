// Last in a substep, when the cloth's velocities are final: no particle gets through a cloth.
//
// The points of particle_contact.h are half spaces of the substep's start, four at most: where triangles turn, where a particle slips on to the next triangle, or where
// an impact has made the cloth faster than it was, they miss. Here the particle's way is looked at against every triangle near it as that moves: see
// contact/moving_triangle.h.
//
// What a particle is given here, cloth that nothing holds receives with the opposite sign once it has moved, and goes on with it in the next substep; so momentum is kept, and
// no other particle is met by it in this one. It gets no faster by that than the particle gets slower: a light cloth would be torn away by what a heavy grain has to lose. Cloth that
// is held receives nothing, as if what holds it had stopped the particle.
#pragma once

#include "kernels/cloth/particle_contact.h"
#include "kernels/contact/moving_triangle.h"

namespace loam {

struct SweepCloth {
  const ClothContact *contacts; // of the particles to look at; null: all that are faster than these could be found for
  const Row *particles;         // at the start of the substep
  Row *particle_velocities;
  const Row *positions; // of the vertices, at the start
  ClothImpulses cloth;
  const int *triangles;
  const Row *bounds;
  TriangleGrid grid;
  float substep;
  float margin;       // a small share of the stand-off
  float least_motion; // of those that have no contacts: what is slower cannot have come near
  float cloth_motion; // the most that a vertex moves
  bool held;

  LOAM_FN void operator()(int index) const {
    const int particle = contacts != nullptr ? contacts[index].particle : index;
    Row &row = particle_velocities[particle];
    const Vec3<float> v = xyz(row);
    if (!is_finite(v)) return;
    const Vec3<float> wanted = substep * v;
    if (contacts == nullptr && length(wanted) + cloth_motion < least_motion) return;
    const Vec3<float> x = xyz(particles[particle]);
    if (!is_finite(x)) return;
    const int cell[3] = {grid.grid.coordinate(x.x), grid.grid.coordinate(x.y), grid.grid.coordinate(x.z)};
    for (int k = 0; k < 3; ++k)
      if (cell[k] < grid.lower[k] - 1 || cell[k] > grid.upper[k] + 1) return;

    Way way = {x, wanted, row.w};
    const SidePasses passes = {margin};
    for (int pass = 0; pass < SidePasses::all; ++pass) {
      way.changed = way.pierced = false;
      for_each_triangle(cell, [&](int triangle) { keep_off(triangle, passes, pass, way); });
      if (!way.changed) break;
    }
    if (way.pierced) {
      Company company;
      int nearest = -1;
      for_each_triangle(cell, [&](int triangle) {
        const int *t = triangles + 3 * static_cast<long>(triangle);
        const TriangleView start = at_start(t, way), end = at_end(t, way);
        if (start.is_line(bounds[triangle].w) || end.is_line(bounds[triangle].w)) return;
        if (company.add(start, end, passes)) nearest = triangle;
      });
      if (nearest >= 0) {
        const int *t = triangles + 3 * static_cast<long>(nearest);
        give(t, inside(at_start(t, way).weights()), company.mean(), way);
      }
    }
    if (!way.cut) return;
    row.x = way.motion.x / substep;
    row.y = way.motion.y / substep;
    row.z = way.motion.z / substep;
  }

private:
  struct Way {
    Vec3<float> start, motion;
    float inverse_mass;
    bool changed = false, pierced = false, cut = false;
  };

  template <class F> LOAM_FN void for_each_triangle(const int *cell, const F &f) const {
    for (int dx = -1; dx <= 1; ++dx)
      for (int dy = -1; dy <= 1; ++dy)
        for (int dz = -1; dz <= 1; ++dz) {
          const CellGrid &g = grid.grid;
          const int c = g.index(g.wrap(cell[0] + dx, 0), g.wrap(cell[1] + dy, 1), g.wrap(cell[2] + dz, 2));
          for (int k = grid.starts[c]; k < grid.starts[c + 1]; ++k) f(static_cast<int>(grid.order[k]));
        }
  }

  LOAM_FN TriangleView at_start(const int *t, const Way &way) const {
    return {xyz(positions[t[0]]) - way.start, xyz(positions[t[1]]) - way.start, xyz(positions[t[2]]) - way.start};
  }
  LOAM_FN Vec3<float> vertex_at_end(int vertex, const Way &way) const {
    return (xyz(positions[vertex]) - way.start) + (substep * xyz(cloth.velocities[vertex]) - way.motion);
  }
  LOAM_FN TriangleView at_end(const int *t, const Way &way) const {
    return {vertex_at_end(t[0], way), vertex_at_end(t[1], way), vertex_at_end(t[2], way)};
  }

  LOAM_FN void keep_off(int triangle, const SidePasses &passes, int pass, Way &way) const {
    const Row bound = bounds[triangle];
    const int *t = triangles + 3 * static_cast<long>(triangle);
    float relative = 0.0f;
    for (int k = 0; k < 3; ++k) {
      const Vec3<float> u = substep * xyz(cloth.velocities[t[k]]) - way.motion;
      relative = maximum(relative, dot(u, u));
    }
    const Vec3<float> apart = way.start - xyz(bound);
    const float far = bound.w + margin + square_root(relative);
    if (!(dot(apart, apart) < far * far)) return;
    const TriangleView start = at_start(t, way), end = at_end(t, way);
    if (start.is_line(bound.w) || end.is_line(bound.w)) return; // its neighbours have its edges
    const SideKept kept = keep_side(start, end, passes, pass);
    way.pierced = way.pierced || kept.pierced;
    if (kept.changes) give(t, kept.weights, kept.more, way);
  }

  LOAM_FN void give(const int *t, Vec3<float> weights, Vec3<float> more, Way &way) const {
    way.motion = way.motion + more;
    way.changed = way.cut = true;
    if (held || !(way.inverse_mass > 0.0f)) return;
    const Vec3<float> w = inside(weights);
    ClothContactPoint point;
    for (int k = 0; k < 3; ++k) point.vertices[k] = t[k];
    point.weights[0] = w.x;
    point.weights[1] = w.y;
    point.weights[2] = w.z;
    float weight = 0.0f;
    for (int k = 0; k < 3; ++k) weight += point.weights[k] * point.weights[k] * cloth.velocities[t[k]].w;
    const float share = weight > way.inverse_mass ? way.inverse_mass / weight : 1.0f;
    (void)cloth.hand_over(point, (share / (substep * way.inverse_mass)) * more);
  }
};

} // namespace loam
