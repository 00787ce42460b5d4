#include "scene/material.h"

#include <cmath>
#include <cstring>

#include "scene/checks.h"
#include "scene/material_presets.h"

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

template <class Law> LawVariant built(std::uint32_t number, const Law &law) {
  if constexpr (IsBuilt<Law>::value)
    return law;
  else
    throw Error(LOAM_ERROR_NOT_BUILT, format("law is %u, which is left out of this build of the library", number));
}

LawVariant make_von_mises(const loam_material_def &def, const Moduli &m) {
  const double in_strain = std::sqrt(2.0 / 3.0) / (2 * m.mu);
  const auto at_yield = static_cast<float>(in_strain * static_cast<double>(def.yield_stress));
  if (def.hardening_modulus == 0.0f) return built(def.law, VonMises{{lame_of(m)}, at_yield});
  return built(
      def.law,
      VonMisesHardening{{lame_of(m)}, at_yield, static_cast<float>(in_strain * static_cast<double>(def.hardening_modulus))});
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

Nacc make_nacc(const loam_material_def &def, const Moduli &m) {
  const double beta = static_cast<double>(def.cohesion_ratio), slope = static_cast<double>(def.critical_state_slope);
  const double squared = slope * slope / (1 + 2 * beta);
  return {{lame_of(m)},
          def.consolidation,
          def.cohesion_ratio,
          def.hardening_factor,
          def.constant_hardness != 0 ? 0.0f : 1.0f,
          static_cast<float>(std::sqrt(1.5) * 2 * m.mu / m.bulk),
          static_cast<float>(squared),
          static_cast<float>(1 / squared)};
}

HerschelBulkley make_herschel_bulkley(const loam_material_def &def, const Moduli &m) {
  const double n = static_cast<double>(def.flow_exponent);
  const double eta = std::exp2((n + 1) / 2) * static_cast<double>(def.consistency);
  return {{lame_of(m)},
          static_cast<float>(std::sqrt(2.0) * static_cast<double>(def.shear_yield_stress) / (2 * m.mu)),
          static_cast<float>(std::fmax(eta / (2 * m.mu), 1e-30)),
          def.flow_exponent};
}

StomakhinSnow make_stomakhin_snow(const loam_material_def &def, const Moduli &m) {
  return {{lame_of(m)},
          static_cast<float>(std::log1p(-static_cast<double>(def.critical_compression))),
          static_cast<float>(std::log1p(static_cast<double>(def.critical_stretch))),
          def.hardening_factor};
}

void check_plasticity(const loam_material_def &def) {
  const auto range = [](const char *field, float value, double least, double most) {
    check_range(field, static_cast<double>(value), least, most);
  };
  switch (def.law) {
  case LOAM_LAW_VON_MISES:
    check_above("yield_stress", static_cast<double>(def.yield_stress), 0, 1e13);
    range("hardening_modulus", def.hardening_modulus, 0, 1e13);
    break;
  case LOAM_LAW_DRUCKER_PRAGER:
    range("friction_angle", def.friction_angle, 0, 1.5);
    range("cohesion", def.cohesion, 0, 1e12);
    break;
  case LOAM_LAW_NACC:
    range("hardening_factor", def.hardening_factor, static_cast<double>(0.1f), 1000);
    // beyond it p0 is bounded; a little room, since hosts divide in single precision
    range("consolidation", def.consolidation, -2.000001 / static_cast<double>(def.hardening_factor), 1);
    range("cohesion_ratio", def.cohesion_ratio, 0, 10);
    range("critical_state_slope", def.critical_state_slope, static_cast<double>(0.01f), 10);
    check_choice("constant_hardness", def.constant_hardness, 1);
    break;
  case LOAM_LAW_HERSCHEL_BULKLEY:
    range("shear_yield_stress", def.shear_yield_stress, 0, 1e13);
    check_above("consistency", static_cast<double>(def.consistency), 0, 1e13);
    range("flow_exponent", def.flow_exponent, static_cast<double>(0.1f), 10);
    break;
  case LOAM_LAW_STOMAKHIN_SNOW:
    range("critical_compression", def.critical_compression, 0, static_cast<double>(0.39f));
    range("critical_stretch", def.critical_stretch, 0, static_cast<double>(0.64f));
    range("hardening_factor", def.hardening_factor, 0, 1000);
    break;
  case LOAM_LAW_FLUID:
    range("viscosity", def.viscosity, 0, 1e9);
    range("surface_tension", def.surface_tension, 0, 1e9);
    range("adhesion", def.adhesion, 0, 1e9);
    range("vorticity_confinement", def.vorticity_confinement, 0, 1);
    break;
  default:
    break;
  }
}

} // namespace

