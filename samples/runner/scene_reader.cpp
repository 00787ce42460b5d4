#include "scene_reader.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>

#include <fmt/format.h>

#include "accuracy.h"
#include "cloth_reader.h"
#include "collider_meshes.h"
#include "distance_field.h"
#include "effect_reader.h"
#include "error.h"
#include "material_reader.h"
#include "obj_reader.h"
#include "toml_table.h"

namespace runner {
namespace {

const std::vector<std::pair<std::string_view, std::uint32_t>> solvers = {{"gauss_seidel", LOAM_SOLVER_GAUSS_SEIDEL},
                                                                         {"jacobi", LOAM_SOLVER_JACOBI}};
const std::vector<std::pair<std::string_view, std::uint32_t>> multipliers = {
    {"projected_tensor", LOAM_MULTIPLIER_PROJECTED_TENSOR}, {"scalar", LOAM_MULTIPLIER_SCALAR}};
const std::vector<std::pair<std::string_view, std::uint32_t>> plasticities = {
    {"implicit", LOAM_PLASTICITY_IMPLICIT}, {"semi_implicit", LOAM_PLASTICITY_SEMI_IMPLICIT}};
const std::vector<std::pair<std::string_view, std::uint32_t>> samplings = {{"poisson_disk", LOAM_SAMPLING_POISSON_DISK},
                                                                           {"lattice", LOAM_SAMPLING_LATTICE}};
const std::vector<std::pair<std::string_view, std::uint32_t>> regions = {{"box", LOAM_REGION_BOX},
                                                                         {"sphere", LOAM_REGION_SPHERE},
                                                                         {"cylinder", LOAM_REGION_CYLINDER},
                                                                         {"mesh", LOAM_REGION_MESH}};
const std::vector<std::pair<std::string_view, std::uint32_t>> collider_kinds = {
    {"plane", LOAM_COLLIDER_PLANE},     {"mesh", LOAM_COLLIDER_MESH}, {"sphere", LOAM_COLLIDER_SPHERE},
    {"capsule", LOAM_COLLIDER_CAPSULE}, {"box", LOAM_COLLIDER_BOX},   {"hull", LOAM_COLLIDER_HULL},
    {"grid", LOAM_COLLIDER_GRID}};
const std::vector<std::pair<std::string_view, Deformation::Kind>> deformation_kinds = {
    {"squash", Deformation::Kind::squash}, {"twist", Deformation::Kind::twist}, {"wave", Deformation::Kind::wave}};
const std::vector<std::pair<std::string_view, Appearance>> appearances = {
    {"hidden", Appearance::hidden}, {"glass", Appearance::glass}, {"matte", Appearance::matte},
    {"wood", Appearance::wood},     {"metal", Appearance::metal}, {"glossy", Appearance::glossy}};

const std::vector<std::pair<std::string_view, Appearance>> plane_appearances = {
    {"hidden", Appearance::hidden}, {"matte", Appearance::matte}, {"wood", Appearance::wood}, {"tiles", Appearance::tiles}};

// Defaults come from the library, and they cannot fail for the struct sizes of its own headers unless it is a different version.
void expect_ok(loam_status status, const char *call) {
  if (status != LOAM_OK) throw Error(fmt::format("{}: {}: {}", call, loam_status_name(status), loam_last_error()));
}

class Reader {
public:
  explicit Reader(const std::filesystem::path &path) { scene_.path = path; }

