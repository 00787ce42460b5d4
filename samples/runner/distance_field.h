// A closed mesh as signed distances on a grid, for colliders of kind "grid".
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "mesh.h"
#include "vector.h"

namespace runner {

struct DistanceField {
  std::vector<float> values; // x fastest, then y, then z; under 0 inside
  Vector3 origin;            // of the first value
  float spacing = 0;
  std::array<std::uint32_t, 3> size{};

  // Trilinear, in double precision; what is outside of the grid is far outside of the mesh.
  double at(Vector3d point) const;
};

// Distances are exact up to `band`, and not over it beyond. Throws Error if the mesh is not closed or the grid would have more than 2^26 points.
DistanceField make_distance_field(const Mesh &mesh, float spacing, float band);

} // namespace runner
