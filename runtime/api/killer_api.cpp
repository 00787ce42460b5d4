#include "api/guard.h"

using namespace loam;

loam_status loam_killer_def_default(loam_killer_def *def, size_t size) {
  return guarded(nullptr, [&] { write_definition(def, "def", size, default_killer()); });
}

loam_status loam_killer_create(loam_world *world, const loam_killer_def *def, loam_killer_id *killer) {
  return guarded(world, [&] {
    check_pointer(world, "world");
    check_pointer(killer, "killer");
    *killer = world->create_killer(read_definition(def, "def", default_killer()));
  });
}

loam_status loam_killer_set(loam_world *world, loam_killer_id killer, const loam_killer_def *def) {
  return guarded(world, [&] {
    check_pointer(world, "world");
    world->set_killer(killer, read_definition(def, "def", default_killer()));
  });
}

loam_status loam_killer_destroy(loam_world *world, loam_killer_id killer) {
  return guarded(world, [&] {
    check_pointer(world, "world");
    world->destroy_killer(killer);
  });
}

loam_status loam_killer_get_killed(const loam_world *world, loam_killer_id killer, uint64_t *total, uint32_t *ids,
                                   uint64_t capacity, uint64_t *count) {
  return guarded(world, [&] {
    check_pointer(world, "world");
    check_pointer(count, "count");
    if (capacity > 0) check_pointer(ids, "ids");
    const KillerScene::Killer &of = world->killers().at(killer);
    if (total != nullptr) *total = of.total;
    *count = of.killed.size();
    std::copy_n(of.killed.begin(), std::min<uint64_t>(capacity, of.killed.size()), ids);
  });
}
