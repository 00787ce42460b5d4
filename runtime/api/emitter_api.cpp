#include "api/guard.h"

using namespace loam;

namespace {

loam_emitter_def default_emitter() {
  loam_emitter_def def = {};
  def.struct_size = sizeof def;
  def.direction[1] = -1;
  def.speed = 1;
  def.jitter = 0.12f;
  def.seed = 1;
  return def;
}

} // namespace

loam_status loam_emitter_def_default(loam_emitter_def *def, size_t size) {
  return guarded(nullptr, [&] { write_definition(def, "def", size, default_emitter()); });
}

loam_status loam_emitter_create(loam_world *world, const loam_emitter_def *def, loam_emitter_id *emitter) {
  return guarded(world, [&] {
    check_pointer(world, "world");
    check_pointer(emitter, "emitter");
    *emitter = world->create_emitter(read_definition(def, "def", default_emitter()));
  });
}

loam_status loam_emitter_destroy(loam_world *world, loam_emitter_id emitter) {
  return guarded(world, [&] {
    check_pointer(world, "world");
    world->destroy_emitter(emitter);
  });
}

loam_status loam_emitter_get_report(const loam_world *world, loam_emitter_id emitter, loam_emitter_report *report) {
  return guarded(world, [&] {
    check_pointer(world, "world");
    check_pointer(report, "report");
    write_definition(report, "report", report->struct_size, world->emitter_report(emitter));
  });
}
