// A smooth surface around particles that are one body of matter.
#pragma once

#include <functional>
#include <vector>

#include "mesh.h"

namespace runner {

// How far from a point along a direction of length 1 something is met that the surface must not pass, such as cloth; at least `limit` if nothing is within it.
using Barrier = std::function<float(Vector3 from, Vector3 direction, float limit)>;

// `spacing` is about the distance between neighbours, over 0. Particles that are not finite are left out. The surface is closed; its
// triangles are counter-clockwise seen from outside.
Mesh make_surface(const std::vector<Vector3> &particles, float spacing, const Barrier &barrier = {});

} // namespace runner
