#include "effect_reader.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "error.h"

namespace runner {
namespace {

using Choices = std::vector<std::pair<std::string_view, std::uint32_t>>;

const Choices nozzles = {{"disc", LOAM_NOZZLE_DISC}, {"mesh", LOAM_NOZZLE_MESH}};
const Choices when_full = {{"tell", LOAM_FULL_TELL}, {"drop", LOAM_FULL_DROP}};
const Choices field_kinds = {{"wind", LOAM_FIELD_WIND}, {"attractor", LOAM_FIELD_ATTRACTOR}, {"blast", LOAM_FIELD_BLAST}};
const Choices killer_kinds = {{"box", LOAM_KILLER_BOX}, {"sphere", LOAM_KILLER_SPHERE}, {"age", LOAM_KILLER_AGE}};

template <class T> T defaults(loam_status (*function)(T *, size_t), const char *name) {
  T def{};
  if (function(&def, sizeof def) != LOAM_OK) throw Error(fmt::format("{}: {}", name, loam_last_error()));
  return def;
}

void read_vector(TomlTable &table, std::string_view key, float (&value)[3]) {
  Vector3 vector = {value[0], value[1], value[2]};
  table.read(key, vector);
  for (int axis = 0; axis < 3; ++axis) value[axis] = vector[axis];
}

void require(TomlTable &table, std::string_view key, float &value) {
  table.require(key);
  table.read(key, value);
}

} // namespace

std::array<float, 4> read_rotation(TomlTable &table) {
  Vector3 axis = {0, 1, 0};
  double degrees = 0;
  table.read("rotation_axis", axis);
  table.read("rotation_degrees", degrees);
  if (!(length(axis) > 0)) table.fail("rotation_axis", "must not be zero");
  const double half = degrees * std::numbers::pi / 360;
  const Vector3 part = static_cast<float>(std::sin(half)) * normalized(axis);
  return {part.x, part.y, part.z, static_cast<float>(std::cos(half))};
}

loam_emitter_def read_stream(TomlTable &table, std::string &nozzle_file) {
  auto def = defaults(loam_emitter_def_default, "loam_emitter_def_default");
  TomlTable nozzle = *table.table("nozzle");
  nozzle.require("kind");
  nozzle.read("kind", def.nozzle, nozzles);
  read_vector(nozzle, "center", def.position);
  if (def.nozzle == LOAM_NOZZLE_DISC) {
    require(nozzle, "radius", def.radius);
  } else {
    nozzle.require("file");
    nozzle.read("file", nozzle_file);
    const std::array<float, 4> rotation = read_rotation(nozzle);
    std::copy(rotation.begin(), rotation.end(), def.rotation);
  }
  nozzle.finish();
  read_vector(table, "direction", def.direction);
  table.read("speed", def.speed);
  table.read("flow", def.flow);
  table.read("mass_flow", def.mass_flow);
  table.read("spacing", def.spacing);
  table.read("jitter", def.jitter);
  table.read("velocity_jitter", def.velocity_jitter);
  table.read("start", def.start);
  table.read("stop", def.stop);
  table.read("seed", def.seed);
  table.read("when_full", def.when_full, when_full);
  return def;
}

SceneField read_field(TomlTable &table) {
  SceneField field{table.place(), defaults(loam_field_def_default, "loam_field_def_default")};
  loam_field_def &def = field.def;
  table.require("kind");
  table.read("kind", def.kind, field_kinds);
  read_vector(table, "center", def.position);
  switch (def.kind) {
  case LOAM_FIELD_WIND:
    read_vector(table, "velocity", def.velocity);
    table.read("rate", def.rate);
    table.read("radius", def.radius);
    break;
  case LOAM_FIELD_ATTRACTOR:
    require(table, "strength", def.strength);
    require(table, "softening", def.softening);
    break;
  default:
    require(table, "speed", def.speed);
    require(table, "radius", def.radius);
    table.read("time", def.time);
    break;
  }
  table.finish();
  return field;
}

SceneKiller read_killer(TomlTable &table, const std::vector<SceneMaterial> &materials) {
  SceneKiller killer{table.place(), {}, defaults(loam_killer_def_default, "loam_killer_def_default")};
  loam_killer_def &def = killer.def;
  table.require("kind");
  table.read("kind", def.kind, killer_kinds);
  table.read("material", killer.material);
  if (!killer.material.empty() && std::none_of(materials.begin(), materials.end(),
                                               [&](const SceneMaterial &each) { return each.name == killer.material; }))
    table.fail("material", fmt::format("no material is named \"{}\"", killer.material));
  if (def.kind == LOAM_KILLER_AGE) {
    require(table, "age", def.age);
  } else {
    read_vector(table, "center", def.position);
    bool outside = false;
    table.read("outside", outside);
    def.outside = outside ? 1 : 0;
  }
  if (def.kind == LOAM_KILLER_SPHERE) require(table, "radius", def.radius);
  if (def.kind == LOAM_KILLER_BOX) {
    table.require("half_extents");
    read_vector(table, "half_extents", def.half_extents);
    const std::array<float, 4> rotation = read_rotation(table);
    std::copy(rotation.begin(), rotation.end(), def.rotation);
  }
  table.finish();
  return killer;
}

SceneHinge read_hinge(TomlTable table) {
  SceneHinge hinge;
  table.read("axis", hinge.axis);
  if (!(length(hinge.axis) > 0)) table.fail("axis", "must not be zero");
  hinge.axis = normalized(hinge.axis);
  table.require("inertia");
  table.read("inertia", hinge.inertia);
  if (!(hinge.inertia > 0)) table.fail("inertia", "must be over 0");
  table.read("damping", hinge.damping);
  if (!(hinge.damping >= 0)) table.fail("damping", "must be 0 or more");
  table.finish();
  return hinge;
}

} // namespace runner