  Scene read(const toml::table &document) {
    TomlTable root(document, scene_.path, "");
    root.read("title", scene_.title);
    read_world(root);
    read_time(root);
    for (TomlTable &table : root.tables("materials")) read_material(table);
    for (TomlTable &table : root.tables("contacts")) read_contact(table);
    for (TomlTable &table : root.tables("emitters")) read_emitter(table);
    for (TomlTable &table : root.tables("colliders")) read_collider(table);
    for (TomlTable &table : root.tables("cloths")) read_cloth(table);
    for (TomlTable &table : root.tables("fields")) scene_.fields.push_back(read_field(table));
    for (TomlTable &table : root.tables("killers")) scene_.killers.push_back(read_killer(table, scene_.materials));
    for (TomlTable &table : root.tables("decorations")) read_decoration(table);
    read_watch(root);
    read_camera(root);
    read_light(root);
    root.finish();
    if (scene_.cloths.empty() && scene_.materials.empty())
      root.fail("materials", "the scene has no material ([[materials]])");
    if (scene_.cloths.empty() && scene_.emitters.empty())
      root.fail("emitters", "the scene has no emitter ([[emitters]]) and no cloth ([[cloths]])");
    return std::move(scene_);
  }

private:
  void read_world(TomlTable &root) {
    loam_world_def &def = scene_.world;
    expect_ok(loam_world_def_default(&def, sizeof def), "loam_world_def_default");
    std::optional<TomlTable> table = root.table("world");
    if (!table) return;
    scene_.world_place = table->place();
    Vector3 gravity = {def.gravity[0], def.gravity[1], def.gravity[2]};
    table->read("gravity", gravity);
    for (int axis = 0; axis < 3; ++axis) def.gravity[axis] = gravity[axis];
    table->read("kernel_radius", def.kernel_radius);
    table->read("particle_capacity", scene_.particle_capacity);
    table->read("substeps", def.substeps);
    table->read("iterations", def.iterations);
    if (std::string accuracy; table->has("accuracy")) {
      for (const char *other : {"substeps", "iterations"})
        if (table->has(other)) table->fail(other, "is what \"accuracy\" chooses; give one of them");
      table->read("accuracy", accuracy);
      try {
        scene_.accuracy = parse_accuracy(accuracy);
      } catch (const Error &error) {
        table->fail("accuracy", error.what());
      }
    }
    table->read("solver", def.solver, solvers);
    table->read("plasticity", def.plasticity, plasticities);
    table->read("multiplier", def.multiplier, multipliers);
    table->read("zero_energy_stiffness", def.zero_energy_stiffness);
    table->read("warm_start", def.warm_start);
    table->read("sleep_speed", def.sleep_speed);
    table->read("sleep_delay", def.sleep_delay);
    table->read("velocity_smoothing", def.velocity_smoothing);
    table->read("minimum_distance", def.minimum_distance);
    table->read("gradient_cutoff", def.gradient_cutoff);
    table->finish();
  }

  void read_time(TomlTable &root) {
    std::optional<TomlTable> table = root.table("time");
    if (!table) return;
    table->read("frame_rate", scene_.frame_rate);
    table->read("frames", scene_.frames);
    // The library takes steps of at most one second.
    if (!(scene_.frame_rate >= 1 && scene_.frame_rate <= 1e6))
      table->fail("frame_rate", fmt::format("{} is not between 1 and 1000000 frames a second", scene_.frame_rate));
    if (scene_.frames == 0) table->fail("frames", "at least one frame is needed");
    table->finish();
  }

  void read_material(TomlTable &table) {
    const float *gravity = scene_.world.gravity;
    const SceneMaterial material = runner::read_material(table, length(Vector3{gravity[0], gravity[1], gravity[2]}));
    for (const SceneMaterial &other : scene_.materials)
      if (other.name == material.name) table.fail("name", fmt::format("there is a material \"{}\" already", material.name));
    scene_.materials.push_back(material);
  }

  void read_contact(TomlTable &table) {
    SceneContact contact;
    contact.place = table.place();
    table.require("materials");
    table.read("materials", contact.materials);
    if (contact.materials.size() < 2) table.fail("materials", "a contact is between two materials or more");
    for (std::size_t i = 0; i < contact.materials.size(); ++i) {
      const std::string &name = contact.materials[i];
      const bool known = std::any_of(scene_.materials.begin(), scene_.materials.end(),
                                     [&](const SceneMaterial &each) { return each.name == name; });
      if (!known) table.fail("materials", fmt::format("no material is named \"{}\"", name));
      if (std::find(contact.materials.begin(), contact.materials.begin() + i, name) != contact.materials.begin() + i)
        table.fail("materials", fmt::format("\"{}\" is named twice", name));
    }
    table.read("friction", contact.friction);
    table.finish();
    scene_.contacts.push_back(contact);
  }

