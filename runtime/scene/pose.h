// Rigid poses between two moments.
#pragma once

#include "kernels/contact/pose.h"

namespace loam {

// The pose at a share t of the way from `a` to `b`: constant velocity and constant spin (spherical interpolation).
Pose interpolate(const Pose &a, const Pose &b, double t);

} // namespace loam
