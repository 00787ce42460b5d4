/* The half of scenes.h that calls the library. */
#include "scenes.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace loam::scenes {

namespace {

/* The rotation that takes +y to `normal`, as a quaternion x, y, z, w: the half-way construction, with a half turn about x for -y. */
void rotation_from_up(const float normal[3], float rotation[4]) {
  const float w = 1 + normal[1];
  if (w < 1e-6f) {
    rotation[0] = 1;
    rotation[1] = rotation[2] = rotation[3] = 0;
    return;
  }
  const float x = normal[2], z = -normal[0]; // (0, 1, 0) x normal
  const float length = std::sqrt(x * x + z * z + w * w);
  rotation[0] = x / length;
  rotation[1] = 0;
  rotation[2] = z / length;
  rotation[3] = w / length;
}

loam_material_def of_law(std::uint32_t law, const char *name) {
  loam_material_def def;
  require(loam_material_def_default(law, &def, sizeof def), "loam_material_def_default");
  std::memset(def.name, 0, sizeof def.name);
  std::strncpy(def.name, name, sizeof def.name - 1);
  def.density = 1500;
  def.youngs_modulus = 1e6f;
  def.poissons_ratio = 0.3f;
  return def;
}

} // namespace

std::vector<loam_material_def> each_law() {
  loam_material_def metal = of_law(LOAM_LAW_VON_MISES, "metal"), clay = of_law(LOAM_LAW_NACC, "clay"),
                    mud = of_law(LOAM_LAW_HERSCHEL_BULKLEY, "mud"), foam = of_law(LOAM_LAW_HERSCHEL_BULKLEY, "foam"),
                    starch = of_law(LOAM_LAW_HERSCHEL_BULKLEY, "starch"), snow = of_law(LOAM_LAW_STOMAKHIN_SNOW, "snow");
  metal.yield_stress = 500;
  metal.hardening_modulus = 1e4f;
  clay.consolidation = -2e-4f;
  mud.shear_yield_stress = foam.shear_yield_stress = starch.shear_yield_stress = 100;
  mud.flow_exponent = 1;
  foam.flow_exponent = 0.3f;
  starch.flow_exponent = 3;
  snow.critical_compression = 2e-3f;
  snow.critical_stretch = 1e-3f;
  loam_material_def syrup = of_law(LOAM_LAW_FLUID, "syrup");
  syrup.viscosity = 3;
  syrup.surface_tension = 0.05f;
  syrup.adhesion = 20;
  syrup.vorticity_confinement = 0.5f;
  return {sand(), rubber(), plasticine(500), metal, clay, mud, foam, starch, snow, of_law(LOAM_LAW_FLUID, "water"), syrup};
}

std::string outcome(loam_status status) {
  if (status == LOAM_OK) return "LOAM_OK";
  return std::string(loam_status_name(status)) + ": " + loam_last_error();
}

void require(loam_status status, const char *call) {
  if (status != LOAM_OK) throw std::runtime_error(std::string(call) + ": " + outcome(status));
}

loam_world_def world_def(const Scene &scene) {
  loam_world_def def;
  require(loam_world_def_default(&def, sizeof def), "loam_world_def_default");
  def.backend = LOAM_BACKEND_CPU;
  def.kernel_radius = scene.spacing;
  def.thread_count = 1;
  def.particle_capacity = std::max<std::size_t>(scene.count(), 1);
  return def;
}

World::World(const loam_world_def &def) { require(loam_world_create(&def, &world_), "loam_world_create"); }

World::~World() { loam_world_destroy(world_); }

loam_material_id World::add(const Scene &scene) {
  loam_material_id material = 0;
  require(loam_material_create(world_, &scene.material, &material), "loam_material_create");

  for (const Plane &plane : scene.planes) {
    loam_collider_def def;
    require(loam_collider_def_default(&def, sizeof def), "loam_collider_def_default");
    def.kind = LOAM_COLLIDER_PLANE;
    std::copy(plane.point, plane.point + 3, def.position);
    rotation_from_up(plane.normal, def.rotation);
    def.friction = plane.friction;
    loam_collider_id collider = 0;
    require(loam_collider_create(world_, &def, &collider), "loam_collider_create");
  }

  loam_particles_def def;
  require(loam_particles_def_default(&def, sizeof def), "loam_particles_def_default");
  def.material = material;
  def.count = scene.count();
  def.positions = scene.positions.data();
  def.velocities = scene.velocities.empty() ? nullptr : scene.velocities.data();
  def.volume = scene.volume();
  require(loam_particles_add(world_, &def, nullptr), "loam_particles_add");
  return material;
}

void World::step(float seconds) { require(loam_world_step(world_, seconds), "loam_world_step"); }

loam_statistics World::statistics() const {
  loam_statistics statistics = {};
  statistics.struct_size = sizeof statistics;
  require(loam_world_get_statistics(world_, &statistics), "loam_world_get_statistics");
  return statistics;
}

std::vector<loam_stage> World::stages() const {
  std::uint32_t count = 0;
  require(loam_world_get_stages(world_, nullptr, 0, &count), "loam_world_get_stages");
  std::vector<loam_stage> stages(count);
  require(loam_world_get_stages(world_, stages.data(), count, &count), "loam_world_get_stages");
  return stages;
}

bool World::has_stage(const std::string &name) const {
  const std::vector<loam_stage> all = stages();
  return std::any_of(all.begin(), all.end(), [&](const loam_stage &stage) { return stage.name == name; });
}

std::uint64_t World::memory_bytes() const {
  std::uint32_t count = 0;
  require(loam_world_get_memory(world_, nullptr, 0, &count), "loam_world_get_memory");
  std::vector<loam_memory> rows(count);
  require(loam_world_get_memory(world_, rows.data(), count, &count), "loam_world_get_memory");
  std::uint64_t bytes = 0;
  for (const loam_memory &row : rows) bytes += row.bytes;
  return bytes;
}

std::uint64_t World::state_hash() const {
  std::uint64_t hash = 0;
  require(loam_world_state_hash(world_, &hash), "loam_world_state_hash");
  return hash;
}

Snapshot World::snapshot() const {
  loam_particle_view view = {};
  view.struct_size = sizeof view;
  require(loam_particles_map(world_, &view), "loam_particles_map");
  Snapshot snapshot;
  const std::size_t count = std::size_t(view.count);
  snapshot.positions.resize(3 * count);
  snapshot.velocities.resize(3 * count);
  snapshot.strains.resize(6 * count);
  snapshot.volumes.resize(count);
  snapshot.inverse_masses.resize(count);
  for (std::size_t place = 0; place < count; ++place) {
    const std::size_t id = view.ids[place];
    std::copy_n(view.positions + 4 * place, 3, &snapshot.positions[3 * id]);
    std::copy_n(view.velocities + 4 * place, 3, &snapshot.velocities[3 * id]);
    std::copy_n(view.strains + 6 * place, 6, &snapshot.strains[6 * id]);
    snapshot.volumes[id] = view.positions[4 * place + 3];
    snapshot.inverse_masses[id] = view.velocities[4 * place + 3];
  }
  require(loam_particles_unmap(world_), "loam_particles_unmap");
  return snapshot;
}

} // namespace loam::scenes