  void read_emitter(TomlTable &table) {
    SceneEmitter emitter;
    emitter.place = table.place();
    loam_fill_def &def = emitter.def;
    expect_ok(loam_fill_def_default(&def, sizeof def), "loam_fill_def_default");
    table.require("material");
    table.read("material", emitter.material);
    const auto material = std::find_if(scene_.materials.begin(), scene_.materials.end(),
                                       [&](const SceneMaterial &each) { return each.name == emitter.material; });
    if (material == scene_.materials.end())
      table.fail("material", fmt::format("no material is named \"{}\"", emitter.material));
    emitter.colour = material->colour;
    table.read("colour", emitter.colour);
    table.read("band_colour", emitter.band_colour);
    table.read("band_height", emitter.band_height);
    if (!(emitter.band_height >= 0)) table.fail("band_height", "must be 0 or more");
    if (table.has("band_colour") != table.has("band_height"))
      table.fail(table.has("band_colour") ? "band_colour" : "band_height", "band_colour and band_height belong together");
    if (table.has("band_height") && material->look != Look::grains)
      table.fail("band_height", "bands are for materials whose look is \"grains\"");
    if (table.has("nozzle")) {
      if (table.has("region")) table.fail("region", "an emitter has a region to fill or a nozzle to stream from, not both");
      std::string file;
      emitter.stream = read_stream(table, file);
      if (!file.empty()) emitter.nozzle = find_mesh(table, file);
      if (table.has("band_height")) table.fail("band_height", "bands are for matter that fills a region");
      table.finish();
      scene_.emitters.push_back(emitter);
      return;
    }
    table.require("region");
    emitter.region = read_region(*table.table("region"));
    if (std::optional<TomlTable> cut = table.table("cut")) emitter.cut = read_region(*cut);
    table.read("sampling", def.sampling, samplings);
    table.read("spacing", def.spacing);
    table.read("jitter", def.jitter);
    table.read("inset", def.inset);
    table.read("seed", def.seed);
    Vector3 velocity;
    table.read("velocity", velocity);
    for (int axis = 0; axis < 3; ++axis) def.velocity[axis] = velocity[axis];
    table.finish();
    scene_.emitters.push_back(emitter);
  }

  SceneRegion read_region(TomlTable table) {
    SceneRegion region;
    table.require("kind");
    table.read("kind", region.kind, regions);
    table.read("center", region.center);
    region.rotation = read_rotation(table);
    if (region.kind == LOAM_REGION_BOX) {
      table.require("half_extents");
      table.read("half_extents", region.half_extents);
    }
    if (region.kind == LOAM_REGION_SPHERE || region.kind == LOAM_REGION_CYLINDER) {
      table.require("radius");
      table.read("radius", region.radius);
    }
    if (region.kind == LOAM_REGION_CYLINDER) {
      table.require("half_height");
      table.read("half_height", region.half_height);
    }
    if (region.kind == LOAM_REGION_MESH) region.file = read_mesh(table);
    table.finish();
    return region;
  }

