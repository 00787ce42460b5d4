// Last in a substep, when the cloth's velocities are final: no particle gets through a cloth.
//
// The points of particle_contact.h are half spaces of the substep's start, four at most: where triangles turn, where a particle slips on to the next triangle, or where
// an impact has made the cloth faster than it was, they miss. Here the particle's way is looked at against every triangle near it as that moves: where the straight way of the particle
// pierces the triangle, whose vertices go straight too, it ends a small margin above the triangle instead, or at the height that it had if that was less; and at its end it is no
// nearer to any triangle than that. Triangles that share an edge see the same way, so there is none between them. What is on a side stays there, and being
// pressed against a cloth for ever does not bring it through.
//
// A particle that leaves one triangle may meet another: passes over all of them. If they do not agree (a crease that closes), less of a margin will do; and if not even that, the
// particle goes along with the cloth, with the points nearest to it, the nearer the more.
//
// What a particle is given here, cloth that nothing holds receives with the opposite sign once it has moved, and goes on with it in the next substep; so momentum is kept, and
// no other particle is met by it in this one. It gets no faster by that than the particle gets slower: a light cloth would be torn away by what a heavy grain has to lose. Cloth that
// is held receives nothing, as if what holds it had stopped the particle.
#pragma once

#include "kernels/cloth/particle_contact.h"

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

    constexpr int wide_passes = 6, passes = 24;
    Way way = {x, wanted, row.w};
    for (int pass = 0; pass < passes; ++pass) {
      way.changed = way.pierced = false;
      way.margin = pass < wide_passes ? margin : least_share * margin;
      for_each_triangle(cell, [&](int triangle) { keep_side(triangle, way); });
      if (!way.changed) break;
    }
    if (way.pierced) {
      Company company = {{0.0f, 0.0f, 0.0f}, 0.0f, -1, 0.0f};
      for_each_triangle(cell, [&](int triangle) { look_for_company(triangle, way, company); });
      if (company.nearest >= 0) go_along(company, way);
    }
    if (!way.cut) return;
    row.x = way.motion.x / substep;
    row.y = way.motion.y / substep;
    row.z = way.motion.z / substep;
  }

