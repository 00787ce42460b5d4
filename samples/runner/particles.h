// A frame's particles on the host, in the order of their ids.
#pragma once

#include <cstdint>
#include <vector>

#include "vector.h"

namespace runner {

struct Particles {
  std::vector<std::uint32_t> ids; // ascending
  std::vector<Vector3> positions;
  std::vector<Vector3> velocities;
  std::vector<std::uint32_t> materials; // index into the scene's materials
  std::vector<std::uint32_t> emitters;  // index into the scene's emitters
  std::size_t count() const { return ids.size(); }
};

} // namespace runner
