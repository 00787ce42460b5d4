// The point of a triangle that is closest to the origin, and which feature of the triangle it lies on.
//
// The point is inside if it lies on the inner side of all three edges, measured in the triangle's plane. If not, it lies on an edge
// that has the origin on its outer side. This needs the normal, but unlike the usual formulas with products of dot products
// (Ericson, Real-Time Collision Detection, 5.1.5) it has no cancellation in slivers: every quantity is a length times a rounding
// error of that length.
#pragma once

#include "math/vector.h"

namespace loam {

template <class T> struct ClosestPoint {
  Vec3<T> point;
  T distance_squared;
  int feature; // 0 to 2 edges ab, bc, ca; 3 to 5 vertices a, b, c; 6 inside
};

// Takes the closest point of the edge from a to b if it is closer than the best so far.
template <class T>
LOAM_FN void closer_point_on_edge(Vec3<T> a, Vec3<T> edge, int from, int to, int own, ClosestPoint<T> &best) {
  const T along = T(0) - dot(a, edge);
  const T whole = dot(edge, edge);
  const bool before = !(along > T(0));
  const bool beyond = along >= whole;
  const T share = before ? T(0) : beyond ? T(1) : along / whole;
  const Vec3<T> point = a + share * edge;
  const T distance_squared = dot(point, point);
  if (distance_squared < best.distance_squared) best = {point, distance_squared, before ? from : beyond ? to : own};
}

// The triangle's vertices are given relative to the query point; the normal has unit length.
template <class T> LOAM_FN ClosestPoint<T> closest_point_on_triangle(Vec3<T> a, Vec3<T> b, Vec3<T> c, Vec3<T> normal) {
  const Vec3<T> ab = b - a, bc = c - b, ca = a - c;
  const bool outside_ab = dot(cross(normal, ab), a) > T(0);
  const bool outside_bc = dot(cross(normal, bc), b) > T(0);
  const bool outside_ca = dot(cross(normal, ca), c) > T(0);
  if (!outside_ab && !outside_bc && !outside_ca) {
    const T height = dot(normal, a);
    return {height * normal, height * height, 6};
  }
  ClosestPoint<T> best = {a, T(1e30), 3};
  if (outside_ab) closer_point_on_edge(a, ab, 3, 4, 0, best);
  if (outside_bc) closer_point_on_edge(b, bc, 4, 5, 1, best);
  if (outside_ca) closer_point_on_edge(c, ca, 5, 3, 2, best);
  return best;
}

} // namespace loam
