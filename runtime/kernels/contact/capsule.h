// All points within a radius of the segment from (0, -half_height, 0) to (0, half_height, 0).
#pragma once

#include "kernels/contact/surface.h"

namespace loam {

struct CapsuleShape {
  float radius, half_height;

  LOAM_FN Surface surface(Vec3<float> point) const {
    const float along = maximum(0.0f - half_height, minimum(half_height, point.y));
    const Vec3<float> off = {point.x, point.y - along, point.z};
    const float size = length(off);
    // On the axis any direction across it is as near.
    return {size - radius, size > 0.0f ? (1.0f / size) * off : Vec3<float>{1.0f, 0.0f, 0.0f}};
  }
};

} // namespace loam
