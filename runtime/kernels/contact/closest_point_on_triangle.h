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

// Takes the closest point of the edge from a to b, if the origin is outside of it, where it is closer than the best so far. Without
// branches: which edge is closest is nearly random, and so the loop over a packet's lanes becomes vector code.
template <class T>
LOAM_FN void closer_point_on_edge(bool outside, Vec3<T> a, Vec3<T> edge, int from, int to, int own, ClosestPoint<T> &best) {
  const T along = T(0) - dot(a, edge);
  const T whole = dot(edge, edge);
  const bool before = !(along > T(0));
  const bool beyond = along >= whole;
  const T quotient = along / whole;
  const T share = before ? T(0) : beyond ? T(1) : quotient;
  const Vec3<T> point = a + share * edge;
  const T distance_squared = dot(point, point);
  const bool closer = outside && distance_squared < best.distance_squared;
  const int feature = before ? from : beyond ? to : own;
  best.point.x = closer ? point.x : best.point.x;
  best.point.y = closer ? point.y : best.point.y;
  best.point.z = closer ? point.z : best.point.z;
  best.distance_squared = closer ? distance_squared : best.distance_squared;
  best.feature = closer ? feature : best.feature;
}

// The triangle's vertices are given relative to the query point; the normal has unit length.
template <class T> LOAM_FN ClosestPoint<T> closest_point_on_triangle(Vec3<T> a, Vec3<T> b, Vec3<T> c, Vec3<T> normal) {
  const Vec3<T> ab = b - a, bc = c - b, ca = a - c;
  const bool outside_ab = dot(cross(normal, ab), a) > T(0);
  const bool outside_bc = dot(cross(normal, bc), b) > T(0);
  const bool outside_ca = dot(cross(normal, ca), c) > T(0);
  ClosestPoint<T> best = {a, T(1e30), 3};
  closer_point_on_edge(outside_ab, a, ab, 3, 4, 0, best);
  closer_point_on_edge(outside_bc, b, bc, 4, 5, 1, best);
  closer_point_on_edge(outside_ca, c, ca, 5, 3, 2, best);
  const bool inside = !outside_ab && !outside_bc && !outside_ca;
  const T height = dot(normal, a);
  best.point.x = inside ? height * normal.x : best.point.x;
  best.point.y = inside ? height * normal.y : best.point.y;
  best.point.z = inside ? height * normal.z : best.point.z;
  best.distance_squared = inside ? height * height : best.distance_squared;
  best.feature = inside ? 6 : best.feature;
  return best;
}

} // namespace loam
