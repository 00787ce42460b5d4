// A particle and a triangle in a substep: both go straight, the triangle by its vertices. Whether the particle passes through it, and what keeps it on
// its side.
//
// Where the straight way of the particle pierces the triangle, it ends a small margin above the triangle instead, or at the height that it had if that was less; and at its end it is no
// nearer to any triangle than that. Triangles that share an edge see the same way, so there is none between them. What is on a side stays there, and being
// pressed against a surface for ever does not bring it through.
//
// A particle that leaves one triangle may meet another: whoever asks passes over all of them until they agree. If they do not (a crease that closes), less of a margin will do; and if
// not even that, the particle goes along with the surface, with the points nearest to it, the nearer the more.
#pragma once

#include "kernels/contact/closest_point_on_triangle.h"

namespace loam {

// A triangle seen from the particle, at one moment.
struct TriangleView {
  Vec3<float> a, b, c, normal;
  float twice_area, height;
  LOAM_FN TriangleView(Vec3<float> a, Vec3<float> b, Vec3<float> c) : a(a), b(b), c(c) {
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

// The nearest point's, of weights that may be outside.
LOAM_FN Vec3<float> inside(Vec3<float> w) {
  const Vec3<float> part = {maximum(0.0f, w.x), maximum(0.0f, w.y), maximum(0.0f, w.z)};
  return (1.0f / (part.x + (part.y + part.z))) * part;
}

LOAM_FN TriangleView between(const TriangleView &start, const TriangleView &end, float time) {
  return {start.a + time * (end.a - start.a), start.b + time * (end.b - start.b), start.c + time * (end.c - start.c)};
}

// When the particle passes through the triangle, as a share of the substep; -1 if it does not. The volume that it spans with the triangle is a cubic.
LOAM_FN float time_of_piercing(const TriangleView &start, const TriangleView &end) {
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
    const TriangleView there = between(start, end, late);
    return there.outside(there.weights()) < 1e-3f * square_root(there.twice_area) ? late : -1.0f;
  }
  return -1.0f;
}

// How passes over triangles keep a particle on its side.
struct SidePasses {
  static constexpr int wide = 6, all = 24;    // with the whole margin, and in all
  static constexpr float least_share = 0.05f; // of the margin: what is nearer may lose its side to rounding

  float margin; // a small share of the stand-off
  LOAM_FN float margin_of(int pass) const { return pass < wide ? margin : least_share * margin; }
  LOAM_FN float least() const { return least_share * margin; }
};

// What a triangle asks of a particle.
struct SideKept {
  Vec3<float> more; // of its motion
  Vec3<float> weights;
  bool changes, pierced;
};

// Neither view may be a line.
LOAM_FN SideKept keep_side(const TriangleView &start, const TriangleView &end, const SidePasses &passes, int pass) {
  const float margin = passes.margin_of(pass), least = passes.least();
  if (const float time = time_of_piercing(start, end); time >= 0.0f) {
    const float side = start.height < 0.0f ? -1.0f : 1.0f;
    const float keep = minimum(margin, maximum(least, side * start.height));
    return {(side * (keep - side * end.height)) * end.normal, between(start, end, time).weights(), true, true};
  }
  const ClosestPoint<float> closest = closest_point_on_triangle(end.a, end.b, end.c, end.normal);
  const SideKept none = {{0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f}, false, false};
  if (!(closest.distance_squared < margin * margin)) return none;
  const float before = square_root(closest_point_on_triangle(start.a, start.b, start.c, start.normal).distance_squared);
  const float distance = square_root(closest.distance_squared), keep = minimum(margin, maximum(least, before));
  if (!(distance < keep - 1e-3f * passes.margin)) return none;
  const Vec3<float> away = distance > 0.1f * least ? (-1.0f / distance) * closest.point
                           : end.height < 0.0f     ? -1.0f * end.normal
                                                   : end.normal;
  return {(keep - distance) * away, end.weights(), true, false};
}

// What the surface around a particle does.
struct Company {
  Vec3<float> change = {0.0f, 0.0f, 0.0f}; // of the particle's motion, if it went along, weighted
  float weight = 0.0f, greatest_weight = 0.0f;

  // True if this triangle is the nearest so far. Neither view may be a line.
  LOAM_FN bool add(const TriangleView &start, const TriangleView &end, const SidePasses &passes) {
    const ClosestPoint<float> closest = closest_point_on_triangle(start.a, start.b, start.c, start.normal);
    const float least = passes.least(), near = maximum(closest.distance_squared, least * least);
    const float own = 1.0f / (near * near);
    const Vec3<float> w = inside(start.weights());
    const float height = minimum(passes.margin, maximum(least, absolute(start.height)));
    const Vec3<float> place =
        (w.x * end.a + (w.y * end.b + w.z * end.c)) + (start.height < 0.0f ? 0.0f - height : height) * end.normal;
    change = change + own * place;
    weight += own;
    if (!(own > greatest_weight)) return false;
    greatest_weight = own;
    return true;
  }
  LOAM_FN Vec3<float> mean() const { return (1.0f / weight) * change; }
};

} // namespace loam
