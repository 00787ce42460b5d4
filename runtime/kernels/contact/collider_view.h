// What the contact kernels see of a collider and of a particle's contacts: plain data for either machine.
#pragma once

#include <cstdint>

#include "math/vector.h"

namespace loam {

// Four triangles that lie together, a lane each; lanes from `count` on repeat the first. Lane k is triangle `first + k`.
struct TrianglePacket {
  static constexpr int width = 4;
  float a[3][width], b[3][width], c[3][width]; // x, y, z of the vertices
  float normal[3][width];
  std::uint32_t first, count;
};

// A node of the bounding volume hierarchy over a mesh's packets: the boxes of four children, which are nodes, packets (top bit set), or
// missing: then the box is empty, at an infinite distance from everything. The root is node 0.
struct alignas(64) BvhNode {
  static constexpr int width = 4;
  static constexpr std::uint32_t leaf = 0x80000000u;
  float centre[3][width], half[3][width]; // x, y, z of the middles and of the half extents
  std::uint32_t child[width];
};

// Edges and vertices of the mesh, each owned by one of the triangles that share it. Features 0 to 2 of a triangle are its edges ab,
// bc, ca; 3 to 5 its vertices a, b, c; 6 is its inside. The ring of feature f, `ring[first[f]]` up to `ring[first[f + 1]]`, holds
// the far vertices of the other triangles that share it: they say where the surface goes on beyond the feature.
struct BvhFeatures {
  static constexpr int inside = 6;
  std::uint32_t owned; // bit f: this triangle owns feature f; always set for the inside
  std::uint32_t first[7];
};

// A rigid pose: world = rotate(rotation, local) + position.
struct Pose {
  Vec3<float> position;
  Vec4<float> rotation;
};

LOAM_FN Vec3<float> to_world(const Pose &pose, Vec3<float> local) { return rotate(pose.rotation, local) + pose.position; }
LOAM_FN Vec3<float> to_local(const Pose &pose, Vec3<float> world) {
  return rotate(conjugate(pose.rotation), world - pose.position);
}

struct ColliderView {
  std::uint32_t kind; // LOAM_COLLIDER_*
  float friction;
  Pose start, end; // at the start and the end of the substep
  // Of a mesh; null for a plane.
  const BvhNode *nodes;
  const TrianglePacket *packets;
  const BvhFeatures *features; // one a triangle
  const Vec3<float> *ring;
};

// True if the collider does not move in this substep. Its displacements are then exactly zero, not the difference of two rounded
// transformations: matter rests on it without noise.
LOAM_FN bool at_rest(const ColliderView &collider) {
  const Pose &s = collider.start, &e = collider.end;
  return s.position.x == e.position.x && s.position.y == e.position.y && s.position.z == e.position.z &&
         s.rotation.x == e.rotation.x && s.rotation.y == e.rotation.y && s.rotation.z == e.rotation.z &&
         s.rotation.w == e.rotation.w;
}

// A half space that a particle must be in at the end of the substep: dot(normal, h v) + gap >= 0, where h v is the particle's motion.
// The gap counts from the particle's place at the start and includes the stand-off and the collider's motion. Being relative, it keeps its
// digits far from the origin.
struct ContactPlane {
  Vec3<float> normal;
  float gap;
  Vec3<float> surface_velocity; // of the collider at the contact point, for friction
  float friction;
};

// The contacts of one particle, closest plane first, with the velocity changes accumulated over the iterations (impulse over mass).
struct Contact {
  static constexpr int max_planes = 4;
  int particle;
  int plane_count;
  float clearance; // a motion that is shorter meets no collider, wherever it goes
  ContactPlane planes[max_planes];
  float normal_change[max_planes];
  Vec3<float> friction_change[max_planes];
};

} // namespace loam
