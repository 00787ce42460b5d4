// A solid box about the origin, along the axes.
#pragma once

#include "kernels/contact/surface.h"

namespace loam {

struct BoxShape {
  Vec3<float> half_extents;

  LOAM_FN Surface surface(Vec3<float> point) const {
    const Vec3<float> beyond = {absolute(point.x) - half_extents.x, absolute(point.y) - half_extents.y,
                                absolute(point.z) - half_extents.z};
    const Vec3<float> out = {maximum(beyond.x, 0.0f), maximum(beyond.y, 0.0f), maximum(beyond.z, 0.0f)};
    const Vec3<float> side = {point.x < 0.0f ? -1.0f : 1.0f, point.y < 0.0f ? -1.0f : 1.0f, point.z < 0.0f ? -1.0f : 1.0f};
    const float size = length(out);
    if (size > 0.0f) return {size, (1.0f / size) * Vec3<float>{side.x * out.x, side.y * out.y, side.z * out.z}};
    // Inside, the nearest face.
    if (beyond.x >= beyond.y && beyond.x >= beyond.z) return {beyond.x, {side.x, 0.0f, 0.0f}};
    if (beyond.y >= beyond.z) return {beyond.y, {0.0f, side.y, 0.0f}};
    return {beyond.z, {0.0f, 0.0f, side.z}};
  }
};

} // namespace loam
