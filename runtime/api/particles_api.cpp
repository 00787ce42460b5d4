#include "api/guard.h"

using namespace loam;

namespace {

loam_fill_def default_fill() {
  loam_fill_def def = {};
  def.struct_size = sizeof def;
  def.sampling = LOAM_SAMPLING_POISSON_DISK;
  def.jitter = 0.12f;
  def.seed = 1;
  return def;
}

loam_particles_def default_particles() {
  loam_particles_def def = {};
  def.struct_size = sizeof def;
  return def;
}

} // namespace

loam_status loam_fill_def_default(loam_fill_def *def, size_t size) {
  return guarded(nullptr, [&] { write_definition(def, "def", size, default_fill()); });
}

loam_status loam_particles_fill(loam_world *world, const loam_fill_def *def, uint64_t *count) {
  return guarded(world, [&] {
    check_pointer(world, "world");
    const uint64_t made = world->fill(read_definition(def, "def", default_fill()));
    if (count != nullptr) *count = made;
  });
}

loam_status loam_particles_def_default(loam_particles_def *def, size_t size) {
  return guarded(nullptr, [&] { write_definition(def, "def", size, default_particles()); });
}

loam_status loam_particles_add(loam_world *world, const loam_particles_def *def, uint32_t *first_id) {
  return guarded(world, [&] {
    check_pointer(world, "world");
    const uint32_t first = world->add(read_definition(def, "def", default_particles()));
    if (first_id != nullptr) *first_id = first;
  });
}

loam_status loam_particles_remove(loam_world *world, const uint32_t *ids, uint64_t count) {
  return guarded(world, [&] {
    check_pointer(world, "world");
    world->remove_particles(ids, count);
  });
}

loam_status loam_particles_move(loam_world *world, const uint32_t *ids, uint64_t count, const float *positions,
                                const float *velocities) {
  return guarded(world, [&] {
    check_pointer(world, "world");
    world->move_particles(ids, count, positions, velocities);
  });
}

loam_status loam_particles_count(const loam_world *world, uint64_t *count) {
  return guarded(world, [&] {
    check_pointer(world, "world");
    check_pointer(count, "count");
    *count = world->backend().particle_count();
  });
}

// What loam_particle_view was before it had histories.
static constexpr size_t first_view_size = offsetof(loam_particle_view, histories);

loam_status loam_particles_map(loam_world *world, loam_particle_view *view) {
  return guarded(world, [&] {
    check_pointer(world, "world");
    check_pointer(view, "view");
    loam_particle_view values = {};
    const uint32_t size = view->struct_size;
    // checked before mapping, so that a failure leaves nothing mapped
    loam_particle_view probe = {};
    write_definition(&probe, "view", size, values, {first_view_size});
    world->map(values);
    write_definition(view, "view", size, values, {first_view_size});
  });
}

loam_status loam_particles_keep(loam_world *world, loam_particle_view *view) {
  return guarded(world, [&] {
    check_pointer(world, "world");
    check_pointer(view, "view");
    loam_particle_view values = {}, probe = {};
    const uint32_t size = view->struct_size;
    write_definition(&probe, "view", size, values,
                     {first_view_size}); // checked first, so that a failure leaves an earlier frame
    world->backend().keep(values);
    write_definition(view, "view", size, values, {first_view_size});
  });
}

loam_status loam_particles_drop(loam_world *world) {
  return guarded(world, [&] {
    check_pointer(world, "world");
    if (!world->backend().drop()) throw Error(LOAM_ERROR_INVALID_ARGUMENT, "no frame is kept");
  });
}

loam_status loam_particles_unmap(loam_world *world) {
  return guarded(world, [&] {
    check_pointer(world, "world");
    world->unmap();
  });
}
