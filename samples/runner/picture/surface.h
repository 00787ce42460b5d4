// A smooth surface around particles that are one body of matter.
#pragma once

#include <vector>

#include "mesh.h"

namespace runner {

// `spacing` is about the distance between neighbours, over 0. Particles that are not finite are left out. The surface is closed; its
// triangles are counter-clockwise seen from outside.
Mesh make_surface(const std::vector<Vector3> &particles, float spacing);

} // namespace runner
