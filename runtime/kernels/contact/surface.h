// What a solid shape says of a point near it. All shapes live in their own frame and answer with the signed distance to their surface, under 0
// inside, and the outward normal at the nearest point of the surface, which is the point less distance * normal.
#pragma once

#include "math/vector.h"

namespace loam {

struct Surface {
  float distance;
  Vec3<float> normal;
};

// The direction of a vector that is known to be nearly never zero; then it is the y axis.
LOAM_FN Vec3<float> direction_of(Vec3<float> v, float size) {
  return size > 0.0f ? (1.0f / size) * v : Vec3<float>{0.0f, 1.0f, 0.0f};
}

} // namespace loam
