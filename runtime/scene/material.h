// From a host's material definition to a law's parameters.
#pragma once

#include <loam/material.h>

#include "solver/backend.h"

namespace loam {

loam_material_def default_material(std::uint32_t law);

// Throws Error INVALID_ARGUMENT naming field, value and range.
void check_material(const loam_material_def &def);

LawVariant make_law(const loam_material_def &def);

} // namespace loam
