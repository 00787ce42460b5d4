// Particles as binary little-endian PLY: x, y, z, vx, vy, vz (float), id, material (uint).
#pragma once

#include <string>

#include "particles.h"

namespace runner {

// The bytes of the file. `comment` is one line.
std::string make_ply(const Particles &particles, const std::string &comment);

} // namespace runner
