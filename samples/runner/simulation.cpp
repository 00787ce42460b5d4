#include "simulation.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

#include <fmt/format.h>

#include "device_memory.h"
#include "error.h"

namespace runner {
namespace {

// `mesh` belongs to the scene, which outlives the call that it is given to.
loam_mesh describe(const Mesh &mesh) {
  loam_mesh result{};
  result.positions = &mesh.vertices[0].x;
  result.indices = mesh.indices.data();
  result.vertex_count = static_cast<std::uint32_t>(mesh.vertices.size());
  result.triangle_count = static_cast<std::uint32_t>(mesh.triangle_count());
  return result;
}
loam_distance_grid describe(const DistanceField &field) {
  loam_distance_grid result{};
  result.values = field.values.data();
  for (int axis = 0; axis < 3; ++axis) {
    result.origin[axis] = field.origin[axis];
    result.size[axis] = field.size[axis];
  }
  result.spacing = field.spacing;
  return result;
}
static_assert(sizeof(Vector3) == 3 * sizeof(float), "vertices are handed over as plain floats");

loam_region describe(const SceneRegion &region, const Scene &scene) {
  loam_region result{};
  result.kind = region.kind;
  for (int axis = 0; axis < 3; ++axis) {
    result.center[axis] = region.center[axis];
    result.half_extents[axis] = region.half_extents[axis];
  }
  std::copy(region.rotation.begin(), region.rotation.end(), result.rotation);
  result.radius = region.radius;
  result.half_height = region.half_height;
  if (region.kind == LOAM_REGION_MESH) result.mesh = describe(scene.meshes.at(region.file));
  return result;
}

template <class T> std::vector<T> copy_to_host(const T *from, std::size_t count, std::uint32_t memory) {
  std::vector<T> result(count);
  if (count == 0) return result;
  if (memory == LOAM_MEMORY_HOST)
    std::memcpy(result.data(), from, count * sizeof(T));
  else
    copy_from_device(result.data(), from, count * sizeof(T));
  return result;
}

} // namespace

Simulation::Simulation(Scene &scene) : scene_(&scene) {
  // How many particles a region holds is known only when it has been filled; a world too small says so, and a world too large is
  // made again to measure.
  std::uint64_t capacity = 65536;
  while (!build(capacity)) {
    if (capacity >= std::uint64_t(1) << 28)
      throw Error(fmt::format("{}: more particles than a world can hold", scene.path.string()));
    capacity *= 4;
  }
  // A stream may begin later than a run ends.
  const bool any_stream = std::any_of(scene.emitters.begin(), scene.emitters.end(),
                                      [](const SceneEmitter &emitter) { return emitter.stream.has_value(); });
  if (particle_count_ == 0 && !any_stream && !scene.emitters.empty())
    throw Error(fmt::format("{}: the emitters make no particles", scene.path.string()));
  const std::uint64_t needed = std::max<std::uint64_t>(1, particle_count_ + stream_count_);
  if (!build(scene.particle_capacity != 0 ? scene.particle_capacity : needed)) {
    if (scene.particle_capacity != 0)
      throw Error(fmt::format("{}:{}: world.particle_capacity: is {}; the emitters make {} particles at the start",
                              scene.path.string(), scene.world_place.line, scene.particle_capacity, particle_count_));
    throw Error(fmt::format("{}: the emitters do not repeat themselves", scene.path.string()));
  }
  spins_.assign(scene.colliders.size(), 0);
}

void Simulation::check(loam_status status, const Place &place) const {
  if (status == LOAM_OK) return;
  const std::string where = place.line == 0 ? std::string() : fmt::format(":{}", place.line);
  const std::string what = place.key.empty() ? std::string() : fmt::format("{}: ", place.key);
  throw Error(
      fmt::format("{}{}: {}{} ({})", scene_->path.string(), where, what, loam_last_error(), loam_status_name(status)));
}

bool Simulation::build(std::uint64_t particle_capacity) {
  world_.reset();
  material_ids_.clear();
  collider_ids_.clear();
  cloth_ids_.clear();
  emitter_ends_.clear();
  particle_count_ = stream_count_ = 0;

  loam_world_def world_def = scene_->world;
  world_def.particle_capacity = particle_capacity;
  loam_world *world = nullptr;
  check(loam_world_create(&world_def, &world), scene_->world_place);
  world_.reset(world);
  if (scene_->accuracy) check(loam_world_use_accuracy(world, &*scene_->accuracy), scene_->world_place);

  std::vector<loam_material_id> materials;
  for (const SceneMaterial &material : scene_->materials) {
    loam_material_id id = 0;
    check(loam_material_create(world, &material.def, &id), material.place);
    materials.push_back(id);
    material_ids_.push_back(static_cast<std::uint32_t>(id));
  }

  const auto id_of = [&](const std::string &name) {
    const auto material = std::find_if(scene_->materials.begin(), scene_->materials.end(),
                                       [&](const SceneMaterial &candidate) { return candidate.name == name; });
    return materials[static_cast<std::size_t>(material - scene_->materials.begin())];
  };
  for (const SceneContact &contact : scene_->contacts)
    for (std::size_t i = 0; i < contact.materials.size(); ++i)
      for (std::size_t j = 0; j < i; ++j)
        check(loam_material_set_meeting(world, id_of(contact.materials[i]), id_of(contact.materials[j]),
                                        LOAM_MEETING_CONTACT, contact.friction),
              contact.place);

  for (const SceneCollider &collider : scene_->colliders) {
    loam_collider_def def{};
    check(loam_collider_def_default(&def, sizeof def), collider.place);
    def.kind = collider.kind;
    for (int axis = 0; axis < 3; ++axis) def.position[axis] = collider.pose.position[axis];
    std::copy(collider.pose.rotation.begin(), collider.pose.rotation.end(), def.rotation);
    def.friction = collider.friction;
    def.restitution = collider.restitution;
    def.stick = collider.stick;
    def.reaction = collider.hinge ? 1 : 0;
    if (collider.kind == LOAM_COLLIDER_MESH || collider.kind == LOAM_COLLIDER_HULL)
      def.mesh = describe(scene_->meshes.at(collider.file));
    def.radius = collider.radius;
    def.half_height = collider.half_height;
    for (int axis = 0; axis < 3; ++axis) def.half_extents[axis] = collider.half_extents[axis];
    if (collider.kind == LOAM_COLLIDER_GRID) def.grid = describe(collider.field);
    def.deforms = collider.deformations.empty() ? 0 : 1;
    loam_collider_id id = 0;
    check(loam_collider_create(world, &def, &id), collider.place);
    collider_ids_.push_back(id);
  }
  deform(0, &loam_collider_place_vertices);

  for (const SceneEmitter &emitter : scene_->emitters) {
    if (emitter.stream) {
      emitter_ends_.push_back(particle_count_);
      continue;
    }
    loam_fill_def def = emitter.def;
    def.material = id_of(emitter.material);
    def.region = describe(emitter.region, *scene_);
    def.cut = describe(emitter.cut, *scene_);
    std::uint64_t count = 0;
    const loam_status status = loam_particles_fill(world, &def, &count);
    if (status == LOAM_ERROR_CAPACITY) return false;
    check(status, emitter.place);
    particle_count_ += count;
    emitter_ends_.push_back(particle_count_);
  }
  make_cloths();
  for (const SceneEmitter &emitter : scene_->emitters) {
    if (!emitter.stream) continue;
    loam_emitter_def def = *emitter.stream;
    def.material = id_of(emitter.material);
    if (def.nozzle == LOAM_NOZZLE_MESH) def.mesh = describe(scene_->meshes.at(emitter.nozzle));
    loam_emitter_id id = 0;
    const loam_status status = loam_emitter_create(world, &def, &id);
    if (status == LOAM_ERROR_CAPACITY && scene_->particle_capacity == 0) return false;
    check(status, emitter.place);
    loam_emitter_report report{};
    report.struct_size = sizeof report;
    check(loam_emitter_get_report(world, id, &report), emitter.place);
    const double end = static_cast<double>(scene_->frames) / scene_->frame_rate;
    const double seconds = (def.stop > 0 ? std::min<double>(def.stop, end) : end) - static_cast<double>(def.start);
    // And a layer, for roundings.
    const double layer = report.volume_flow / report.volume *
                         static_cast<double>(def.spacing > 0 ? def.spacing : scene_->world.kernel_radius) /
                         static_cast<double>(def.speed);
    if (seconds > 0)
      stream_count_ +=
          static_cast<std::uint64_t>(std::min(1e9, std::ceil(seconds * report.volume_flow / report.volume + layer + 1)));
  }
  for (const SceneField &field : scene_->fields) {
    loam_field_id id = 0;
    check(loam_field_create(world, &field.def, &id), field.place);
  }
  for (const SceneKiller &killer : scene_->killers) {
    loam_killer_def def = killer.def;
    if (!killer.material.empty()) def.material = id_of(killer.material);
    loam_killer_id id = 0;
    check(loam_killer_create(world, &def, &id), killer.place);
  }
  return true;
}

void Simulation::make_cloths() {
  loam_world *world = world_.get();
  for (const SceneCloth &cloth : scene_->cloths) {
    loam_cloth_def def = cloth.def;
    def.mesh = describe(scene_->meshes.at(cloth.file));
    loam_cloth_id id = 0;
    check(loam_cloth_create(world, &def, &id), cloth.place);
    cloth_ids_.push_back(id);
    for (const SceneAttachment &attachment : cloth.attachments) {
      loam_cloth_attachment_def held{};
      check(loam_cloth_attachment_def_default(&held, sizeof held), attachment.place);
      held.count = static_cast<std::uint32_t>(attachment.vertices.size());
      held.vertices = attachment.vertices.data();
      held.compliance = attachment.compliance;
      if (attachment.collider) held.collider = collider_ids_[*attachment.collider];
      check(loam_cloth_attach(world, id, &held), attachment.place);
    }
    check(loam_cloth_set_wind(world, id, &cloth.wind_velocity.x, cloth.drag, cloth.lift), cloth.wind_place);
  }
}

void Simulation::release_attachments(double end) {
  for (std::size_t i = 0; i < scene_->cloths.size(); ++i)
    for (const SceneAttachment &attachment : scene_->cloths[i].attachments) {
      const double before = end - 1.0 / scene_->frame_rate;
      if (!(attachment.release < end && (attachment.release >= before || frame_ == 0))) continue;
      check(loam_cloth_release(world_.get(), cloth_ids_[i], attachment.vertices.data(),
                               static_cast<std::uint32_t>(attachment.vertices.size())),
            attachment.place);
    }
}

// Of matter that streams, the first stream of its material.
std::uint32_t Simulation::emitter_of(std::uint32_t id, std::uint32_t material) const {
  const auto filled = std::upper_bound(emitter_ends_.begin(), emitter_ends_.end(), std::uint64_t(id));
  if (filled != emitter_ends_.end()) return static_cast<std::uint32_t>(filled - emitter_ends_.begin());
  const auto stream = std::find_if(scene_->emitters.begin(), scene_->emitters.end(), [&](const SceneEmitter &emitter) {
    return emitter.stream && emitter.material == scene_->materials[material].name;
  });
  return static_cast<std::uint32_t>(stream - scene_->emitters.begin());
}

// By what matter did to them in the last step. A hinge's collider turns at that speed for the next one.
void Simulation::turn_hinges(double seconds) {
  for (std::size_t i = 0; i < scene_->colliders.size(); ++i) {
    SceneCollider &collider = scene_->colliders[i];
    if (!collider.hinge) continue;
    const SceneHinge &hinge = *collider.hinge;
    loam_collider_reaction reaction{};
    reaction.struct_size = sizeof reaction;
    check(loam_collider_get_reaction(world_.get(), collider_ids_[i], &reaction), collider.place);
    const double moment =
        reaction.torque[0] * hinge.axis.x + reaction.torque[1] * hinge.axis.y + reaction.torque[2] * hinge.axis.z;
    spins_[i] = (spins_[i] + moment / hinge.inertia) / (1 + hinge.damping * seconds / hinge.inertia);
    const double start = static_cast<double>(frame_) * seconds;
    collider.motions.push_back({start, start + seconds, {}, hinge.axis, spins_[i]});
  }
}

void Simulation::deform(double time, MoveVertices *move) {
  for (std::size_t i = 0; i < scene_->colliders.size(); ++i) {
    const SceneCollider &collider = scene_->colliders[i];
    if (collider.deformations.empty()) continue;
    const Mesh mesh = deformed(scene_->meshes.at(collider.file), collider.deformations, time);
    check(move(world_.get(), collider_ids_[i], &mesh.vertices[0].x, static_cast<std::uint32_t>(mesh.vertices.size())),
          collider.place);
  }
}

void Simulation::step() {
  const double end = static_cast<double>(frame_ + 1) / scene_->frame_rate;
  turn_hinges(1 / scene_->frame_rate);
  for (std::size_t i = 0; i < scene_->colliders.size(); ++i) {
    const SceneCollider &collider = scene_->colliders[i];
    if (collider.motions.empty()) continue;
    const Pose pose = pose_at(collider.pose, collider.motions, end);
    check(loam_collider_move(world_.get(), collider_ids_[i], &pose.position.x, pose.rotation.data()), collider.place);
  }
  deform(end, &loam_collider_move_vertices);
  release_attachments(end);
  const loam_status status = loam_world_step(world_.get(), static_cast<float>(1.0 / scene_->frame_rate));
  if (status == LOAM_ERROR_BUDGET)
    ++over_budget_; // the step was done
  else
    check(status, {});
  ++frame_;
}

Simulation::State Simulation::save() const {
  std::uint64_t bytes = 0;
  check(loam_snapshot_size(world_.get(), &bytes), {});
  State state = {std::vector<std::byte>(bytes), spins_, frame_};
  check(loam_snapshot_save(world_.get(), state.world.data(), bytes, nullptr), {});
  return state;
}

void Simulation::restore(const State &state) {
  check(loam_snapshot_restore(world_.get(), state.world.data(), state.world.size()), {});
  spins_ = state.spins;
  frame_ = state.frame;
}

void Simulation::use_accuracy(const loam_accuracy_def &accuracy) {
  check(loam_world_use_accuracy(world_.get(), &accuracy), {});
}

loam_accuracy_def Simulation::accuracy() const {
  loam_accuracy_def def;
  check(loam_world_get_accuracy(world_.get(), &def, sizeof def), {});
  return def;
}

Particles Simulation::read_particles() const {
  loam_particle_view view{};
  view.struct_size = sizeof view;
  check(loam_particles_map(world_.get(), &view), {});
  struct Unmap {
    loam_world *world;
    ~Unmap() { loam_particles_unmap(world); }
  } unmap{world_.get()};
  const std::size_t count = view.count;
  const std::vector<std::uint32_t> ids = copy_to_host(view.ids, count, view.memory);
  const std::vector<std::uint32_t> materials = copy_to_host(view.materials, count, view.memory);
  const std::vector<float> positions = copy_to_host(view.positions, 4 * count, view.memory);
  const std::vector<float> velocities = copy_to_host(view.velocities, 4 * count, view.memory);

  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return ids[a] < ids[b]; });
  Particles result;
  result.ids.reserve(count);
  result.positions.reserve(count);
  result.velocities.reserve(count);
  result.materials.reserve(count);
  result.emitters.reserve(count);
  for (const std::size_t i : order) {
    result.ids.push_back(ids[i]);
    result.positions.push_back({positions[4 * i], positions[4 * i + 1], positions[4 * i + 2]});
    result.velocities.push_back({velocities[4 * i], velocities[4 * i + 1], velocities[4 * i + 2]});
    const auto material = std::find(material_ids_.begin(), material_ids_.end(), materials[i]);
    result.materials.push_back(static_cast<std::uint32_t>(material - material_ids_.begin()));
    result.emitters.push_back(emitter_of(ids[i], result.materials.back()));
  }
  return result;
}

