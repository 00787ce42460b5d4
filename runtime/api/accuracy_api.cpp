#include "api/guard.h"

using namespace loam;

loam_status loam_accuracy_def_default(loam_accuracy_def *def, size_t size) {
  return guarded(nullptr, [&] { write_definition(def, "def", size, default_accuracy()); });
}

loam_status loam_accuracy_def_preset(uint32_t preset, loam_accuracy_def *def, size_t size) {
  return guarded(nullptr, [&] { write_definition(def, "def", size, accuracy_preset(preset)); });
}

loam_status loam_world_use_accuracy(loam_world *world, const loam_accuracy_def *def) {
  return guarded(world, [&] {
    check_pointer(world, "world");
    world->set_accuracy(read_definition(def, "def", default_accuracy()));
  });
}

loam_status loam_world_get_accuracy(const loam_world *world, loam_accuracy_def *def, size_t size) {
  return guarded(world, [&] {
    check_pointer(world, "world");
    write_definition(def, "def", size, world->accuracy());
  });
}