  void read_collider(TomlTable &table) {
    SceneCollider collider;
    collider.place = table.place();
    loam_collider_def def{};
    expect_ok(loam_collider_def_default(&def, sizeof def), "loam_collider_def_default");
    collider.friction = def.friction;
    table.read("name", collider.name);
    for (const SceneCollider &other : scene_.colliders)
      if (table.has("name") && other.name == collider.name)
        table.fail("name", fmt::format("there is a collider \"{}\" already", collider.name));
    table.require("kind");
    table.read("kind", collider.kind, collider_kinds);
    read_shape(table, collider);
    table.read("position", collider.pose.position);
    collider.pose.rotation = read_rotation(table);
    for (TomlTable &motion : table.tables("motions")) collider.motions.push_back(read_motion(motion));
    for (TomlTable &deformation : table.tables("deformations"))
      collider.deformations.push_back(read_deformation(deformation));
    if (collider.kind != LOAM_COLLIDER_MESH && !collider.deformations.empty())
      table.fail("deformations", "only a mesh deforms");
    table.read("friction", collider.friction);
    table.read("restitution", collider.restitution);
    table.read("stick", collider.stick);
    if (std::optional<TomlTable> hinge = table.table("hinge")) collider.hinge = read_hinge(*hinge);
    if (collider.hinge && !collider.motions.empty()) table.fail("hinge", "what has motions does not turn by itself");
    if (collider.kind == LOAM_COLLIDER_PLANE && collider.moves())
      table.fail(collider.hinge ? "hinge" : "motions", "a plane stays where it is");
    table.read("appearance", collider.appearance, collider.kind == LOAM_COLLIDER_PLANE ? plane_appearances : appearances);
    if (collider.appearance == Appearance::glass && (collider.moves() || !collider.deformations.empty()))
      table.fail("appearance", "what moves cannot be shown as glass");
    table.read("colour", collider.colour);
    table.finish();
    scene_.colliders.push_back(collider);
  }

  void read_shape(TomlTable &table, SceneCollider &collider) {
    const auto require_length = [&](const char *key, auto &value) {
      table.require(key);
      table.read(key, value);
    };
    const auto show = [&](const Mesh &mesh) { // under a name that no file has
      collider.file = fmt::format("the shape of {}", collider.place.key);
      scene_.meshes.emplace(collider.file, mesh);
    };
    switch (collider.kind) {
    case LOAM_COLLIDER_MESH:
    case LOAM_COLLIDER_HULL:
      collider.file = read_mesh(table);
      break;
    case LOAM_COLLIDER_SPHERE:
    case LOAM_COLLIDER_CAPSULE:
      require_length("radius", collider.radius);
      if (!(collider.radius > 0)) table.fail("radius", "must be over 0");
      if (collider.kind == LOAM_COLLIDER_CAPSULE) require_length("half_height", collider.half_height);
      if (!(collider.half_height >= 0)) table.fail("half_height", "must be 0 or more");
      show(make_capsule(collider.radius, collider.half_height));
      break;
    case LOAM_COLLIDER_BOX:
      require_length("half_extents", collider.half_extents);
      for (int axis = 0; axis < 3; ++axis)
        if (!(collider.half_extents[axis] > 0)) table.fail("half_extents", "must be over 0");
      show(make_box(collider.half_extents));
      break;
    case LOAM_COLLIDER_GRID: {
      collider.file = read_mesh(table);
      float spacing = 0;
      require_length("spacing", spacing);
      if (!(spacing > 0)) table.fail("spacing", "must be over 0");
      try { // farther than contacts are looked for
        collider.field = make_distance_field(scene_.meshes.at(collider.file), spacing,
                                             std::max(4 * spacing, 4 * scene_.world.kernel_radius));
      } catch (const Error &error) {
        table.fail("file", error.what());
      }
      break;
    }
    default:
      break;
    }
  }

  Motion read_motion(TomlTable &table) {
    Motion motion;
    double degrees_per_second = 0;
    table.read("start", motion.start);
    table.read("stop", motion.stop);
    table.read("velocity", motion.velocity);
    table.read("spin_axis", motion.spin_axis);
    table.read("spin_degrees_per_second", degrees_per_second);
    if (!(motion.start >= 0)) table.fail("start", "must be 0 or more");
    if (!(motion.stop > motion.start)) table.fail("stop", "must be later than start");
    if (!(length(motion.spin_axis) > 0)) table.fail("spin_axis", "must not be zero");
    motion.spin_axis = normalized(motion.spin_axis);
    motion.spin = degrees_per_second * std::numbers::pi / 180;
    table.finish();
    return motion;
  }

