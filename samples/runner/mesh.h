// A triangle mesh as read from a file, in its own frame.
#pragma once

#include <cstdint>
#include <vector>

#include "vector.h"

namespace runner {

struct Mesh {
  std::vector<Vector3> vertices;
  std::vector<std::uint32_t> indices; // three a triangle
  std::size_t triangle_count() const { return indices.size() / 3; }
};

} // namespace runner
