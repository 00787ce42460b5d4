// Formulas from what can be seen of matter to the parameters of its law; include/loam/material_design.h says what each is. All throw Error
// INVALID_ARGUMENT naming the argument.
#pragma once

#include <loam/material.h>

namespace loam {

float friction_angle_of_slope(float angle_of_repose);
float youngs_modulus_of_column(float density, float gravity, float height, float sinking);
float yield_stress_of_column(float density, float gravity, float height);
float shear_yield_stress_of_puddle(float density, float gravity, float volume, float radius);

struct Film {
  float density, gravity, shear_yield_stress, flow_exponent, thickness, slope, speed;
};
float consistency_of_film(const Film &film);

struct Strengths {
  float compressive, tensile, friction_angle, opening;
};
loam_material_def with_strengths(loam_material_def def, const Strengths &strengths);

} // namespace loam
