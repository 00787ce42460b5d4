// A triangle mesh as the contact kernels see it: a surface, solid on neither side. See mesh_query.h for how it is walked.
#pragma once

#include <cstdint>

#include "math/vector.h"

namespace loam {

// Four triangles that lie together, a lane each; lanes from `count` on repeat the first. Lane k is triangle `first + k`.
struct TrianglePacket {
  static constexpr int width = 4;
  float a[3][width], b[3][width], c[3][width]; // x, y, z of the vertices
  float normal[3][width];
  std::uint32_t first, count;
};

// A node of the bounding volume hierarchy over a mesh's packets: the boxes of four children, which are nodes, packets (top bit set), or
// missing: then the box is empty, at an infinite distance from everything. The root is node 0.
struct alignas(64) BvhNode {
  static constexpr int width = 4;
  static constexpr std::uint32_t leaf = 0x80000000u;
  float centre[3][width], half[3][width]; // x, y, z of the middles and of the half extents
  std::uint32_t child[width];
};

// Edges and vertices of the mesh, each owned by one of the triangles that share it. Features 0 to 2 of a triangle are its edges ab,
// bc, ca; 3 to 5 its vertices a, b, c; 6 is its inside. The ring of feature f, `ring[first[f]]` up to `ring[first[f + 1]]`, holds
// the far vertices of the other triangles that share it: they say where the surface goes on beyond the feature.
struct BvhFeatures {
  static constexpr int inside = 6;
  std::uint32_t owned; // bit f: this triangle owns feature f; always set for the inside
  std::uint32_t first[7];
};

struct MeshShape {
  const BvhNode *nodes;
  const TrianglePacket *packets;
  const BvhFeatures *features; // one a triangle
  const Vec3<float> *ring;
  // Where its vertices move in the substep: the packets at its end, and the most that a vertex moves. The boxes are then around all that the triangles
  // pass. Null: they rest.
  const TrianglePacket *end_packets;
  float motion;
};

} // namespace loam
