#include "api/guard.h"

using namespace loam;

loam_status loam_snapshot_size(const loam_world *world, uint64_t *bytes) {
  return guarded(world, [&] {
    check_pointer(world, "world");
    check_pointer(bytes, "bytes");
    // Reading the state may launch copies on a device, but changes nothing that can be seen; likewise below.
    *bytes = const_cast<loam_world *>(world)->snapshot_size();
  });
}

loam_status loam_snapshot_save(const loam_world *world, void *memory, uint64_t capacity, uint64_t *bytes) {
  return guarded(world, [&] {
    check_pointer(world, "world");
    check_pointer(memory, "memory");
    const uint64_t written = const_cast<loam_world *>(world)->save(static_cast<std::byte *>(memory), capacity);
    if (bytes != nullptr) *bytes = written;
  });
}

loam_status loam_snapshot_restore(loam_world *world, const void *memory, uint64_t bytes) {
  return guarded(world, [&] {
    check_pointer(world, "world");
    check_pointer(memory, "memory");
    world->restore(static_cast<const std::byte *>(memory), bytes);
  });
}
