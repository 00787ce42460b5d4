#include "material_reader.h"

#include <cstring>
#include <numbers>

#include <fmt/format.h>

#include "error.h"

namespace runner {
namespace {

const std::vector<std::pair<std::string_view, std::uint32_t>> laws = {{"elastic", LOAM_LAW_ELASTIC},
                                                                      {"von_mises", LOAM_LAW_VON_MISES},
                                                                      {"drucker_prager", LOAM_LAW_DRUCKER_PRAGER},
                                                                      {"nacc", LOAM_LAW_NACC},
                                                                      {"herschel_bulkley", LOAM_LAW_HERSCHEL_BULKLEY},
                                                                      {"stomakhin_snow", LOAM_LAW_STOMAKHIN_SNOW},
                                                                      {"fluid", LOAM_LAW_FLUID}};
const std::vector<std::pair<std::string_view, Look>> looks = {
    {"grains", Look::grains}, {"smooth", Look::smooth}, {"glossy", Look::glossy}};

constexpr double radians_per_degree = std::numbers::pi / 180;

class MaterialReader {
public:
  MaterialReader(TomlTable &table, double gravity) : table_(table), gravity_(static_cast<float>(gravity)) {}

  SceneMaterial read() {
    material_.place = table_.place();
    read_origin();
    read_name();
    table_.read("density", def_.density);
    if (def_.law != LOAM_LAW_FLUID) read_stiffness();
    switch (def_.law) {
    case LOAM_LAW_VON_MISES:
      read_yield_stress();
      break;
    case LOAM_LAW_DRUCKER_PRAGER:
      read_friction();
      break;
    case LOAM_LAW_NACC:
      read_strengths();
      break;
    case LOAM_LAW_HERSCHEL_BULKLEY:
      read_flow();
      break;
    case LOAM_LAW_STOMAKHIN_SNOW:
      table_.read("hardening_factor", def_.hardening_factor);
      table_.read("critical_compression", def_.critical_compression);
      table_.read("critical_stretch", def_.critical_stretch);
      break;
    case LOAM_LAW_FLUID:
      table_.read("viscosity", def_.viscosity);
      table_.read("surface_tension", def_.surface_tension);
      table_.read("adhesion", def_.adhesion);
      table_.read("vorticity_confinement", def_.vorticity_confinement);
      break;
    default:
      break;
    }
    table_.read("colour", material_.colour);
    table_.read("colour_variation", material_.colour_variation);
    table_.read("look", material_.look, looks);
    table_.finish();
    return material_;
  }

private:
  // The library knows the ranges; the table knows the line.
  void expect(loam_status status, std::string_view key) const {
    if (status != LOAM_OK) table_.fail(key, loam_last_error());
  }

  void read_origin() {
    std::string preset;
    table_.read("preset", preset);
    std::uint32_t law = LOAM_LAW_ELASTIC;
    table_.read("law", law, laws);
    if (table_.has("preset") && table_.has("law")) table_.fail("law", "the preset has a law already");
    if (!table_.has("preset") && !table_.has("law")) table_.fail("law", "the key is missing (or preset in its place)");
    if (table_.has("preset"))
      expect(loam_material_def_preset(preset.c_str(), &def_, sizeof def_), "preset");
    else
      expect(loam_material_def_default(law, &def_, sizeof def_), "law");
  }

  void read_name() {
    table_.require("name");
    table_.read("name", material_.name);
    if (material_.name.empty() || material_.name.size() >= sizeof def_.name)
      table_.fail("name", fmt::format("must have 1 to {} characters", sizeof def_.name - 1));
    std::memset(def_.name, 0, sizeof def_.name);
    std::memcpy(def_.name, material_.name.data(), material_.name.size());
  }

  void read_stiffness() {
    table_.read("poissons_ratio", def_.poissons_ratio);
    table_.read("youngs_modulus", def_.youngs_modulus);
    // A column of so many metres becomes shorter by so many under its own weight.
    if (std::optional<TomlTable> sinking = alternative("sinking", "youngs_modulus")) {
      float height = 0, by = 0;
      read_all(*sinking, {{"height", &height}, {"by", &by}});
      expect(loam_design_youngs_modulus(def_.density, gravity_, height, by, &def_.youngs_modulus), "sinking");
    }
  }

