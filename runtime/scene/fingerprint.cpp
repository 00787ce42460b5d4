#include "scene/fingerprint.h"

#include <algorithm>
#include <cstring>

namespace loam {

std::uint64_t fingerprint(const void *memory, std::uint64_t bytes, std::uint64_t before) {
  const char *at = static_cast<const char *>(memory);
  std::uint64_t sum = before ^ bytes;
  for (std::uint64_t i = 0; i < bytes; i += 8) {
    std::uint64_t word = 0;
    std::memcpy(&word, at + i, std::min<std::uint64_t>(8, bytes - i));
    sum = (sum ^ word) * 0x9E3779B97F4A7C15ull;
    sum ^= sum >> 29;
  }
  return sum;
}

std::uint64_t mesh_fingerprint(const loam_mesh &mesh) {
  if (mesh.positions == nullptr || mesh.indices == nullptr) return 0;
  const std::uint64_t vertices = fingerprint(mesh.positions, std::uint64_t(12) * mesh.vertex_count);
  return fingerprint(mesh.indices, std::uint64_t(12) * mesh.triangle_count, vertices);
}

std::uint64_t grid_fingerprint(const loam_distance_grid &grid) {
  if (grid.values == nullptr) return 0;
  const std::uint64_t count = std::uint64_t(grid.size[0]) * grid.size[1] * grid.size[2];
  std::uint64_t sum = fingerprint(grid.values, 4 * count);
  sum = fingerprint(grid.origin, sizeof grid.origin, sum);
  sum = fingerprint(&grid.spacing, sizeof grid.spacing, sum);
  return fingerprint(grid.size, sizeof grid.size, sum);
}

} // namespace loam
