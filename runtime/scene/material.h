// From a host's material definition to a law's parameters.
#pragma once

#include <cstddef>
#include <initializer_list>

#include <loam/material.h>

#include "solver/backend.h"

namespace loam {

loam_material_def default_material(std::uint32_t law);

// What loam_material_def was before it had the fields from hardening_modulus on, before it had those of fluids, and before vorticity confinement; they are 0
// then, which the laws take for none.
inline constexpr std::initializer_list<std::size_t> earlier_material_sizes = {
    offsetof(loam_material_def, hardening_modulus), offsetof(loam_material_def, viscosity),
    offsetof(loam_material_def, vorticity_confinement)};

// Throws Error INVALID_ARGUMENT naming field, value and range.
void check_material(const loam_material_def &def);

// `stiffness_share`: of Young's modulus; stresses at yield stay.
LawVariant make_law(const loam_material_def &def, double stiffness_share = 1);

// The share of a material's stiffness that a substep can carry. Elastic waves cross c h / r particles in a substep, and impulses about one an
// iteration; beyond that an unconverged step stores up to (c h / r)^2 times the energy of an impact, and gives it back: bodies of rubber that hit hard burst.
// So c is bounded; matter is then softer, which without the bound it would be too, for want of iterations, but wildly.
double stiffness_share(const loam_material_def &def, double kernel_radius, double substep, std::uint32_t iterations);

// Of pressure waves, m/s; 0 for fluids, whose pressure is solved for.
double wave_speed(const loam_material_def &def);

// K in Pa.
double bulk_modulus(const loam_material_def &def);

} // namespace loam
