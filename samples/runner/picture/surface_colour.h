// The colours of things: grains that differ, wood with its rings.
#pragma once

#include <cstdint>

#include "vector.h"

namespace runner {

// The colour of one grain of a material; `variation` is the share by which grains differ.
Vector3 grain_colour(Vector3 colour, float variation, std::uint32_t id);

// Wood turned on a lathe and cut along x, at a point relative to the piece's centre. `size` is the width of a ring.
Vector3 wood_colour(Vector3 colour, Vector3 point, float size);

// Boards side by side on the ground; `width` is that of a board, and `across` lies in the ground.
Vector3 plank_colour(Vector3 colour, Vector3 point, const Frame &across, float width);

// Square tiles with joints between them.
Vector3 tile_colour(Vector3 colour, Vector3 point, const Frame &across, float width);

} // namespace runner
