// What the contact kernels see of a collider and of a particle's contacts: plain data for either machine.
#pragma once

#include <cstdint>

#include "kernels/contact/contact_law.h"
#include "kernels/contact/pose.h"
#include "kernels/contact/shape.h"

namespace loam {

struct ColliderView {
  ContactLaw law;                 // with all materials
  const ContactLaw *of_materials; // with each, by its number; null where one law holds for all
  Pose start, end;                // at the start and the end of the substep
  Shape shape;
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
  int collider;
  float hold; // the plane may pull by so much, as a velocity change: 0 unless it is sticky
};

// The contacts of one particle, closest plane first, with the velocity changes accumulated over the iterations (impulse over mass).
struct Contact {
  static constexpr int max_planes = 4;
  int particle;
  int plane_count;
  float depth;     // m: how much is missing to the stand-off, at the start of the substep; 0 where nothing is
  float clearance; // a motion that is shorter meets no collider, wherever it goes
  ContactPlane planes[max_planes];
  float normal_change[max_planes];
  Vec3<float> friction_change[max_planes];
};

} // namespace loam
