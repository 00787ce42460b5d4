#include <cstddef>

#include "api/guard.h"

using namespace loam;

namespace {

// The sizes before the kinds beyond MESH, and before meshes that deform.
constexpr std::size_t first_size = offsetof(loam_collider_def, radius), second_size = offsetof(loam_collider_def, deforms);

loam_collider_def default_collider() {
  loam_collider_def def = {};
  def.struct_size = sizeof def;
  def.kind = LOAM_COLLIDER_PLANE;
  def.rotation[3] = 1;
  def.friction = 0.6f;
  return def;
}

} // namespace

loam_status loam_collider_def_default(loam_collider_def *def, size_t size) {
  return guarded(nullptr, [&] { write_definition(def, "def", size, default_collider(), {first_size, second_size}); });
}

loam_status loam_collider_create(loam_world *world, const loam_collider_def *def, loam_collider_id *collider) {
  return guarded(world, [&] {
    check_pointer(world, "world");
    check_pointer(collider, "collider");
    *collider = world->create_collider(read_definition(def, "def", default_collider(), {first_size, second_size}));
  });
}

loam_status loam_collider_destroy(loam_world *world, loam_collider_id collider) {
  return guarded(world, [&] {
    check_pointer(world, "world");
    world->destroy_collider(collider);
  });
}

namespace {

loam_status pose(loam_world *world, loam_collider_id collider, const float position[3], const float rotation[4],
                 bool at_once) {
  return guarded(world, [&] {
    check_pointer(world, "world");
    check_pointer(position, "position");
    check_pointer(rotation, "rotation");
    world->pose_collider(collider, position, rotation, at_once);
  });
}

} // namespace

loam_status loam_collider_move(loam_world *world, loam_collider_id collider, const float position[3],
                               const float rotation[4]) {
  return pose(world, collider, position, rotation, false);
}

loam_status loam_collider_place(loam_world *world, loam_collider_id collider, const float position[3],
                                const float rotation[4]) {
  return pose(world, collider, position, rotation, true);
}

namespace {

loam_status move_vertices(loam_world *world, loam_collider_id collider, const float *positions, uint32_t vertex_count,
                          bool at_once) {
  return guarded(world, [&] {
    check_pointer(world, "world");
    check_pointer(positions, "positions");
    world->move_vertices(collider, positions, vertex_count, at_once);
  });
}

} // namespace

loam_status loam_collider_move_vertices(loam_world *world, loam_collider_id collider, const float *positions,
                                        uint32_t vertex_count) {
  return move_vertices(world, collider, positions, vertex_count, false);
}

loam_status loam_collider_place_vertices(loam_world *world, loam_collider_id collider, const float *positions,
                                         uint32_t vertex_count) {
  return move_vertices(world, collider, positions, vertex_count, true);
}

loam_status loam_collider_set_contact(loam_world *world, loam_collider_id collider, loam_material_id material,
                                      const loam_collider_contact *contact) {
  return guarded(world, [&] {
    check_pointer(world, "world");
    if (contact == nullptr) {
      world->set_contact(collider, material, nullptr);
      return;
    }
    const loam_collider_contact copy = read_definition(contact, "contact", loam_collider_contact{});
    world->set_contact(collider, material, &copy);
  });
}

loam_status loam_collider_get_contact(const loam_world *world, loam_collider_id collider, loam_material_id material,
                                      loam_collider_contact *contact) {
  return guarded(world, [&] {
    check_pointer(world, "world");
    check_pointer(contact, "contact");
    write_definition(contact, "contact", contact->struct_size, world->contact(collider, material));
  });
}

loam_status loam_collider_get_reaction(const loam_world *world, loam_collider_id collider,
                                       loam_collider_reaction *reaction) {
  return guarded(world, [&] {
    check_pointer(world, "world");
    check_pointer(reaction, "reaction");
    write_definition(reaction, "reaction", reaction->struct_size, world->collider_reaction(collider));
  });
}

loam_status loam_collider_get_report(const loam_world *world, loam_collider_id collider, loam_collider_report *report) {
  return guarded(world, [&] {
    check_pointer(world, "world");
    check_pointer(report, "report");
    write_definition(report, "report", report->struct_size, world->collider_report(collider));
  });
}
