// From a host's definition of a collider to its shape, checked.
#pragma once

#include <loam/collider.h>

#include "solver/collider_shape.h"

namespace loam {

// `report` receives what was found in a mesh. Throws Error INVALID_ARGUMENT naming the field, INVALID_MESH, OUT_OF_MEMORY.
ColliderShape make_collider_shape(const loam_collider_def &def, loam_collider_report &report);

} // namespace loam