  void read_yield_stress() {
    table_.read("yield_stress", def_.yield_stress);
    table_.read("hardening_modulus", def_.hardening_modulus);
    float height = 0;
    table_.read("stands_to_height", height);
    if (!table_.has("stands_to_height")) return;
    only_one_of("stands_to_height", "yield_stress");
    expect(loam_design_yield_stress(def_.density, gravity_, height, &def_.yield_stress), "stands_to_height");
  }

  void read_friction() {
    read_degrees(table_, "friction_angle_degrees", def_.friction_angle);
    table_.read("cohesion", def_.cohesion);
    float repose = 0;
    read_degrees(table_, "angle_of_repose_degrees", repose);
    if (!table_.has("angle_of_repose_degrees")) return;
    only_one_of("angle_of_repose_degrees", "friction_angle_degrees");
    expect(loam_design_friction_angle(repose, &def_.friction_angle), "angle_of_repose_degrees");
  }

  void read_strengths() {
    table_.read("consolidation", def_.consolidation);
    table_.read("cohesion_ratio", def_.cohesion_ratio);
    table_.read("hardening_factor", def_.hardening_factor);
    table_.read("critical_state_slope", def_.critical_state_slope);
    table_.read("constant_hardness", def_.constant_hardness);
    std::optional<TomlTable> strengths = table_.table("strengths");
    if (!strengths) return;
    for (const char *number : {"consolidation", "cohesion_ratio", "hardening_factor", "critical_state_slope"})
      only_one_of("strengths", number);
    float compressive = 0, tensile = 0, friction_angle = 0, opening = 0;
    for (const char *key : {"compressive", "tensile", "friction_angle_degrees", "opening"}) strengths->require(key);
    strengths->read("compressive", compressive);
    strengths->read("tensile", tensile);
    read_degrees(*strengths, "friction_angle_degrees", friction_angle);
    strengths->read("opening", opening);
    strengths->finish();
    expect(loam_design_strengths(&def_, compressive, tensile, friction_angle, opening), "strengths");
  }

  void read_flow() {
    table_.read("shear_yield_stress", def_.shear_yield_stress);
    table_.read("consistency", def_.consistency);
    table_.read("flow_exponent", def_.flow_exponent);
    float height = 0;
    table_.read("stands_to_height", height);
    if (table_.has("stands_to_height")) {
      only_one_of("stands_to_height", "shear_yield_stress");
      expect(loam_design_shear_yield_stress(def_.density, gravity_, height, &def_.shear_yield_stress), "stands_to_height");
    }
    // Poured on a level floor, such a volume spreads to such a radius.
    if (std::optional<TomlTable> puddle = alternative("puddle", "shear_yield_stress")) {
      only_one_of("puddle", "stands_to_height");
      float volume = 0, radius = 0;
      read_all(*puddle, {{"volume", &volume}, {"radius", &radius}});
      expect(loam_design_puddle_yield_stress(def_.density, gravity_, volume, radius, &def_.shear_yield_stress), "puddle");
    }
    // A film so thick, on such a slope, runs down with such a speed at its surface.
    if (std::optional<TomlTable> film = alternative("film", "consistency")) {
      float thickness = 0, slope = 0, speed = 0;
      for (const char *key : {"thickness", "slope_degrees", "speed"}) film->require(key);
      film->read("thickness", thickness);
      read_degrees(*film, "slope_degrees", slope);
      film->read("speed", speed);
      film->finish();
      expect(loam_design_consistency(def_.density, gravity_, def_.shear_yield_stress, def_.flow_exponent, thickness, slope,
                                     speed, &def_.consistency),
             "film");
    }
  }

  void only_one_of(const char *key, const char *other) const {
    if (table_.has(key) && table_.has(other)) table_.fail(key, fmt::format("{} decides that already", other));
  }

  std::optional<TomlTable> alternative(const char *key, const char *other) {
    only_one_of(key, other);
    return table_.table(key);
  }

  static void read_all(TomlTable &table, std::initializer_list<std::pair<const char *, float *>> keys) {
    for (const auto &[key, value] : keys) {
      table.require(key);
      table.read(key, *value);
    }
    table.finish();
  }

  static void read_degrees(TomlTable &table, const char *key, float &radians) {
    if (!table.has(key)) return table.read(key, radians);
    double degrees = 0;
    table.read(key, degrees);
    radians = static_cast<float>(degrees * radians_per_degree);
  }

  TomlTable &table_;
  float gravity_;
  SceneMaterial material_;
  loam_material_def &def_ = material_.def;
};

} // namespace

SceneMaterial read_material(TomlTable &table, double gravity) { return MaterialReader(table, gravity).read(); }

} // namespace runner
