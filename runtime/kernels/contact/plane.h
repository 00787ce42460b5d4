// The half space y <= 0.
#pragma once

#include "kernels/contact/surface.h"

namespace loam {

struct PlaneShape {
  LOAM_FN Surface surface(Vec3<float> point) const { return {point.y, {0.0f, 1.0f, 0.0f}}; }
};

} // namespace loam