std::vector<Mesh> Simulation::read_cloths() const {
  std::vector<Mesh> result;
  for (std::size_t i = 0; i < cloth_ids_.size(); ++i) {
    loam_cloth_view view{};
    view.struct_size = sizeof view;
    check(loam_cloth_map(world_.get(), cloth_ids_[i], &view), scene_->cloths[i].place);
    const std::vector<float> positions = copy_to_host(view.positions, 4 * std::size_t(view.vertex_count), view.memory);
    Mesh mesh;
    mesh.indices = copy_to_host(view.indices, 3 * std::size_t(view.triangle_count), view.memory);
    check(loam_cloth_unmap(world_.get(), cloth_ids_[i]), scene_->cloths[i].place);
    for (std::size_t v = 0; v < positions.size(); v += 4)
      mesh.vertices.push_back({positions[v], positions[v + 1], positions[v + 2]});
    result.push_back(std::move(mesh));
  }
  return result;
}

loam_statistics Simulation::statistics() const {
  loam_statistics result{};
  result.struct_size = sizeof result;
  check(loam_world_get_statistics(world_.get(), &result), {});
  return result;
}

std::vector<loam_stage> Simulation::stages() const {
  std::uint32_t count = 0;
  check(loam_world_get_stages(world_.get(), nullptr, 0, &count), {});
  std::vector<loam_stage> result(count);
  check(loam_world_get_stages(world_.get(), result.data(), count, &count), {});
  return result;
}