  Deformation read_deformation(TomlTable &table) {
    Deformation deformation;
    for (const char *key : {"kind", "amplitude", "period"}) table.require(key);
    table.read("kind", deformation.kind, deformation_kinds);
    table.read("axis", deformation.axis);
    table.read("amplitude", deformation.amplitude);
    table.read("period", deformation.period);
    table.read("start", deformation.start);
    if (!(length(deformation.axis) > 0)) table.fail("axis", "must not be zero");
    deformation.axis = normalized(deformation.axis);
    if (deformation.kind == Deformation::Kind::squash && !(std::abs(deformation.amplitude) <= 0.9f))
      table.fail("amplitude", "must be between -0.9 and 0.9: the share by which it is squashed");
    if (!(deformation.period > 0)) table.fail("period", "must be over 0");
    if (!(deformation.start >= 0)) table.fail("start", "must be 0 or more");
    if (deformation.kind == Deformation::Kind::wave) {
      table.require("wavelength");
      table.read("wavelength", deformation.wavelength);
      table.read("direction", deformation.direction);
      if (!(deformation.wavelength > 0)) table.fail("wavelength", "must be over 0");
      if (!(length(deformation.direction) > 0)) table.fail("direction", "must not be zero");
      deformation.direction = normalized(deformation.direction);
    }
    table.finish();
    return deformation;
  }

  void read_cloth(TomlTable &table) {
    SceneCloth cloth;
    cloth.place = table.place();
    expect_ok(loam_cloth_def_default(&cloth.def, sizeof cloth.def), "loam_cloth_def_default");
    if (table.has("file") == table.has("grid")) table.fail("file", "a cloth has either a mesh (file) or a grid");
    if (std::optional<TomlTable> grid = table.table("grid")) {
      std::uint32_t columns = 0, rows = 0;
      float spacing = 0;
      for (const char *key : {"columns", "rows", "spacing"}) grid->require(key);
      grid->read("columns", columns);
      grid->read("rows", rows);
      grid->read("spacing", spacing);
      if (columns < 1 || columns > 2000) grid->fail("columns", "must be between 1 and 2000");
      if (rows < 1 || rows > 2000) grid->fail("rows", "must be between 1 and 2000");
      if (!(spacing > 0)) grid->fail("spacing", "must be over 0");
      grid->finish();
      cloth.file = fmt::format("the grid of {}", cloth.place.key); // a name that no file has
      scene_.meshes.emplace(cloth.file, make_grid(columns, rows, spacing));
    } else {
      cloth.file = read_mesh(table);
    }
    Vector3 position;
    table.read("position", position);
    for (int axis = 0; axis < 3; ++axis) cloth.def.position[axis] = position[axis];
    const std::array<float, 4> rotation = read_rotation(table);
    std::copy(rotation.begin(), rotation.end(), cloth.def.rotation);
    runner::read_cloth(table, scene_, scene_.meshes.at(cloth.file), cloth);
    scene_.cloths.push_back(std::move(cloth));
  }

  void read_decoration(TomlTable &table) {
    SceneDecoration decoration;
    table.require("radius");
    table.require("half_height");
    table.read("center", decoration.center);
    table.read("radius", decoration.radius);
    table.read("half_height", decoration.half_height);
    table.read("rounding", decoration.rounding);
    table.read("appearance", decoration.appearance, appearances);
    table.read("colour", decoration.colour);
    if (!(decoration.radius > 0)) table.fail("radius", "must be over 0");
    if (!(decoration.half_height > 0)) table.fail("half_height", "must be over 0");
    if (!(decoration.rounding >= 0 && decoration.rounding <= std::min(decoration.radius, decoration.half_height)))
      table.fail("rounding", "must be 0 or more, and at most radius and half_height");
    table.finish();
    scene_.decorations.push_back(decoration);
  }

  void read_watch(TomlTable &root) {
    std::optional<TomlTable> table = root.table("watch");
    if (!table) return;
    SceneWatch watch;
    table->require("low");
    table->require("high");
    table->read("low", watch.low);
    table->read("high", watch.high);
    table->finish();
    scene_.watch = watch;
  }

