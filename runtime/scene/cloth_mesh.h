// A cloth's mesh as the host described it, checked, with what its constraints are made from.
#pragma once

#include <cstdint>
#include <vector>

#include <loam/collider.h>

#include "math/vector.h"

namespace loam {

// Two triangles that share the edge from vertex 0 to vertex 1; vertex 2 is the first's third, vertex 3 the other's.
struct ClothHinge {
  int vertex[4];
  int triangle[2];
};

struct ClothEdge {
  int from, to;
  int triangle; // one of its triangles
  float area;   // of its triangles together, m^2
};

struct ClothMesh {
  std::vector<Vec3<float>> vertices; // in the mesh's frame, in the host's order
  std::vector<int> triangles;        // three vertices each, in the host's order
  std::vector<float> areas;          // of the triangles, m^2
  std::vector<ClothEdge> edges;
  std::vector<ClothHinge> hinges;
};

// Throws Error INVALID_ARGUMENT for null arrays, vertices that are not finite, indices out of range; INVALID_MESH, naming the place, for vertices that lie in one place or
// belong to no triangle, triangles without area, edges of more than two triangles or of two that disagree on the orientation.
ClothMesh make_cloth_mesh(const loam_mesh &mesh);

} // namespace loam
