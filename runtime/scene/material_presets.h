// Materials known by name.
#pragma once

#include <cstdint>

#include <loam/material.h>

namespace loam {

// Throws Error INVALID_ARGUMENT listing the names there are.
loam_material_def preset(const char *name);

// Null past the last.
const char *preset_name(std::uint32_t index);

} // namespace loam
