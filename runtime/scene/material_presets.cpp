#include "scene/material_presets.h"

#include <cstring>
#include <iterator>
#include <string>

#include "scene/error.h"

namespace loam {

namespace {

struct Elasticity {
  float density, youngs_modulus, poissons_ratio;
};

constexpr loam_material_def of_law(std::uint32_t law, const Elasticity &elasticity) {
  loam_material_def def = {};
  def.struct_size = sizeof def;
  def.law = law;
  def.density = elasticity.density;
  def.youngs_modulus = elasticity.youngs_modulus;
  def.poissons_ratio = elasticity.poissons_ratio;
  return def;
}

constexpr loam_material_def granular(const Elasticity &elasticity, float friction_angle, float cohesion) {
  loam_material_def def = of_law(LOAM_LAW_DRUCKER_PRAGER, elasticity);
  def.friction_angle = friction_angle;
  def.cohesion = cohesion;
  return def;
}

constexpr loam_material_def ductile(const Elasticity &elasticity, float yield_stress, float hardening_modulus) {
  loam_material_def def = of_law(LOAM_LAW_VON_MISES, elasticity);
  def.yield_stress = yield_stress;
  def.hardening_modulus = hardening_modulus;
  return def;
}

constexpr loam_material_def brittle(const Elasticity &elasticity, float consolidation, float cohesion_ratio,
                                    float hardening_factor, float critical_state_slope) {
  loam_material_def def = of_law(LOAM_LAW_NACC, elasticity);
  def.consolidation = consolidation;
  def.cohesion_ratio = cohesion_ratio;
  def.hardening_factor = hardening_factor;
  def.critical_state_slope = critical_state_slope;
  return def;
}

constexpr loam_material_def viscoplastic(const Elasticity &elasticity, float shear_yield_stress, float consistency,
                                         float flow_exponent) {
  loam_material_def def = of_law(LOAM_LAW_HERSCHEL_BULKLEY, elasticity);
  def.shear_yield_stress = shear_yield_stress;
  def.consistency = consistency;
  def.flow_exponent = flow_exponent;
  return def;
}

constexpr loam_material_def snow(const Elasticity &elasticity, float hardening_factor, float critical_compression,
                                 float critical_stretch) {
  loam_material_def def = of_law(LOAM_LAW_STOMAKHIN_SNOW, elasticity);
  def.hardening_factor = hardening_factor;
  def.critical_compression = critical_compression;
  def.critical_stretch = critical_stretch;
  return def;
}

constexpr loam_material_def fluid(float density) { return of_law(LOAM_LAW_FLUID, {density, 1e6f, 0.3f}); }

struct Preset {
  const char *name;
  loam_material_def def; // without its name
};

// Densities, strengths and viscosities are of the order of the real matter's, rounded; where its range is wide, from the middle. Young's moduli are
// lowered to what still looks stiff in a scene of a metre.
constexpr Preset presets[] = {
    {"dry sand", granular({1600, 1e6f, 0.3f}, 0.523598776f, 0)},
    // Grains held by films of water: about a kilopascal (Mitarai and Nori 2006). A wall of 0.4 m stands.
    {"wet sand", granular({1900, 1e6f, 0.3f}, 0.575958653f, 1e3f)},
    // Settled snow, of the order of 20 kPa from all sides and 10 kPa in tension.
    {"packed snow", brittle({400, 1e6f, 0.3f}, -0.0024f, 0.5f, 10, 1.4f)},
    // The powdery end of the parameters of Stomakhin et al. 2013, at the density of fresh dry snow.
    {"powder snow", snow({150, 5e4f, 0.2f}, 5, 0.019f, 0.005f)},
    {"plasticine", ductile({1850, 2e6f, 0.4f}, 6e4f, 0)},
    // 6061-T6: 69 GPa, yield 276 MPa, from there to 310 MPa over a strain of 0.08. All of it over 10000: it yields at the real strain.
    {"aluminium", ductile({2700, 6.9e6f, 0.33f}, 2.76e4f, 4e4f)},
    // Boiled sugar is a glass: it gives at 50 kPa here, so that a drop of a metre breaks it, and at once.
    {"candy", brittle({1500, 1e6f, 0.3f}, -0.002f, 0.8f, 30, 1.2f)},
    // A yield stress of some tens of pascals and strong thinning, as Yue et al. 2015 have it.
    {"shaving foam", viscoplastic({78, 850, 0.45f}, 18.4f, 17.8f, 0.22f)},
    {"paint", viscoplastic({1300, 5e3f, 0.49f}, 2, 8, 0.5f)},
    {"toothpaste", viscoplastic({1300, 2e4f, 0.48f}, 150, 80, 0.45f)},
    {"dough", viscoplastic({1150, 4e4f, 0.45f}, 500, 1500, 0.35f)},
    {"mud", viscoplastic({1500, 3e4f, 0.45f}, 80, 5, 1)},
    {"water", fluid(1000)},
};

} // namespace

loam_material_def preset(const char *name) {
  for (const Preset &candidate : presets)
    if (std::strcmp(name, candidate.name) == 0) {
      loam_material_def def = candidate.def;
      std::strncpy(def.name, candidate.name, sizeof def.name - 1);
      return def;
    }
  std::string names;
  for (const Preset &candidate : presets) names += (names.empty() ? "" : ", ") + std::string(candidate.name);
  throw Error(LOAM_ERROR_INVALID_ARGUMENT, format("there is no preset \"%.64s\"; there are %s", name, names.c_str()));
}

const char *preset_name(std::uint32_t index) { return index < std::size(presets) ? presets[index].name : nullptr; }

} // namespace loam
