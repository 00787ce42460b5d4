/* What must be refused. */
#include "session_actions.h"

namespace loam::fuzz {

void Session::bad_number_or_choice(Random &random) {
  const float bad = bad_number(random), position[3] = {0, 0, 0}, rotation[4] = {0, 0, 0, 1};
  float spoilt[4] = {0, 0, 0, 1};
  spoilt[random.below(3)] = bad;
  switch (random.below(9)) {
  case 0: {
    constexpr float times[] = {0.0f, -1.0f, 1.0001f, 1e-12f};
    const float seconds = random.chance(0.5) ? bad : random.pick(times);
    call("step for a bad time", mapped_ ? Expect::failure : Expect::invalid,
         [&] { return loam_world_step(world_, seconds); });
    break;
  }
  case 1:
    call("set bad gravity", Expect::invalid, [&] { return loam_world_set_gravity(world_, spoilt); });
    break;
  case 2: {
    const bool first = random.chance(0.5);
    const std::uint32_t wrong = random.chance(0.5) ? 0 : random.from(10001, ~0u);
    call("set bad accuracy", Expect::invalid,
         [&] { return loam_world_set_accuracy(world_, first ? wrong : 1, first ? 1 : wrong); });
    break;
  }
  case 3: {
    loam_material_def def = random_material(random);
    spoil(def, random);
    loam_material_id id = 0;
    if (call("create a bad material", Expect::anything, [&] { return loam_material_create(world_, &def, &id); }))
      now_.materials.push_back({id, 0}), ++description_;
    break;
  }
  case 4: {
    ColliderArrays arrays;
    loam_collider_def def = random_collider(random, def_.kernel_radius, arrays);
    spoil(def, random, arrays);
    loam_collider_id id = 0;
    call("create a bad collider", Expect::failure, [&] { return loam_collider_create(world_, &def, &id); });
    break;
  }
  case 5: {
    if (now_.colliders.empty()) return;
    const loam_collider_id id = now_.colliders[random.below(now_.colliders.size())].id;
    const bool turned = random.chance(0.5), none = random.chance(0.3);
    if (none) spoilt[3] = 0;
    const float zero[4] = {0, 0, 0, 0};
    const auto pose = random.chance(0.5) ? loam_collider_place : loam_collider_move;
    call("pose a collider badly", Expect::invalid,
         [&] { return pose(world_, id, turned ? position : spoilt, turned ? (none ? zero : spoilt) : rotation); });
    break;
  }
  case 6: {
    if (now_.materials.empty()) return;
    RegionMeshes meshes;
    loam_fill_def def = random_fill(random, def_.kernel_radius, meshes);
    def.material = any_material(random);
    spoil(def, random, meshes);
    call("bad fill", Expect::failure, [&] { return loam_particles_fill(world_, &def, nullptr); });
    break;
  }
  case 7: {
    if (now_.materials.empty()) return;
    ParticleArrays arrays;
    loam_particles_def def = random_particles(random, def_.kernel_radius, arrays);
    def.material = any_material(random);
    spoil(def, random, arrays);
    call("bad add", Expect::failure, [&] { return loam_particles_add(world_, &def, nullptr); });
    break;
  }
  default: {
    loam_world_def def = random_world(random);
    switch (random.below(5)) {
    case 0:
      def.kernel_radius = random.chance(0.5) ? 0.0f : bad;
      break;
    case 1:
      def.substeps = random.chance(0.5) ? 0 : 10001;
      break;
    case 2:
      def.thread_count = 257;
      break;
    case 3:
      def.solver = LOAM_SOLVER_JACOBI + 1 + random.below(9);
      break;
    default:
      def.particle_capacity = random.chance(0.5) ? 0 : std::uint64_t(1) << random.from(29, 63);
      break;
    }
    loam_world *none = world_;
    call("create a bad world", Expect::failure, [&] { return loam_world_create(&def, &none); });
    if (!leaves_out() && none != nullptr) find("a world came of a bad definition");
    break;
  }
  }
}

void Session::bad_handle(Random &random) {
  const std::uint32_t which = random.below(10);
  std::uint64_t id = 0;
  if (!stale_.empty() && random.chance(0.6))
    id = stale_[random.below(stale_.size())];
  else if (random.chance(0.3))
    id = random.next();
  else if (which < 3 && !now_.materials.empty()) // good, but of another kind
    id = any_material(random);
  else if (which >= 3 && !now_.colliders.empty())
    id = now_.colliders[random.below(now_.colliders.size())].id;
  const float position[3] = {0, 0, 0}, rotation[4] = {0, 0, 0, 1};
  switch (which) {
  case 0:
    call("destroy no collider", Expect::stale, [&] { return loam_collider_destroy(world_, id); });
    break;
  case 1:
    call("move no collider", Expect::stale, [&] { return loam_collider_move(world_, id, position, rotation); });
    break;
  case 2: {
    loam_collider_report report = {};
    report.struct_size = sizeof report;
    call("report no collider", Expect::stale, [&] { return loam_collider_get_report(world_, id, &report); });
    break;
  }
  case 7:
    call("destroy no emitter", mapped_ ? Expect::failure : Expect::stale, [&] { return loam_emitter_destroy(world_, id); });
    break;
  case 8:
    call("destroy no field", Expect::stale, [&] { return loam_field_destroy(world_, id); });
    break;
  case 9:
    call("destroy no killer", mapped_ ? Expect::failure : Expect::stale, [&] { return loam_killer_destroy(world_, id); });
    break;
  case 3:
    call("destroy no material", Expect::stale, [&] { return loam_material_destroy(world_, id); });
    break;
  case 4: {
    loam_material_def def = {};
    def.struct_size = sizeof def;
    call("get no material", Expect::stale, [&] { return loam_material_get(world_, id, &def); });
    break;
  }
  case 5: {
    RegionMeshes meshes;
    loam_fill_def def = random_fill(random, def_.kernel_radius, meshes);
    def.material = id;
    call("fill with nothing", mapped_ ? Expect::failure : Expect::stale,
         [&] { return loam_particles_fill(world_, &def, nullptr); });
    break;
  }
  default: {
    ParticleArrays arrays;
    loam_particles_def def = random_particles(random, def_.kernel_radius, arrays);
    def.material = id;
    call("add nothing", mapped_ ? Expect::failure : Expect::stale,
         [&] { return loam_particles_add(world_, &def, nullptr); });
    break;
  }
  }
}

void Session::bad_pointer(Random &random) {
  const float rotation[4] = {0, 0, 0, 1};
  const loam_collider_id collider = now_.colliders.empty() ? 0 : now_.colliders.front().id;
  const auto refused = [&](auto &&f) { call("null", Expect::failure, f); };
  std::uint32_t count = 0;
  switch (random.below(14)) {
  case 0:
    return refused([&] { return loam_world_step(nullptr, 0.01f); });
  case 1:
    return refused([&] { return loam_world_set_gravity(world_, nullptr); });
  case 2:
    return refused([&] { return loam_material_create(world_, nullptr, nullptr); });
  case 3:
    return refused([&] { return loam_collider_create(world_, nullptr, nullptr); });
  case 4:
    return refused([&] { return loam_particles_fill(world_, nullptr, nullptr); });
  case 5:
    return refused([&] { return loam_particles_add(world_, nullptr, nullptr); });
  case 6:
    return refused([&] { return loam_particles_map(world_, nullptr); });
  case 7:
    return refused([&] { return loam_world_get_statistics(world_, nullptr); });
  case 8:
    return refused([&] { return loam_world_get_stages(world_, nullptr, 1, &count); });
  case 9:
    return refused([&] { return loam_collider_move(world_, collider, nullptr, rotation); });
  case 10:
    return refused([&] { return loam_world_state_hash(world_, nullptr); });
  case 11:
    return refused([&] { return loam_particles_count(nullptr, nullptr); });
  case 12:
    return refused([&] {
      loam_statistics statistics = {};
      statistics.struct_size = 3;
      return loam_world_get_statistics(world_, &statistics);
    });
  default:
    return refused([&] {
      loam_world *none = nullptr;
      return loam_world_create(nullptr, &none);
    });
  }
}

} // namespace loam::fuzz
