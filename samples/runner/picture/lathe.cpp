#include "picture/lathe.h"

#include <cmath>
#include <numbers>
#include <utility>

namespace runner {

Mesh make_rounded_cylinder(float radius, float half_height, float rounding) {
  constexpr std::uint32_t segments = 160;
  constexpr int arc_steps = 6;
  // Rings from the bottom to the top: radius and height. Rings doubled close together keep flat parts flat under smoothed normals.
  std::vector<std::pair<float, float>> rings;
  const float inner = radius - rounding;
  rings.emplace_back(0.98f * inner, -half_height);
  for (int i = 0; i <= arc_steps; ++i) {
    const float turn = 0.5f * std::numbers::pi_v<float> * static_cast<float>(i) / arc_steps;
    rings.emplace_back(inner + rounding * std::sin(turn), -half_height + rounding * (1 - std::cos(turn)));
  }
  const float wall = half_height - rounding;
  rings.emplace_back(radius, -0.98f * wall);
  for (std::size_t i = rings.size(); i-- > 0;) rings.emplace_back(rings[i].first, -rings[i].second);

  Mesh mesh;
  mesh.vertices.push_back({0, -half_height, 0});
  for (const auto &[ring_radius, height] : rings)
    for (std::uint32_t s = 0; s < segments; ++s) {
      const float turn = 2 * std::numbers::pi_v<float> * static_cast<float>(s) / segments;
      mesh.vertices.push_back({ring_radius * std::cos(turn), height, ring_radius * std::sin(turn)});
    }
  mesh.vertices.push_back({0, half_height, 0});

  const auto at = [](std::size_t ring, std::uint32_t s) {
    return static_cast<std::uint32_t>(1 + ring * segments + s % segments);
  };
  const auto last = rings.size() - 1;
  for (std::uint32_t s = 0; s < segments; ++s) {
    mesh.indices.insert(mesh.indices.end(), {0, at(0, s), at(0, s + 1)});
    for (std::size_t ring = 0; ring < last; ++ring) {
      mesh.indices.insert(mesh.indices.end(), {at(ring, s), at(ring + 1, s), at(ring, s + 1)});
      mesh.indices.insert(mesh.indices.end(), {at(ring, s + 1), at(ring + 1, s), at(ring + 1, s + 1)});
    }
    const auto pole = static_cast<std::uint32_t>(mesh.vertices.size() - 1);
    mesh.indices.insert(mesh.indices.end(), {pole, at(last, s + 1), at(last, s)});
  }
  return mesh;
}

} // namespace runner
