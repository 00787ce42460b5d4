// The bounding volume hierarchy over a mesh's triangles, and what the contact kernels want to know of its edges and vertices.
#pragma once

#include <vector>

#include "kernels/contact/triangle_mesh.h"
#include "scene/triangle_mesh.h"

namespace loam {

// A triangle with its unit normal, which is worked out in double precision: the cross product of a sliver's edges would have no correct
// digit left in float.
struct BvhTriangle {
  Vec3<float> a, b, c;
  Vec3<float> normal;
};

// A node of the binary tree. A child index with the top bit set is a triangle. The root is node 0; a mesh of one triangle has a root
// whose second child is an empty box.
struct BinaryNode {
  static constexpr std::uint32_t leaf = 0x80000000u;
  Vec3<float> lower[2]; // boxes of the two children
  Vec3<float> upper[2];
  std::uint32_t child[2];
};

struct BoundingVolumeHierarchy {
  std::vector<BinaryNode> binary;      // parents before children
  std::vector<BvhNode> nodes;          // the same tree for queries, parents before children: see query_tree.h
  std::vector<TrianglePacket> packets; // of consecutive triangles
  std::vector<BvhTriangle> triangles;  // in the order of the tree's leaves
  std::vector<BvhFeatures> features;   // one a triangle
  std::vector<Vec3<float>> ring;       // see BvhFeatures

  // Where the mesh's vertices may move; otherwise empty.
  struct Vertices {
    std::vector<Vec3<float>> positions;
    std::vector<std::uint32_t> of_triangles, of_ring; // three a triangle, one a place in the ring
    std::vector<std::uint32_t> nodes;                 // children before their parents, level by level
    std::vector<std::uint32_t> levels;                // where each begins in `nodes`, and where the last ends
  } vertices;
};

// A linear bounding volume hierarchy: triangles sorted along a Morton curve, the binary radix tree of their codes on top. Throws
// Error OUT_OF_MEMORY.
BoundingVolumeHierarchy build_bounding_volume_hierarchy(const TriangleMesh &mesh, bool deforms = false);

} // namespace loam
