#include "cloth_reader.h"

#include <algorithm>

#include <fmt/format.h>

namespace runner {
namespace {

const std::vector<std::pair<std::string_view, Appearance>> appearances = {
    {"hidden", Appearance::hidden}, {"matte", Appearance::matte}, {"glossy", Appearance::glossy}};

void read_material(TomlTable &table, loam_cloth_def &def) {
  table.read("areal_density", def.areal_density);
  table.read("stretch_stiffness", def.stretch_stiffness);
  table.read("shear_stiffness", def.shear_stiffness);
  table.read("bending_stiffness", def.bending_stiffness);
  table.read("damping", def.damping);
  table.read("greatest_stretch", def.greatest_stretch);
  table.read("thickness", def.thickness);
  table.read("particle_friction", def.particle_friction);
  table.read("self_distance", def.self_distance);
  table.read("self_friction", def.self_friction);
  table.read("tear_strain", def.tear_strain);
  Vector3 warp = {def.warp[0], def.warp[1], def.warp[2]}, velocity;
  table.read("warp", warp);
  table.read("velocity", velocity);
  for (int axis = 0; axis < 3; ++axis) {
    def.warp[axis] = warp[axis];
    def.velocity[axis] = velocity[axis];
  }
}

SceneAttachment read_attachment(TomlTable &table, const Scene &scene, const Mesh &mesh) {
  SceneAttachment attachment;
  attachment.place = table.place();
  Vector3 low, high;
  table.require("low");
  table.require("high");
  table.read("low", low);
  table.read("high", high);
  for (std::uint32_t i = 0; i < mesh.vertices.size(); ++i) {
    const Vector3 x = mesh.vertices[i];
    if (x.x >= low.x && x.x <= high.x && x.y >= low.y && x.y <= high.y && x.z >= low.z && x.z <= high.z)
      attachment.vertices.push_back(i);
  }
  if (attachment.vertices.empty())
    table.fail("low", "no vertex of the cloth lies between low and high, which are in the cloth's own frame");
  if (table.has("collider")) {
    std::string name;
    table.read("collider", name);
    const auto collider = std::find_if(scene.colliders.begin(), scene.colliders.end(),
                                       [&](const SceneCollider &each) { return !name.empty() && each.name == name; });
    if (collider == scene.colliders.end()) table.fail("collider", fmt::format("no collider is named \"{}\"", name));
    attachment.collider = static_cast<std::size_t>(collider - scene.colliders.begin());
  }
  table.read("compliance", attachment.compliance);
  table.read("release", attachment.release);
  if (!(attachment.release >= 0)) table.fail("release", "must be 0 or more");
  table.finish();
  return attachment;
}

} // namespace

Mesh make_grid(std::uint32_t columns, std::uint32_t rows, float spacing) {
  Mesh mesh;
  for (std::uint32_t j = 0; j <= rows; ++j)
    for (std::uint32_t i = 0; i <= columns; ++i)
      mesh.vertices.push_back({(static_cast<float>(i) - 0.5f * static_cast<float>(columns)) * spacing, 0,
                               (static_cast<float>(j) - 0.5f * static_cast<float>(rows)) * spacing});
  for (std::uint32_t j = 0; j < rows; ++j)
    for (std::uint32_t i = 0; i < columns; ++i) {
      const std::uint32_t a = j * (columns + 1) + i, b = a + 1, d = a + columns + 1, c = d + 1;
      // Diagonals alternate, so that the sheet has no side that it folds to.
      if ((i + j) % 2 != 0)
        mesh.indices.insert(mesh.indices.end(), {a, d, b, b, d, c});
      else
        mesh.indices.insert(mesh.indices.end(), {a, c, b, a, d, c});
    }
  return mesh;
}

void read_cloth(TomlTable &table, const Scene &scene, const Mesh &mesh, SceneCloth &cloth) {
  read_material(table, cloth.def);
  for (TomlTable &attachment : table.tables("attachments"))
    cloth.attachments.push_back(read_attachment(attachment, scene, mesh));
  if (std::optional<TomlTable> wind = table.table("wind")) {
    cloth.wind_place = wind->place();
    wind->read("velocity", cloth.wind_velocity);
    wind->read("drag", cloth.drag);
    wind->read("lift", cloth.lift);
    wind->finish();
  }
  table.read("appearance", cloth.appearance, appearances);
  table.read("colour", cloth.colour);
  table.finish();
}

} // namespace runner
