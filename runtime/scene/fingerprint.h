// Fingerprints of what a host described, to tell whether two worlds were described alike.
#pragma once

#include <cstdint>

#include <loam/collider.h>

namespace loam {

std::uint64_t fingerprint(const void *memory, std::uint64_t bytes, std::uint64_t before = 0);
// 0 for a mesh or grid without data.
std::uint64_t mesh_fingerprint(const loam_mesh &mesh);
std::uint64_t grid_fingerprint(const loam_distance_grid &grid);

} // namespace loam
