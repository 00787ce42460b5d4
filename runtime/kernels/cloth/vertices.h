// The per-vertex stages of a cloth: attachments, the greatest speed, the move, normals.
#pragma once

#include "kernels/contact/collider_view.h"
#include "kernels/integration/measures.h"

namespace loam {

// A vertex held at a point of space or of a collider.
struct Attachment {
  int vertex;
  int collider;       // index among those of the step; -1: space
  Vec3<float> point;  // in the collider's frame, or in space, m
  float stiffness;    // N/m; 0: rigid, the vertex then has an inverse mass of 0 and goes where its point goes
  Vec3<float> offset; // from the point's place at the end of the substep to the vertex at its start, m
  Vec3<float> force;  // N, of this substep; springs only
};

LOAM_FN void add_velocity(Row &row, Vec3<float> change) {
  row.x += change.x;
  row.y += change.y;
  row.z += change.z;
}

struct PrepareAttachments {
  Attachment *attachments;
  const ColliderView *colliders;
  const Row *positions;
  Row *velocities;
  float substep;

  LOAM_FN void operator()(int i) const {
    Attachment &a = attachments[i];
    const Vec3<float> place = a.collider < 0 ? a.point : to_world(colliders[a.collider].end, a.point);
    a.offset = xyz(positions[a.vertex]) - place;
    a.force = {0.0f, 0.0f, 0.0f};
    if (a.stiffness != 0.0f) return;
    Row &v = velocities[a.vertex];
    v.x = 0.0f - a.offset.x / substep;
    v.y = 0.0f - a.offset.y / substep;
    v.z = 0.0f - a.offset.z / substep;
  }
};

struct SolveAttachments {
  Attachment *attachments;
  Row *velocities;
  float substep;

  LOAM_FN void operator()(int i) const {
    Attachment &a = attachments[i];
    if (a.stiffness == 0.0f) return;
    Row &v = velocities[a.vertex];
    const Vec3<float> missing = a.stiffness * (a.offset + substep * xyz(v)) + a.force;
    const Vec3<float> change = (-1.0f / (1.0f + substep * substep * (a.stiffness * v.w))) * missing;
    a.force = a.force + change;
    add_velocity(v, (substep * v.w) * change);
  }
};

struct GreatestSpeed {
  using Value = float;
  const Row *velocities;
  LOAM_FN static Value identity() { return 0.0f; }
  LOAM_FN Value operator()(int i) const {
    const Vec3<float> v = xyz(velocities[i]);
    return is_finite(v) ? maximum(maximum(absolute(v.x), absolute(v.y)), absolute(v.z)) : 0.0f;
  }
  LOAM_FN static Value combine(Value a, Value b) { return maximum(a, b); }
};

// x <- x + h v
struct AdvanceVertices {
  Row *positions;
  const Row *velocities;
  float substep;
  LOAM_FN void operator()(int i) const {
    Row &x = positions[i];
    const Vec3<float> moved = xyz(x) + substep * xyz(velocities[i]);
    if (!is_finite(moved)) return;
    x.x = moved.x;
    x.y = moved.y;
    x.z = moved.z;
  }
};

// Unit normals, from the triangles around each vertex weighted by their areas. The triangles of vertex i are list[starts[i]] up to list[starts[i + 1]].
struct ComputeNormals {
  const Row *positions;
  const int *triangles; // three vertices each
  const int *starts, *list;
  Row *normals;
  LOAM_FN void operator()(int i) const {
    Vec3<float> sum = {0.0f, 0.0f, 0.0f};
    for (int k = starts[i]; k < starts[i + 1]; ++k) {
      const int *t = triangles + 3 * static_cast<long>(list[k]);
      const Vec3<float> a = xyz(positions[t[0]]);
      sum = sum + cross(xyz(positions[t[1]]) - a, xyz(positions[t[2]]) - a);
    }
    const float size = length(sum);
    const float scale = size > 0.0f ? 1.0f / size : 0.0f;
    normals[i] = {scale * sum.x, scale * sum.y, scale * sum.z, 0.0f};
  }
};

} // namespace loam
