#include "api/guard.h"

#include <cstddef>

using namespace loam;

namespace {

constexpr std::initializer_list<std::size_t> earlier_world_sizes = {offsetof(loam_world_def, warm_start)};

} // namespace

loam_status loam_world_def_default(loam_world_def *def, size_t size) {
  return guarded(nullptr, [&] { write_definition(def, "def", size, default_world(), earlier_world_sizes); });
}

loam_status loam_world_create(const loam_world_def *def, loam_world **world) {
  return guarded(nullptr, [&] {
    check_pointer(world, "world");
    *world = nullptr;
    const loam_world_def copy = read_definition(def, "def", default_world(), earlier_world_sizes);
    check_world_def(copy);
    *world = new loam_world(copy);
  });
}

loam_status loam_world_destroy(loam_world *world) {
  return guarded(nullptr, [&] { delete world; });
}

loam_status loam_world_step(loam_world *world, float seconds) {
  return guarded(world, [&] {
    check_pointer(world, "world");
    world->step(seconds);
  });
}

loam_status loam_world_step_async(loam_world *world, float seconds) {
  return guarded(world, [&] {
    check_pointer(world, "world");
    world->begin_step(seconds);
  });
}

loam_status loam_world_wait(loam_world *world) {
  return guarded(
      world,
      [&] {
        check_pointer(world, "world");
        world->wait();
      },
      Meanwhile::allowed);
}

loam_status loam_world_is_stepping(const loam_world *world, uint32_t *running) {
  return guarded(
      world,
      [&] {
        check_pointer(world, "world");
        check_pointer(running, "running");
        *running = world->is_stepping() ? 1 : 0;
      },
      Meanwhile::allowed);
}

loam_status loam_world_shift_origin(loam_world *world, const float offset[3]) {
  return guarded(world, [&] {
    check_pointer(world, "world");
    check_pointer(offset, "offset");
    world->shift_origin(offset);
  });
}

loam_status loam_world_set_gravity(loam_world *world, const float gravity[3]) {
  return guarded(world, [&] {
    check_pointer(world, "world");
    check_pointer(gravity, "gravity");
    world->set_gravity(gravity);
  });
}

loam_status loam_world_set_accuracy(loam_world *world, uint32_t substeps, uint32_t iterations) {
  return guarded(world, [&] {
    check_pointer(world, "world");
    check_range("substeps", substeps, 1, 10000);
    loam_accuracy_def def = default_accuracy();
    def.substeps = substeps;
    def.iterations = iterations;
    world->set_accuracy(def);
  });
}

loam_status loam_world_wake(loam_world *world) {
  return guarded(world, [&] {
    check_pointer(world, "world");
    world->wake();
  });
}

loam_status loam_world_get_backend(const loam_world *world, uint32_t *backend, uint32_t *instruction_set) {
  return guarded(
      world,
      [&] {
        check_pointer(world, "world");
        if (backend != nullptr) *backend = world->backend_kind();
        if (instruction_set != nullptr) *instruction_set = world->instruction_set();
      },
      Meanwhile::allowed);
}

loam_status loam_world_state_hash(const loam_world *world, uint64_t *hash) {
  return guarded(world, [&] {
    check_pointer(world, "world");
    check_pointer(hash, "hash");
    // Hashing runs kernels, but changes nothing that can be seen.
    *hash = const_cast<loam_world *>(world)->state_hash();
  });
}

loam_status loam_world_get_statistics(const loam_world *world, loam_statistics *statistics) {
  return guarded(world, [&] {
    check_pointer(world, "world");
    check_pointer(statistics, "statistics");
    write_definition(statistics, "statistics", statistics->struct_size, world->statistics(),
                     {offsetof(loam_statistics, substeps)}); // before it had what accuracy.h is about
  });
}

namespace {

template <class Row, class Source, class Convert>
void copy_rows(const Source &source, Row *rows, uint32_t capacity, uint32_t *count, const char *name, Convert &&convert) {
  check_pointer(count, "count");
  if (capacity > 0) check_pointer(rows, name);
  *count = static_cast<uint32_t>(source.size());
  for (size_t i = 0; i < std::min<size_t>(capacity, source.size()); ++i) rows[i] = convert(source[i]);
}

template <size_t N> void copy_name(char (&to)[N], const std::string &from) {
  std::memset(to, 0, N);
  std::memcpy(to, from.data(), std::min(N - 1, from.size()));
}

} // namespace

loam_status loam_world_get_stages(const loam_world *world, loam_stage *stages, uint32_t capacity, uint32_t *count) {
  return guarded(world, [&] {
    check_pointer(world, "world");
    copy_rows(world->schedule().stages(), stages, capacity, count, "stages", [](const Stage &stage) {
      loam_stage row = {};
      copy_name(row.name, stage.name);
      row.seconds = stage.seconds;
      row.items = stage.items;
      return row;
    });
  });
}

loam_status loam_world_get_memory(const loam_world *world, loam_memory *rows, uint32_t capacity, uint32_t *count) {
  return guarded(world, [&] {
    check_pointer(world, "world");
    copy_rows(world->backend().memory(), rows, capacity, count, "rows", [](const MemoryUse &use) {
      loam_memory row = {};
      copy_name(row.effect, use.effect);
      row.bytes = use.bytes;
      return row;
    });
  });
}