  void read_camera(TomlTable &root) {
    std::optional<TomlTable> table = root.table("camera");
    if (!table) return;
    SceneCamera camera;
    table->require("eye");
    table->require("target");
    table->read("eye", camera.eye);
    table->read("target", camera.target);
    table->read("up", camera.up);
    table->read("vertical_field_of_view_degrees", camera.vertical_field_of_view);
    table->read("width", camera.width);
    table->read("height", camera.height);
    if (!(camera.vertical_field_of_view > 0 && camera.vertical_field_of_view < 170))
      table->fail("vertical_field_of_view_degrees", "must be over 0 and under 170");
    if (camera.width < 16 || camera.width > 8192) table->fail("width", "must be between 16 and 8192 pixels");
    if (camera.height < 16 || camera.height > 8192) table->fail("height", "must be between 16 and 8192 pixels");
    if (!(length(cross(camera.target - camera.eye, camera.up)) > 0))
      table->fail("eye", "eye, target and up must not lie on one line");
    table->finish();
    scene_.camera = camera;
  }

  void read_light(TomlTable &root) {
    std::optional<TomlTable> table = root.table("light");
    if (!table) return;
    SceneLight &light = scene_.light;
    table->read("direction", light.direction);
    table->read("colour", light.colour);
    table->read("sky", light.sky);
    table->read("horizon", light.horizon);
    table->read("background", light.background);
    table->read("exposure", light.exposure);
    if (!(length(light.direction) > 0)) table->fail("direction", "must not be zero");
    table->finish();
  }

  std::filesystem::path read_mesh(TomlTable &table) {
    table.require("file");
    std::string name;
    table.read("file", name);
    return find_mesh(table, name);
  }

  std::filesystem::path find_mesh(TomlTable &table, const std::string &name) {
    const std::filesystem::path file = scene_.path.parent_path() / name;
    if (scene_.meshes.contains(file)) return file;
    try {
      scene_.meshes.emplace(file, read_obj(file));
    } catch (const Error &error) {
      table.fail("file", error.what());
    }
    return file;
  }

  Scene scene_;
};

} // namespace

Scene read_scene(const std::filesystem::path &path) {
  std::error_code problem;
  if (!std::filesystem::exists(path, problem)) throw Error(fmt::format("{}: no such scene file", path.string()));
  if (std::filesystem::is_directory(path, problem))
    throw Error(fmt::format("{}: is a folder, not a scene file", path.string()));
  if (!std::filesystem::is_regular_file(path, problem)) // a device or a pipe may never end
    throw Error(fmt::format("{}: is not a regular file", path.string()));
  std::ifstream file(path, std::ios::binary);
  if (!file) throw Error(fmt::format("{}: cannot be read", path.string()));
  const std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  return parse_scene(path, text);
}

Scene parse_scene(const std::filesystem::path &path, std::string_view text) {
  toml::table document;
  try {
    document = toml::parse(text);
  } catch (const toml::parse_error &error) {
    const toml::source_position at = error.source().begin;
    throw Error(fmt::format("{}:{}:{}: {}", path.string(), at.line, at.column, error.description()));
  }
  return Reader(path).read(document);
}

void scale_particle_count(Scene &scene, double factor) {
  const double finer = std::cbrt(factor);
  scene.world.kernel_radius = static_cast<float>(scene.world.kernel_radius / finer);
  const double substeps = std::round(scene.world.substeps * finer);
  scene.world.substeps = static_cast<std::uint32_t>(std::clamp(substeps, 1.0, 4e9));
  for (SceneEmitter &emitter : scene.emitters) {
    emitter.def.spacing = static_cast<float>(emitter.def.spacing / finer);
    emitter.def.inset = static_cast<float>(emitter.def.inset / finer);
    if (emitter.stream) emitter.stream->spacing = static_cast<float>(emitter.stream->spacing / finer);
  }
}

} // namespace runner
