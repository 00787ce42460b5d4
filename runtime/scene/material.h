// From a host's material definition to a law's parameters.
#pragma once

#include <cstddef>

#include <loam/material.h>

#include "solver/backend.h"

namespace loam {

loam_material_def default_material(std::uint32_t law);

// What loam_material_def was before it had the fields from hardening_modulus on; they are 0 then, which the older laws take for none.
inline constexpr std::size_t first_material_size = offsetof(loam_material_def, hardening_modulus);

// Throws Error INVALID_ARGUMENT naming field, value and range.
void check_material(const loam_material_def &def);

LawVariant make_law(const loam_material_def &def);

// K in Pa.
double bulk_modulus(const loam_material_def &def);

} // namespace loam
