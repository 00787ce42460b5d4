// A triangle mesh as the host described it, checked and cleaned, in its own frame.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <loam/collider.h>

#include "math/vector.h"

namespace loam {

struct TriangleMesh {
  std::vector<Vec3<float>> vertices;
  std::vector<std::uint32_t> indices; // three a triangle; degenerate triangles are gone
  loam_collider_report report{};
  std::string first_flaw; // names the first open or non-manifold edge, for messages; empty if closed
};

// Throws Error INVALID_ARGUMENT naming `field`, index and value of what is not finite or too large.
void check_vertices(const float *positions, std::uint32_t vertex_count, const char *field);

// Copies and checks. `field` names the mesh in messages, such as "mesh" or "region.mesh". Throws Error INVALID_ARGUMENT for null arrays,
// NaN vertices, indices out of range; INVALID_MESH if no usable triangle is left.
TriangleMesh make_triangle_mesh(const loam_mesh &mesh, const char *field);

} // namespace loam
