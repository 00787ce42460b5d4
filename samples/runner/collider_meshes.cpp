#include "collider_meshes.h"

#include <cmath>
#include <cstdint>
#include <numbers>

namespace runner {

Mesh make_box(Vector3 half_extents) {
  Mesh mesh;
  for (int corner = 0; corner < 8; ++corner)
    mesh.vertices.push_back({corner & 1 ? half_extents.x : -half_extents.x, corner & 2 ? half_extents.y : -half_extents.y,
                             corner & 4 ? half_extents.z : -half_extents.z});
  mesh.indices = {0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5, 0, 1, 5, 0, 5, 4,
                  2, 6, 7, 2, 7, 3, 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6};
  return mesh;
}

Mesh make_capsule(float radius, float half_height) {
  constexpr std::uint32_t around = 96, rings_a_cap = 24;
  Mesh mesh;
  mesh.vertices.push_back({0, -half_height - radius, 0});
  const auto add_ring = [&](float angle, float middle) { // the angle above the horizontal
    for (std::uint32_t k = 0; k < around; ++k) {
      const float turn = 2 * std::numbers::pi_v<float> * static_cast<float>(k) / around;
      const float aside = radius * std::cos(angle);
      mesh.vertices.push_back({aside * std::cos(turn), middle + radius * std::sin(angle), aside * std::sin(turn)});
    }
  };
  const auto angle_of = [](std::uint32_t ring) {
    return 0.5f * std::numbers::pi_v<float> * static_cast<float>(ring) / rings_a_cap;
  };
  for (std::uint32_t ring = rings_a_cap - 1; ring > 0; --ring) add_ring(-angle_of(ring), -half_height);
  add_ring(0, -half_height);
  if (half_height > 0) add_ring(0, half_height);
  for (std::uint32_t ring = 1; ring < rings_a_cap; ++ring) add_ring(angle_of(ring), half_height);
  const auto top = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.push_back({0, half_height + radius, 0});

  const std::uint32_t rings = (top - 1) / around;
  for (std::uint32_t k = 0; k < around; ++k) {
    const std::uint32_t next = (k + 1) % around, last = 1 + (rings - 1) * around;
    mesh.indices.insert(mesh.indices.end(), {0, 1 + k, 1 + next, top, last + next, last + k});
    for (std::uint32_t ring = 0; ring + 1 < rings; ++ring) {
      const std::uint32_t a = 1 + ring * around, b = a + around;
      mesh.indices.insert(mesh.indices.end(), {a + k, b + k, b + next, a + k, b + next, a + next});
    }
  }
  return mesh;
}

} // namespace runner
