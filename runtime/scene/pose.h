// Rigid poses: between two moments, and from the host.
#pragma once

#include "kernels/contact/pose.h"

namespace loam {

// The pose at a share t of the way from `a` to `b`: constant velocity and constant spin (spherical interpolation).
Pose interpolate(const Pose &a, const Pose &b, double t);

// A pose that the host gave. Throws Error naming what is not finite or has no direction.
Pose make_pose(const float position[3], const float rotation[4]);

} // namespace loam
