/* Snapshots as vectors of bytes. */
#pragma once

#include <cstddef>
#include <vector>

#include "support/scenes.h"

namespace loam::snapshots {

using Bytes = std::vector<std::byte>;

inline Bytes save(const loam_world *world) {
  std::uint64_t size = 0, written = 0;
  scenes::require(loam_snapshot_size(world, &size), "loam_snapshot_size");
  Bytes bytes(size);
  scenes::require(loam_snapshot_save(world, bytes.data(), bytes.size(), &written), "loam_snapshot_save");
  bytes.resize(written);
  return bytes;
}

inline void restore(loam_world *world, const Bytes &bytes) {
  scenes::require(loam_snapshot_restore(world, bytes.data(), bytes.size()), "loam_snapshot_restore");
}

} // namespace loam::snapshots
