// A rigid pose: world = rotate(rotation, local) + position.
#pragma once

#include "math/vector.h"

namespace loam {

struct Pose {
  Vec3<float> position;
  Vec4<float> rotation;
};

LOAM_FN Vec3<float> to_world(const Pose &pose, Vec3<float> local) { return rotate(pose.rotation, local) + pose.position; }
LOAM_FN Vec3<float> to_local(const Pose &pose, Vec3<float> world) {
  return rotate(conjugate(pose.rotation), world - pose.position);
}

} // namespace loam
