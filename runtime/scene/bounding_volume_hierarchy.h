// The bounding volume hierarchy over a mesh's triangles, and what the contact kernels want to know of its edges and vertices.
#pragma once

#include <vector>

#include "kernels/contact/collider_view.h"
#include "scene/triangle_mesh.h"

namespace loam {

struct BoundingVolumeHierarchy {
  std::vector<BvhNode> nodes;         // parents before children
  std::vector<BvhTriangle> triangles; // in the order of the tree's leaves
  std::vector<BvhFeatures> features;  // one a triangle
  std::vector<Vec3<float>> ring;      // see BvhFeatures
};

// A linear bounding volume hierarchy: triangles sorted along a Morton curve, the binary radix tree of their codes on top. Throws
// Error OUT_OF_MEMORY.
BoundingVolumeHierarchy build_bounding_volume_hierarchy(const TriangleMesh &mesh);

} // namespace loam