private:
  static constexpr float least_share = 0.05f; // of the margin: what is nearer may lose its side to rounding
  struct Way {
    Vec3<float> start, motion;
    float inverse_mass;
    float margin = 0.0f;
    bool changed = false, pierced = false, cut = false;
  };
  // What the cloth around a particle does.
  struct Company {
    Vec3<float> change; // of the particle's motion, if it went along, weighted
    float weight;
    int nearest;
    float greatest_weight;
  };
  // A triangle seen from the particle, at one end of the substep.
  struct View {
    Vec3<float> a, b, c, normal;
    float twice_area, height;
    LOAM_FN View(Vec3<float> a, Vec3<float> b, Vec3<float> c) : a(a), b(b), c(c) {
      const Vec3<float> area = cross(b - a, c - a);
      twice_area = length(area);
      normal = (twice_area > 0.0f ? 1.0f / twice_area : 0.0f) * area;
      height = 0.0f - dot(normal, a);
    }
    LOAM_FN bool is_line(float size) const { return !(twice_area > 1e-6f * size * size); }
    LOAM_FN Vec3<float> weights() const {
      const float scale = -1.0f / twice_area;
      return {scale * dot(normal, cross(c - b, b)), scale * dot(normal, cross(a - c, c)),
              scale * dot(normal, cross(b - a, a))};
    }
    // By how much a point with these weights lies outside of the triangle, at most; less than 0 inside.
    LOAM_FN float outside(Vec3<float> w) const {
      return 0.0f - twice_area * minimum(w.x / length(c - b), minimum(w.y / length(a - c), w.z / length(b - a)));
    }
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

  LOAM_FN View at_start(const int *t, const Way &way) const {
    return {xyz(positions[t[0]]) - way.start, xyz(positions[t[1]]) - way.start, xyz(positions[t[2]]) - way.start};
  }
  LOAM_FN Vec3<float> vertex_at_end(int vertex, const Way &way) const {
    return (xyz(positions[vertex]) - way.start) + (substep * xyz(cloth.velocities[vertex]) - way.motion);
  }
  LOAM_FN View at_end(const int *t, const Way &way) const {
    return {vertex_at_end(t[0], way), vertex_at_end(t[1], way), vertex_at_end(t[2], way)};
  }

  LOAM_FN void keep_side(int triangle, Way &way) const {
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
    const View start = at_start(t, way), end = at_end(t, way);
    if (start.is_line(bound.w) || end.is_line(bound.w)) return; // its neighbours have its edges
    const float least = least_share * margin;
    if (const float time = time_of_piercing(start, end); time >= 0.0f) {
      way.pierced = true;
      const float side = start.height < 0.0f ? -1.0f : 1.0f;
      const float keep = minimum(way.margin, maximum(least, side * start.height));
      give(t, between(start, end, time).weights(), (side * (keep - side * end.height)) * end.normal, way);
      return;
    }
    const ClosestPoint<float> closest = closest_point_on_triangle(end.a, end.b, end.c, end.normal);
    if (!(closest.distance_squared < way.margin * way.margin)) return;
    const float before = square_root(closest_point_on_triangle(start.a, start.b, start.c, start.normal).distance_squared);
    const float distance = square_root(closest.distance_squared), keep = minimum(way.margin, maximum(least, before));
    if (!(distance < keep - 1e-3f * margin)) return;
    const Vec3<float> away = distance > 0.1f * least ? (-1.0f / distance) * closest.point
                             : end.height < 0.0f     ? -1.0f * end.normal
                                                     : end.normal;
    give(t, end.weights(), (keep - distance) * away, way);
  }

  LOAM_FN static View between(const View &start, const View &end, float time) {
    return {start.a + time * (end.a - start.a), start.b + time * (end.b - start.b), start.c + time * (end.c - start.c)};
  }
  // When the particle passes through the triangle, as a share of the substep; -1 if it does not. Both go straight: the volume that it spans with the triangle is a cubic.
  LOAM_FN static float time_of_piercing(const View &start, const View &end) {
    constexpr int pieces = 4, halvings = 20;
    const bool above = start.height > 0.0f;
    float from = 0.0f;
    for (int i = 1; i <= pieces; ++i) {
      const float to = static_cast<float>(i) / pieces;
      const bool still = (i < pieces ? between(start, end, to).height : end.height) > 0.0f;
      if (still == above) {
        from = to;
        continue;
      }
      float early = from, late = to;
      for (int k = 0; k < halvings; ++k) {
        const float middle = 0.5f * (early + late);
        if ((between(start, end, middle).height > 0.0f) == above)
          early = middle;
        else
          late = middle;
      }
      const View there = between(start, end, late);
      return there.outside(there.weights()) < 1e-3f * square_root(there.twice_area) ? late : -1.0f;
    }
    return -1.0f;
  }

  LOAM_FN void look_for_company(int triangle, const Way &way, Company &company) const {
    const int *t = triangles + 3 * static_cast<long>(triangle);
    const View start = at_start(t, way), end = at_end(t, way);
    if (start.is_line(bounds[triangle].w) || end.is_line(bounds[triangle].w)) return;
    const ClosestPoint<float> closest = closest_point_on_triangle(start.a, start.b, start.c, start.normal);
    const float least = least_share * margin, near = maximum(closest.distance_squared, least * least);
    const float weight = 1.0f / (near * near);
    const Vec3<float> w = inside(start.weights());
    const float height = minimum(margin, maximum(least, absolute(start.height)));
    const Vec3<float> place =
        (w.x * end.a + (w.y * end.b + w.z * end.c)) + (start.height < 0.0f ? 0.0f - height : height) * end.normal;
    company.change = company.change + weight * place;
    company.weight += weight;
    if (weight > company.greatest_weight) {
      company.nearest = triangle;
      company.greatest_weight = weight;
    }
  }
  LOAM_FN void go_along(const Company &company, Way &way) const {
    const int *t = triangles + 3 * static_cast<long>(company.nearest);
    give(t, inside(at_start(t, way).weights()), (1.0f / company.weight) * company.change, way);
  }

  LOAM_FN static Vec3<float> inside(Vec3<float> w) {
    const Vec3<float> part = {maximum(0.0f, w.x), maximum(0.0f, w.y), maximum(0.0f, w.z)};
    return (1.0f / (part.x + (part.y + part.z))) * part;
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
