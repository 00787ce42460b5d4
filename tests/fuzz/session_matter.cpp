/* Materials, colliders and particles come, change and go. */
#include "session_actions.h"

#include <limits>

namespace loam::fuzz {

namespace {

/* A kernel radius of kilometres puts some places farther out than a collider may be. */
bool is_in_range(const float position[3]) {
  return std::all_of(position, position + 3, [](float x) { return std::fabs(x) <= 1e9f; });
}

} // namespace

// ------------------------------------------------------------------------------------------ materials and colliders ---

void Session::create_material(Random &random) {
  const loam_material_def def = random_material(random);
  loam_material_id id = 0;
  const Expect expect = mapped_ ? Expect::failure : Expect::anything;
  if (!call("create material", expect, [&] { return loam_material_create(world_, &def, &id); })) return;
  now_.materials.push_back({id, 0});
  ++description_;
  loam_material_def back = {};
  back.struct_size = sizeof back;
  judge("get material", Expect::success, loam_material_get(world_, id, &back));
  if (std::memcmp(&back, &def, sizeof def) != 0) find("a material does not come back as it was given");
}

void Session::change_material(Random &random) {
  if (now_.materials.empty()) return;
  const Material &material = now_.materials[random.below(now_.materials.size())];
  loam_material_def before = {};
  before.struct_size = sizeof before;
  judge("get material", Expect::success, loam_material_get(world_, material.id, &before));
  loam_material_def def = random_material(random);
  if (random.chance(0.6)) scale_numbers(def = before, random);
  if (random.chance(0.1)) spoil(def, random);
  const bool keeps = def.law == before.law && def.density == before.density;
  const bool changed = call("change material", mapped_ ? Expect::failure : Expect::anything,
                            [&] { return loam_material_set(world_, material.id, &def); });
  if (changed) ++description_;
  if (changed && material.particles > 0 && !keeps) find("law or density of a material in use were changed");
}

void Session::change_meeting(Random &random) {
  if (now_.materials.empty()) return;
  const loam_material_id a = any_material(random), b = any_material(random);
  const std::uint32_t meeting = random.chance(0.7) ? LOAM_MEETING_CONTACT : LOAM_MEETING_SHARED;
  const float friction = random.log_between(0.01, 100);
  if (call("change meeting", a == b || mapped_ ? Expect::failure : Expect::success,
           [&] { return loam_material_set_meeting(world_, a, b, meeting, friction); }))
    ++description_;
}

void Session::change_contact(Random &random) {
  if (now_.colliders.empty()) return;
  const loam_collider_id collider = any(now_.colliders, random).id;
  const loam_material_id material = now_.materials.empty() || random.chance(0.3) ? 0 : any_material(random);
  const bool take_away = material != 0 && random.chance(0.2);
  loam_collider_contact contact = {sizeof contact, random.log_between(0.01, 100),
                                   random.chance(0.5) ? 0 : random.between(0, 1),
                                   random.chance(0.5) ? 0 : random.log_between(1, 1e9)};
  if (!call("change contact", mapped_ ? Expect::anything : Expect::success,
            [&] { return loam_collider_set_contact(world_, collider, material, take_away ? nullptr : &contact); }))
    return;
  ++description_;
  loam_collider_contact back = {};
  back.struct_size = sizeof back;
  judge("get contact", Expect::success, loam_collider_get_contact(world_, collider, material, &back));
  if (!take_away && std::memcmp(&back, &contact, sizeof contact) != 0) find("a contact does not come back as it was given");
}

void Session::destroy_material(Random &random) {
  if (now_.materials.empty()) return;
  const std::size_t which = random.below(now_.materials.size());
  const Material material = now_.materials[which];
  const bool may_be_in_use = material.particles > 0 || mapped_ || !now_.emitters.empty();
  const Expect expect = may_be_in_use ? Expect::anything : Expect::success;
  if (!call("destroy material", expect, [&] { return loam_material_destroy(world_, material.id); })) return;
  if (material.particles > 0) find("a material that is in use was destroyed");
  ++description_;
  stale_.push_back(material.id);
  now_.materials.erase(now_.materials.begin() + std::ptrdiff_t(which));
}

void Session::create_collider(Random &random) {
  ColliderArrays arrays;
  const loam_collider_def def = random_collider(random, def_.kernel_radius, arrays);
  loam_collider_id id = 0;
  const bool arrays_may_be_refused = // slivers may leave no triangle
      def.kind == LOAM_COLLIDER_MESH || def.kind == LOAM_COLLIDER_HULL || def.kind == LOAM_COLLIDER_GRID;
  const Expect expect = !is_in_range(def.position) ? Expect::invalid
                        : arrays_may_be_refused    ? Expect::anything
                                                   : Expect::success;
  if (!call("create collider", expect, [&] { return loam_collider_create(world_, &def, &id); })) return;
  Collider collider = {};
  collider.id = id;
  for (float *place : {collider.position, collider.target_position}) std::copy(def.position, def.position + 3, place);
  for (float *turn : {collider.rotation, collider.target_rotation}) std::copy(def.rotation, def.rotation + 4, turn);
  if (def.deforms == 1) collider.vertices = collider.target_vertices = arrays.mesh.positions;
  now_.colliders.push_back(collider);
  ++description_;
  loam_collider_report found = {};
  found.struct_size = sizeof found;
  judge("report", Expect::success, loam_collider_get_report(world_, id, &found));
  if (found.triangles + found.degenerate_triangles != def.mesh.triangle_count)
    find("%u of %u triangles reported", found.triangles, def.mesh.triangle_count);
}

void Session::destroy_collider(Random &random) {
  if (now_.colliders.empty()) return;
  const std::size_t which = random.below(now_.colliders.size());
  const loam_collider_id id = now_.colliders[which].id;
  bool holds = false;
  for (const Cloth &cloth : now_.cloths) holds = holds || std::count(cloth.held.begin(), cloth.held.end(), id) > 0;
  if (!call("destroy collider", holds ? Expect::in_use : Expect::success, [&] { return loam_collider_destroy(world_, id); }))
    return;
  ++description_;
  stale_.push_back(id);
  now_.colliders.erase(now_.colliders.begin() + std::ptrdiff_t(which));
}

void Session::pose_collider(Random &random) {
  if (now_.colliders.empty()) return;
  Collider &collider = now_.colliders[random.below(now_.colliders.size())];
  const bool teleport = random.chance(0.2);
  float position[3], rotation[4];
  random_place(random, def_.kernel_radius, position, rotation);
  if (!random.chance(0.2)) { // a small step from where it is, at times a turn
    const bool turn = random.chance(0.3);
    for (int k = 0; k < 3; ++k) position[k] = collider.position[k] + 0.05f * position[k];
    if (!turn) std::copy(collider.rotation, collider.rotation + 4, rotation);
  }
  const auto pose = teleport ? loam_collider_place : loam_collider_move;
  const Expect expect = is_in_range(position) ? Expect::success : Expect::invalid;
  if (!call(teleport ? "place collider" : "move collider", expect,
            [&] { return pose(world_, collider.id, position, rotation); }))
    return;
  std::copy(position, position + 3, collider.target_position);
  std::copy(rotation, rotation + 4, collider.target_rotation);
  if (!teleport) return;
  std::copy(position, position + 3, collider.position);
  std::copy(rotation, rotation + 4, collider.rotation);
}

/* A little, wildly, to a point, or to where it is; badly at times. */
void Session::deform_collider(Random &random) {
  if (now_.colliders.empty()) return;
  Collider &collider = any(now_.colliders, random);
  std::vector<float> to = collider.vertices;
  const float r = def_.kernel_radius, wild = random.chance(0.2) ? 4 : random.log_between(0.01, 1);
  const bool collapses = random.chance(0.05), stays = random.chance(0.1), at_once = random.chance(0.2);
  float scale[3];
  for (float &s : scale) s = random.chance(0.5) ? 1 : random.between(0.5f, 1.6f);
  for (std::size_t i = 0; i < to.size() && !stays; ++i)
    to[i] = collapses ? r : scale[i % 3] * to[i] + wild * r * random.between(-1, 1);
  for (const float x : to)
    if (!(std::fabs(x) <= 1e8f)) return; // grown too large
  if (to.empty()) to.resize(9);
  auto count = std::uint32_t(to.size() / 3);
  Expect expect = collider.vertices.empty() ? Expect::invalid : Expect::success;
  if (random.chance(0.05)) {
    expect = Expect::invalid;
    if (random.chance(0.5))
      to[random.below(to.size())] = std::numeric_limits<float>::quiet_NaN();
    else
      count += random.chance(0.5) ? 1 : ~0u;
  }
  const auto move = at_once ? loam_collider_place_vertices : loam_collider_move_vertices;
  if (!call(at_once ? "place vertices" : "move vertices", expect,
            [&] { return move(world_, collider.id, to.data(), count); }))
    return;
  collider.target_vertices = to;
  if (at_once) collider.vertices = to;
}

// ------------------------------------------------------------------------------------------------------- particles ---

void Session::fill(Random &random) {
  if (now_.materials.empty()) return;
  RegionMeshes meshes;
  loam_fill_def def = random_fill(random, def_.kernel_radius, meshes);
  Material &material = now_.materials[random.below(now_.materials.size())];
  def.material = material.id;
  std::uint64_t made = 0;
  if (!call("fill", mapped_ ? Expect::in_use : Expect::anything, [&] { return loam_particles_fill(world_, &def, &made); }))
    return;
  if (made == 0) find("a fill made no particles and said nothing");
  material.particles += made;
  born(made, false);
  look();
}

void Session::add(Random &random) {
  if (now_.materials.empty()) return;
  ParticleArrays arrays;
  loam_particles_def def = random_particles(random, def_.kernel_radius, arrays);
  Material &material = now_.materials[random.below(now_.materials.size())];
  def.material = material.id;
  std::uint32_t first = 0;
  if (!call("add", mapped_ ? Expect::in_use : Expect::anything, [&] { return loam_particles_add(world_, &def, &first); }))
    return;
  if (first != now_.particles.size()) find("the first id is %u, not %zu", first, now_.particles.size());
  material.particles += def.count;
  born(def.count, false);
  if (now_.count > def_.particle_capacity) find("more particles than particle_capacity");
  look();
}

void Session::born(std::uint64_t count, bool streamed) {
  now_.count += count;
  now_.particles.resize(now_.particles.size() + count, Particle{true, streamed, -1, 0, {0, 0, 0}});
}

void Session::unmap() {
  if (call("unmap", mapped_ ? Expect::success : Expect::invalid, [&] { return loam_particles_unmap(world_); }))
    mapped_ = false;
}

void Session::map(Random &) {
  loam_particle_view view = {};
  view.struct_size = sizeof view;
  if (!call("map", mapped_ ? Expect::in_use : Expect::success, [&] { return loam_particles_map(world_, &view); })) return;
  mapped_ = true;
  check_view(view);
  judge("map again", Expect::in_use, loam_particles_map(world_, &view));
}

void Session::ask(Random &random) {
  std::uint64_t count = 0;
  judge("count", Expect::success, loam_particles_count(world_, &count));
  if (count != now_.count) find("%llu particles instead of %llu", (unsigned long long)count, (unsigned long long)now_.count);
  loam_stage stages[64];
  loam_memory rows[64];
  std::uint32_t have = 0, backend = 0, instruction_set = 0;
  const std::uint32_t room = random.below(64);
  judge("stages", Expect::success, loam_world_get_stages(world_, stages, room, &have));
  for (std::uint32_t i = 0; i < std::min(have, room); ++i)
    if (std::memchr(stages[i].name, 0, sizeof stages[i].name) == nullptr || !(stages[i].seconds >= 0)) find("stage %u", i);
  judge("memory", Expect::success, loam_world_get_memory(world_, rows, room, &have));
  for (std::uint32_t i = 0; i < std::min(have, room); ++i)
    if (std::memchr(rows[i].effect, 0, sizeof rows[i].effect) == nullptr) find("memory row %u", i);
  judge("backend", Expect::success, loam_world_get_backend(world_, &backend, &instruction_set));
  if (backend != LOAM_BACKEND_CPU || instruction_set == LOAM_INSTRUCTION_SET_AUTO)
    find("backend %u %u", backend, instruction_set);
  if (!now_.materials.empty()) {
    loam_material_def def = {};
    def.struct_size = sizeof def;
    judge("get material", Expect::success, loam_material_get(world_, any_material(random), &def));
  }
}

} // namespace loam::fuzz
