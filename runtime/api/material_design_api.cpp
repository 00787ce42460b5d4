#include "api/guard.h"
#include "scene/material.h"
#include "scene/material_design.h"
#include "scene/material_presets.h"

using namespace loam;

namespace {

template <class F> loam_status answer(float *result, const char *name, F &&formula) {
  return guarded(nullptr, [&] {
    check_pointer(result, name);
    *result = formula();
  });
}

} // namespace

loam_status loam_material_def_preset(const char *name, loam_material_def *def, size_t size) {
  return guarded(nullptr, [&] {
    check_pointer(name, "name");
    write_definition(def, "def", size, preset(name), earlier_material_sizes);
  });
}

const char *loam_material_preset_name(uint32_t index) { return preset_name(index); }

loam_status loam_design_friction_angle(float angle_of_repose, float *friction_angle) {
  return answer(friction_angle, "friction_angle", [&] { return friction_angle_of_slope(angle_of_repose); });
}

loam_status loam_design_youngs_modulus(float density, float gravity, float height, float sinking, float *youngs_modulus) {
  return answer(youngs_modulus, "youngs_modulus",
                [&] { return youngs_modulus_of_column(density, gravity, height, sinking); });
}

loam_status loam_design_yield_stress(float density, float gravity, float height, float *yield_stress) {
  return answer(yield_stress, "yield_stress", [&] { return yield_stress_of_column(density, gravity, height); });
}

loam_status loam_design_shear_yield_stress(float density, float gravity, float height, float *shear_yield_stress) {
  return answer(shear_yield_stress, "shear_yield_stress",
                [&] { return 0.577350269f * yield_stress_of_column(density, gravity, height); });
}

loam_status loam_design_puddle_yield_stress(float density, float gravity, float volume, float radius,
                                            float *shear_yield_stress) {
  return answer(shear_yield_stress, "shear_yield_stress",
                [&] { return shear_yield_stress_of_puddle(density, gravity, volume, radius); });
}

loam_status loam_design_consistency(float density, float gravity, float shear_yield_stress, float flow_exponent,
                                    float thickness, float slope, float speed, float *consistency) {
  return answer(consistency, "consistency", [&] {
    return consistency_of_film({density, gravity, shear_yield_stress, flow_exponent, thickness, slope, speed});
  });
}

loam_status loam_design_strengths(loam_material_def *def, float compressive, float tensile, float friction_angle,
                                  float opening) {
  return guarded(nullptr, [&] {
    const loam_material_def given = read_definition(def, "def", loam_material_def{});
    write_definition(def, "def", def->struct_size, with_strengths(given, {compressive, tensile, friction_angle, opening}));
  });
}
