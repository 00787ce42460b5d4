#include "api/guard.h"
#include "scene/material.h"

using namespace loam;

loam_status loam_material_def_default(uint32_t law, loam_material_def *def, size_t size) {
  return guarded(nullptr, [&] { write_definition(def, "def", size, default_material(law), earlier_material_sizes); });
}

loam_status loam_material_create(loam_world *world, const loam_material_def *def, loam_material_id *material) {
  return guarded(world, [&] {
    check_pointer(world, "world");
    check_pointer(material, "material");
    *material = world->create_material(read_definition(def, "def", loam_material_def{}, earlier_material_sizes));
  });
}

loam_status loam_material_set(loam_world *world, loam_material_id material, const loam_material_def *def) {
  return guarded(world, [&] {
    check_pointer(world, "world");
    world->set_material(material, read_definition(def, "def", loam_material_def{}, earlier_material_sizes));
  });
}

loam_status loam_material_destroy(loam_world *world, loam_material_id material) {
  return guarded(world, [&] {
    check_pointer(world, "world");
    world->destroy_material(material);
  });
}

loam_status loam_material_get(const loam_world *world, loam_material_id material, loam_material_def *def) {
  return guarded(world, [&] {
    check_pointer(world, "world");
    check_pointer(def, "def");
    write_definition(def, "def", def->struct_size, world->material(material), earlier_material_sizes);
  });
}

loam_status loam_material_set_meeting(loam_world *world, loam_material_id a, loam_material_id b, uint32_t meeting,
                                      float friction) {
  return guarded(world, [&] {
    check_pointer(world, "world");
    world->set_meeting(a, b, meeting, friction);
  });
}