loam_material_def default_material(std::uint32_t law) {
  check_choice("law", law, LOAM_LAW_FLUID);
  if (law == LOAM_LAW_NACC) return preset("packed snow");
  if (law == LOAM_LAW_HERSCHEL_BULKLEY) return preset("shaving foam");
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
  case LOAM_LAW_FLUID:
    name = "water";
    def.density = 1000;
    def.poissons_ratio = 0;
    break;
  case LOAM_LAW_STOMAKHIN_SNOW:
    name = "snow";
    def.density = 400;
    def.youngs_modulus = 1.4e5f;
    def.poissons_ratio = 0.2f;
    def.hardening_factor = 10;
    def.critical_compression = 0.025f;
    def.critical_stretch = 0.0075f;
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
  check_choice("law", def.law, LOAM_LAW_FLUID);
  check_range("density", static_cast<double>(def.density), 1e-3, 1e6);
  if (def.law != LOAM_LAW_FLUID) check_range("youngs_modulus", static_cast<double>(def.youngs_modulus), 1, 1e13);
  if (def.law != LOAM_LAW_FLUID)
    check_range("poissons_ratio", static_cast<double>(def.poissons_ratio), 0, static_cast<double>(0.49f));
  check_plasticity(def);
  if (std::memchr(def.name, 0, sizeof def.name) == nullptr)
    throw Error(LOAM_ERROR_INVALID_ARGUMENT, format("name is not terminated within its %zu bytes", sizeof def.name));
  static_cast<void>(make_law(def)); // refuses laws that are left out
}

double wave_speed(const loam_material_def &def) {
  if (def.law == LOAM_LAW_FLUID) return 0;
  const Moduli m = moduli_of(def);
  return std::sqrt((m.lambda + 2 * m.mu) / static_cast<double>(def.density));
}

double stiffness_share(const loam_material_def &def, double kernel_radius, double substep, std::uint32_t iterations) {
  if (def.law == LOAM_LAW_FLUID) return 1; // it has no stiffness
  const Moduli m = moduli_of(def);
  const double speed = iterations * kernel_radius / substep;
  const double most = static_cast<double>(def.density) * speed * speed;
  return std::fmin(1.0, most / (m.lambda + 2 * m.mu));
}

LawVariant make_law(const loam_material_def &given, double stiffness_share) {
  loam_material_def def = given;
  if (stiffness_share < 1)
    def.youngs_modulus = static_cast<float>(stiffness_share * static_cast<double>(def.youngs_modulus));
  const Moduli m = moduli_of(def);
  switch (def.law) {
  case LOAM_LAW_ELASTIC:
    return Elastic{{lame_of(m)}};
  case LOAM_LAW_VON_MISES:
    return make_von_mises(def, m);
  case LOAM_LAW_NACC:
    return built(def.law, make_nacc(def, m));
  case LOAM_LAW_HERSCHEL_BULKLEY:
    return built(def.law, make_herschel_bulkley(def, m));
  case LOAM_LAW_FLUID:
    return built(def.law, Fluid{{{0, 0}},
                                def.density,
                                def.viscosity / def.density,
                                def.surface_tension / def.density,
                                def.adhesion,
                                def.vorticity_confinement});
  case LOAM_LAW_STOMAKHIN_SNOW:
    return built(def.law, make_stomakhin_snow(def, m));
  default:
    return built(def.law, make_drucker_prager(def, m));
  }
}

double bulk_modulus(const loam_material_def &def) { return moduli_of(def).bulk; }

} // namespace loam
