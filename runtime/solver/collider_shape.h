// The shape of a collider as the scene hands it to the solver, in its own frame.
#pragma once

#include <variant>
#include <vector>

#include "kernels/contact/shape.h"
#include "scene/bounding_volume_hierarchy.h"

namespace loam {

struct ConvexHull {
  std::vector<HullFace> faces;
};

struct DistanceGrid {
  std::vector<float> values;
  GridShape shape; // without the values
};

using ColliderShape =
    std::variant<PlaneShape, SphereShape, CapsuleShape, BoxShape, ConvexHull, DistanceGrid, BoundingVolumeHierarchy>;

} // namespace loam
