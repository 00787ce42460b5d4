#include "scene/material_design.h"

#include <cmath>

#include "scene/checks.h"
#include "scene/material.h"

namespace loam {

namespace {

constexpr double half_pi = 1.57079632679489662;

double positive(const char *name, float value, double most = 1e12) {
  check_above(name, static_cast<double>(value), 0, most);
  return static_cast<double>(value);
}

// Results are single precision too: arguments that are each in range may leave it together.
float narrow(const char *what, double value) {
  if (!(value >= 1e-30 && value <= 1e30))
    throw Error(LOAM_ERROR_INVALID_ARGUMENT,
                format("these values give a %s of %g, beyond what a float can hold", what, value));
  return static_cast<float>(value);
}

double slope_of(double friction_angle) { return 6 * std::sin(friction_angle) / (3 - std::sin(friction_angle)); }

} // namespace

float friction_angle_of_slope(float angle_of_repose) {
  // The steepest slope of friction angles up to 1.5.
  check_above("angle_of_repose", static_cast<double>(angle_of_repose), 0, static_cast<double>(1.04f));
  const double tangent = std::tan(static_cast<double>(angle_of_repose));
  return narrow("friction_angle", std::asin(3 * tangent / (2 * std::sqrt(3.0) + tangent)));
}

float youngs_modulus_of_column(float density, float gravity, float height, float sinking) {
  const double weight = positive("density", density) * positive("gravity", gravity), h = positive("height", height);
  return narrow("youngs_modulus", weight * h * h / (2 * positive("sinking", sinking, h / 10)));
}

float yield_stress_of_column(float density, float gravity, float height) {
  return narrow("yield_stress", positive("density", density) * positive("gravity", gravity) * positive("height", height));
}

float shear_yield_stress_of_puddle(float density, float gravity, float volume, float radius) {
  const double weight = positive("density", density) * positive("gravity", gravity);
  const double v = positive("volume", volume), r = positive("radius", radius);
  return narrow("shear_yield_stress", 225 * weight * v * v / (128 * 4 * half_pi * half_pi * std::pow(r, 5)));
}

float consistency_of_film(const Film &film) {
  const double weight = positive("density", film.density) * positive("gravity", film.gravity);
  check_range("shear_yield_stress", static_cast<double>(film.shear_yield_stress), 0, 1e12);
  check_range("flow_exponent", static_cast<double>(film.flow_exponent), static_cast<double>(0.1f), 10);
  const double thickness = positive("thickness", film.thickness), n = static_cast<double>(film.flow_exponent);
  const double pull = weight * std::sin(positive("slope", film.slope, half_pi + 1e-6)),
               speed = positive("speed", film.speed);
  const double plug = static_cast<double>(film.shear_yield_stress) / pull, sheared = thickness - plug;
  if (!(sheared > 0))
    throw Error(LOAM_ERROR_INVALID_ARGUMENT,
                format("thickness is %g; it must be over %g, or the film does not flow", thickness, plug));
  return narrow("consistency", pull * std::pow(n / (n + 1) * std::pow(sheared, (n + 1) / n) / speed, n));
}

loam_material_def with_strengths(loam_material_def def, const Strengths &strengths) {
  if (def.law != LOAM_LAW_NACC)
    throw Error(LOAM_ERROR_INVALID_ARGUMENT,
                format("law is %u; strengths are of LOAM_LAW_NACC (%u)", def.law, unsigned(LOAM_LAW_NACC)));
  check_range("youngs_modulus", static_cast<double>(def.youngs_modulus), 1, 1e13);
  check_range("poissons_ratio", static_cast<double>(def.poissons_ratio), 0, static_cast<double>(0.49f));
  const double bulk = bulk_modulus(def);
  check_range("compressive", static_cast<double>(strengths.compressive), 1e-4 * bulk, 3.6 * bulk);
  check_range("tensile", static_cast<double>(strengths.tensile), 0, 10 * static_cast<double>(strengths.compressive));
  check_above("friction_angle", static_cast<double>(strengths.friction_angle), 0, 1.5);
  check_range("opening", static_cast<double>(strengths.opening), static_cast<double>(1e-4f), 0.5);
  const double opening = std::log1p(static_cast<double>(strengths.opening));
  def.hardening_factor = static_cast<float>(std::asinh(static_cast<double>(strengths.compressive) / bulk - 1e-5) / opening);
  def.consolidation = static_cast<float>(-opening);
  def.cohesion_ratio = strengths.tensile / strengths.compressive;
  def.critical_state_slope = static_cast<float>(slope_of(static_cast<double>(strengths.friction_angle)));
  check_range("hardening_factor of these strengths", static_cast<double>(def.hardening_factor), static_cast<double>(0.1f),
              1000);
  return def;
}

} // namespace loam
