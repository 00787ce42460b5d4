#include "api/guard.h"

using namespace loam;

loam_status loam_cloth_def_default(loam_cloth_def *def, size_t size) {
  return guarded(nullptr, [&] { write_definition(def, "def", size, default_cloth()); });
}

loam_status loam_cloth_create(loam_world *world, const loam_cloth_def *def, loam_cloth_id *cloth) {
  return guarded(world, [&] {
    check_pointer(world, "world");
    check_pointer(cloth, "cloth");
    *cloth = world->cloths().create(world->backend().cloth(), read_definition(def, "def", default_cloth()));
  });
}

loam_status loam_cloth_destroy(loam_world *world, loam_cloth_id cloth) {
  return guarded(world, [&] {
    check_pointer(world, "world");
    world->cloths().destroy(world->backend().cloth(), cloth);
  });
}

loam_status loam_cloth_attachment_def_default(loam_cloth_attachment_def *def, size_t size) {
  return guarded(nullptr, [&] { write_definition(def, "def", size, default_attachment()); });
}

loam_status loam_cloth_attach(loam_world *world, loam_cloth_id cloth, const loam_cloth_attachment_def *def) {
  return guarded(world, [&] {
    check_pointer(world, "world");
    world->attach_cloth(cloth, read_definition(def, "def", default_attachment()));
  });
}

loam_status loam_cloth_release(loam_world *world, loam_cloth_id cloth, const uint32_t *vertices, uint32_t count) {
  return guarded(world, [&] {
    check_pointer(world, "world");
    world->cloths().release(world->backend().cloth(), cloth, vertices, count);
  });
}

loam_status loam_cloth_set_wind(loam_world *world, loam_cloth_id cloth, const float velocity[3], float drag, float lift) {
  return guarded(world, [&] {
    check_pointer(world, "world");
    check_pointer(velocity, "velocity");
    world->cloths().set_wind(world->backend().cloth(), cloth, velocity, drag, lift);
  });
}

loam_status loam_cloth_map(loam_world *world, loam_cloth_id cloth, loam_cloth_view *view) {
  return guarded(world, [&] {
    check_pointer(world, "world");
    check_pointer(view, "view");
    loam_cloth_view values = {};
    const uint32_t size = view->struct_size;
    // checked before mapping, so that a failure leaves nothing mapped
    loam_cloth_view probe = {};
    write_definition(&probe, "view", size, values);
    world->cloths().map(world->backend().cloth(), cloth, values);
    write_definition(view, "view", size, values);
  });
}

loam_status loam_cloth_unmap(loam_world *world, loam_cloth_id cloth) {
  return guarded(world, [&] {
    check_pointer(world, "world");
    world->cloths().unmap(cloth);
  });
}
