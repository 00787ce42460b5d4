#include "scene/material.h"

#include <cmath>
#include <cstring>

#include "scene/checks.h"

namespace loam {

namespace {

struct Moduli {
  double mu, lambda, bulk;
};

Moduli moduli_of(const loam_material_def &def) {
  const double E = static_cast<double>(def.youngs_modulus), nu = static_cast<double>(def.poissons_ratio);
  const double mu = E / (2 * (1 + nu)), lambda = E * nu / ((1 + nu) * (1 - 2 * nu));
  return {mu, lambda, lambda + 2 * mu / 3};
}

LameParameters lame_of(const Moduli &m) { return {static_cast<float>(m.mu), static_cast<float>(m.lambda)}; }

VonMises make_von_mises(const loam_material_def &def, const Moduli &m) {
  const double bound = std::sqrt(2.0 / 3.0) * static_cast<double>(def.yield_stress);
  return {{lame_of(m)}, static_cast<float>(bound / (2 * m.mu))};
}

DruckerPrager make_drucker_prager(const loam_material_def &def, const Moduli &m) {
  const double sine = std::sin(static_cast<double>(def.friction_angle)),
               cosine = std::cos(static_cast<double>(def.friction_angle));
  const double alpha = std::sqrt(2.0 / 3.0) * 2 * sine / (3 - sine), slope = alpha * 3 * m.bulk / (2 * m.mu);
  // slope * tip with tip = c cot(phi) / K stays finite as phi goes to 0
  const double cohesive =
      std::sqrt(2.0 / 3.0) * 2 * cosine / (3 - sine) * 3 * static_cast<double>(def.cohesion) / (2 * m.mu);
  const double tip = sine > 1e-6 ? cohesive / slope : (cohesive > 0 ? 1.0 : 0.0);
  return {{lame_of(m)}, static_cast<float>(slope), static_cast<float>(cohesive), static_cast<float>(std::fmin(tip, 1.0))};
}

} // namespace

loam_material_def default_material(std::uint32_t law) {
  check_choice("law", law, LOAM_LAW_DRUCKER_PRAGER);
  loam_material_def def = {};
  def.struct_size = sizeof def;
  def.law = law;
  def.poissons_ratio = 0.3f;
  const char *name = "";
  switch (law) {
  case LOAM_LAW_ELASTIC:
    name = "rubber";
    def.density = 1000;
    def.youngs_modulus = 1e5f;
    break;
  case LOAM_LAW_VON_MISES:
    name = "plasticine";
    def.density = 1500;
    def.youngs_modulus = 1e6f;
    def.yield_stress = 5e3f;
    break;
  default:
    name = "dry sand";
    def.density = 1600;
    def.youngs_modulus = 1e6f;
    def.friction_angle = 0.523598776f;
    break;
  }
  std::strncpy(def.name, name, sizeof def.name - 1);
  return def;
}

void check_material(const loam_material_def &def) {
  check_choice("law", def.law, LOAM_LAW_DRUCKER_PRAGER);
  check_range("density", static_cast<double>(def.density), 1e-3, 1e6);
  check_range("youngs_modulus", static_cast<double>(def.youngs_modulus), 1, 1e13);
  check_range("poissons_ratio", static_cast<double>(def.poissons_ratio), 0, static_cast<double>(0.49f));
  if (def.law == LOAM_LAW_VON_MISES) check_above("yield_stress", static_cast<double>(def.yield_stress), 0, 1e13);
  if (def.law == LOAM_LAW_DRUCKER_PRAGER) {
    check_range("friction_angle", static_cast<double>(def.friction_angle), 0, 1.5);
    check_range("cohesion", static_cast<double>(def.cohesion), 0, 1e12);
  }
  if (std::memchr(def.name, 0, sizeof def.name) == nullptr)
    throw Error(LOAM_ERROR_INVALID_ARGUMENT, format("name is not terminated within its %zu bytes", sizeof def.name));
}

LawVariant make_law(const loam_material_def &def) {
  const Moduli m = moduli_of(def);
  switch (def.law) {
  case LOAM_LAW_ELASTIC:
    return Elastic{{lame_of(m)}};
  case LOAM_LAW_VON_MISES:
    return make_von_mises(def, m);
  default:
    return make_drucker_prager(def, m);
  }
}

} // namespace loam
