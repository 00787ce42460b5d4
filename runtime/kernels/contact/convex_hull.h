// A solid convex polytope of triangles.
//
// Each face has a plane parallel to it that all vertices lie behind: its own, but for rounded coordinates. The distance to it is never more than that to the solid. So the greatest of them tells inside from outside; inside it is the
// distance itself, and from outside only faces that the point is in front of, by less than the nearest yet, are looked at closely.
#pragma once

#include "kernels/contact/closest_point_on_triangle.h"
#include "kernels/contact/surface.h"

namespace loam {

struct HullFace {
  Vec3<float> a, b, c;
  Vec3<float> normal; // outward
  float offset;       // of the plane: dot(normal, x) <= offset for all vertices
};

struct HullShape {
  const HullFace *faces;
  int face_count;
  float size; // of the greatest coordinate: what rounding is relative to

  // `limit`: beyond it a distance may be answered with any lower bound over the limit.
  LOAM_FN Surface surface(Vec3<float> point, float limit) const {
    float greatest = -1e30f;
    int front = 0;
    for (int i = 0; i < face_count; ++i) {
      const float height = dot(faces[i].normal, point) - faces[i].offset;
      if (height > greatest) {
        greatest = height;
        front = i;
      }
    }
    if (greatest <= 0.0f || greatest > limit) return {greatest, faces[front].normal};
    ClosestPoint<float> best = closest(faces[front], point);
    for (int i = 0; i < face_count; ++i) {
      const float height = dot(faces[i].normal, point) - faces[i].offset;
      if (!(height > 0.0f) || height * height >= best.distance_squared) continue;
      const ClosestPoint<float> next = closest(faces[i], point);
      if (next.distance_squared < best.distance_squared) best = next;
    }
    const float distance = square_root(best.distance_squared);
    if (distance < 1e-5f * size) return {greatest, faces[front].normal}; // too near for a direction
    return {distance, (-1.0f / distance) * best.point};
  }

private:
  LOAM_FN static ClosestPoint<float> closest(const HullFace &face, Vec3<float> point) {
    return closest_point_on_triangle(face.a - point, face.b - point, face.c - point, face.normal);
  }
};

} // namespace loam
