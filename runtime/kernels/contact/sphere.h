// A ball about the origin.
#pragma once

#include "kernels/contact/surface.h"

namespace loam {

struct SphereShape {
  float radius;

  LOAM_FN Surface surface(Vec3<float> point) const {
    const float size = length(point);
    return {size - radius, direction_of(point, size)};
  }
};

} // namespace loam
