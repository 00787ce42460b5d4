// What the contact kernels see of a collider and of a particle's contacts: plain data for either machine.
#pragma once

#include <cstdint>

#include "math/vector.h"

namespace loam {

// A node of the bounding volume hierarchy over a mesh's triangles. Internal nodes first; a child index with the top bit set is a
// triangle.
struct BvhNode {
  Vec3<float> lower[2]; // boxes of the two children
  Vec3<float> upper[2];
  std::uint32_t child[2];
};

struct BvhTriangle {
  Vec3<float> a, b, c;
};

// A rigid pose: world = rotate(rotation, local) + position.
struct Pose {
  Vec3<float> position;
  Vec4<float> rotation;
};

struct ColliderView {
  std::uint32_t kind; // LOAM_COLLIDER_*
  float friction;
  Pose start, end; // at the start and the end of the substep
  const BvhNode *nodes;
  const BvhTriangle *triangles;
  int triangle_count;
};

// A half space that a particle must stay in during the substep: dot(normal, x) >= offset at the end of it, offset including the
// stand-off and the collider's motion.
struct ContactPlane {
  Vec3<float> normal;
  float offset;
  Vec3<float> surface_velocity; // of the collider at the contact point, for friction
  float friction;
};

// The contacts of one particle, with the velocity changes accumulated over the iterations (impulse over mass).
struct Contact {
  static constexpr int max_planes = 4;
  int particle;
  int plane_count;
  ContactPlane planes[max_planes];
  float normal_change[max_planes];
  Vec3<float> friction_change[max_planes];
};

} // namespace loam
