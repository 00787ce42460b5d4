// Walking a mesh's bounding volume hierarchy: the triangles near a point, and the distance to the nearest.
#pragma once

#include "kernels/contact/closest_point_on_triangle.h"
#include "kernels/contact/collider_view.h"

namespace loam {

LOAM_FN float distance_squared_to_box(Vec3<float> lower, Vec3<float> upper, Vec3<float> point) {
  const float x = maximum(maximum(lower.x - point.x, point.x - upper.x), 0.0f);
  const float y = maximum(maximum(lower.y - point.y, point.y - upper.y), 0.0f);
  const float z = maximum(maximum(lower.z - point.z, point.z - upper.z), 0.0f);
  return x * x + (y * y + z * z);
}

// Visits the triangles whose boxes lie within a distance that may shrink on the way, nearer boxes first. The tree is a binary radix
// tree over 30-bit codes with the index (under 2^28) as tie-break, so at most 58 deep, and a level leaves one entry at most.
struct BallQuery {
  const BvhNode *nodes;
  Vec3<float> centre;
  std::uint32_t stack[64];
  int size;

  LOAM_FN BallQuery(const BvhNode *tree, Vec3<float> point) : nodes(tree), centre(point), size(1) { stack[0] = 0; }

  // The index of the next triangle, or -1 when there is none left.
  LOAM_FN int next(float radius_squared) {
    while (size > 0) {
      const std::uint32_t entry = stack[--size];
      if ((entry & BvhNode::leaf) != 0) return static_cast<int>(entry & ~BvhNode::leaf);
      const BvhNode &node = nodes[entry];
      const float first = distance_squared_to_box(node.lower[0], node.upper[0], centre);
      const float second = distance_squared_to_box(node.lower[1], node.upper[1], centre);
      const int far_child = first <= second ? 1 : 0;
      if (maximum(first, second) <= radius_squared) stack[size++] = node.child[far_child];
      if (minimum(first, second) <= radius_squared) stack[size++] = node.child[1 - far_child];
    }
    return -1;
  }
};

// The distance from a point in the mesh's frame to the mesh, or `limit` if that is less.
LOAM_FN float distance_to_mesh(const BvhNode *nodes, const BvhTriangle *triangles, Vec3<float> point, float limit) {
  float best = limit * limit;
  BallQuery query(nodes, point);
  for (int i = query.next(best); i >= 0; i = query.next(best)) {
    const BvhTriangle &t = triangles[i];
    best = minimum(best, closest_point_on_triangle(t.a - point, t.b - point, t.c - point, t.normal).distance_squared);
  }
  return minimum(limit, square_root(best));
}

} // namespace loam
