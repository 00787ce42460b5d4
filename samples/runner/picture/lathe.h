// Turns an upright cylinder with rounded edges into triangles.
#pragma once

#include "mesh.h"

namespace runner {

// Centred at the origin, along y. 0 <= rounding <= radius and half_height.
Mesh make_rounded_cylinder(float radius, float half_height, float rounding);

} // namespace runner