std::vector<loam_memory> Simulation::memory() const {
  std::uint32_t count = 0;
  check(loam_world_get_memory(world_.get(), nullptr, 0, &count), {});
  std::vector<loam_memory> result(count);
  check(loam_world_get_memory(world_.get(), result.data(), count, &count), {});
  return result;
}

std::uint64_t Simulation::state_hash() const {
  std::uint64_t hash = 0;
  check(loam_world_state_hash(world_.get(), &hash), {});
  return hash;
}

std::string Simulation::backend() const {
  std::uint32_t backend = 0;
  check(loam_world_get_backend(world_.get(), &backend, nullptr), {});
  return backend == LOAM_BACKEND_CUDA ? "cuda" : "cpu";
}

std::string Simulation::instruction_set() const {
  std::uint32_t backend = 0, instruction_set = 0;
  check(loam_world_get_backend(world_.get(), &backend, &instruction_set), {});
  if (backend == LOAM_BACKEND_CUDA) return "";
  switch (instruction_set) {
  case LOAM_INSTRUCTION_SET_PORTABLE:
    return "portable";
  case LOAM_INSTRUCTION_SET_SSE4:
    return "sse4";
  case LOAM_INSTRUCTION_SET_AVX2:
    return "avx2";
  case LOAM_INSTRUCTION_SET_AVX512:
    return "avx512";
  default:
    return "unknown";
  }
}

} // namespace runner
