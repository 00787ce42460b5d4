// Meshes of the colliders that have none of their own, to be looked at.
#pragma once

#include "mesh.h"
#include "vector.h"

namespace runner {

// Counter-clockwise seen from outside.
Mesh make_box(Vector3 half_extents);
// About the y axis; of half height 0 it is a ball.
Mesh make_capsule(float radius, float half_height);

} // namespace runner
