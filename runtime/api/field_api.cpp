#include "api/guard.h"

using namespace loam;

loam_status loam_field_def_default(loam_field_def *def, size_t size) {
  return guarded(nullptr, [&] { write_definition(def, "def", size, default_field()); });
}

loam_status loam_field_create(loam_world *world, const loam_field_def *def, loam_field_id *field) {
  return guarded(world, [&] {
    check_pointer(world, "world");
    check_pointer(field, "field");
    *field = world->create_field(read_definition(def, "def", default_field()));
  });
}

loam_status loam_field_set(loam_world *world, loam_field_id field, const loam_field_def *def) {
  return guarded(world, [&] {
    check_pointer(world, "world");
    world->set_field(field, read_definition(def, "def", default_field()));
  });
}

loam_status loam_field_destroy(loam_world *world, loam_field_id field) {
  return guarded(world, [&] {
    check_pointer(world, "world");
    world->destroy_field(field);
  });
}
