#include "picture/surface_colour.h"

#include <cmath>

#include "picture/sampling.h"

namespace runner {
namespace {

// Smooth random values of one octave, in [-1, 1].
float value_noise(Vector3 p) {
  const Vector3 cell = {std::floor(p.x), std::floor(p.y), std::floor(p.z)};
  const Vector3 f = p - cell;
  const auto smooth = [](float t) { return t * t * (3 - 2 * t); };
  const auto corner = [&](int i) {
    const auto x = static_cast<std::uint32_t>(static_cast<int>(cell.x) + (i & 1));
    const auto y = static_cast<std::uint32_t>(static_cast<int>(cell.y) + (i >> 1 & 1));
    const auto z = static_cast<std::uint32_t>(static_cast<int>(cell.z) + (i >> 2));
    return 2 * hash_unit(x * 73856093u ^ y * 19349663u ^ z * 83492791u) - 1;
  };
  float values[8];
  for (int i = 0; i < 8; ++i) values[i] = corner(i);
  const float sx = smooth(f.x), sy = smooth(f.y), sz = smooth(f.z);
  for (int i = 0; i < 4; ++i) values[i] = values[2 * i] + sx * (values[2 * i + 1] - values[2 * i]);
  for (int i = 0; i < 2; ++i) values[i] = values[2 * i] + sy * (values[2 * i + 1] - values[2 * i]);
  return values[0] + sz * (values[1] - values[0]);
}

} // namespace

Vector3 grain_colour(Vector3 colour, float variation, std::uint32_t id) {
  const float value = hash_unit(3 * id + 1) * 2 - 1;
  const float warmth = hash_unit(3 * id + 2) * 2 - 1;
  const float kind = hash_unit(3 * id + 3);
  Vector3 result = (1 + variation * value) * colour;
  result = result * Vector3{1 + 0.25f * variation * warmth, 1, 1 - 0.5f * variation * warmth};
  // One grain in twelve is dark, one in twelve pale quartz.
  if (kind < 0.083f) result = (1 - 2.2f * variation) * result;
  if (kind > 0.917f) result = mix(result, Vector3{0.82f, 0.78f, 0.70f}, std::fmin(1.0f, 3 * variation));
  return maximum(result, Vector3{0.01f, 0.01f, 0.01f});
}

Vector3 wood_colour(Vector3 colour, Vector3 point, float size) {
  // Rings about an axis along x that passes well below the piece, made irregular by noise, and fine pores stretched along the grain.
  const Vector3 p = (1 / size) * point;
  const Vector3 stretched = {0.18f * p.x, p.y, p.z};
  const float bend = 0.9f * value_noise(0.35f * stretched) + 0.35f * value_noise(1.1f * stretched);
  const float distance = std::sqrt((p.y + 9) * (p.y + 9) + p.z * p.z) + bend;
  const float ring = fraction(distance);
  const float late = std::pow(ring, 3.0f); // each ring darkens towards its end
  const float pores = value_noise({0.9f * p.x, 9 * p.y, 9 * p.z});
  return (1.06f - 0.30f * late + 0.10f * pores) * colour;
}

Vector3 plank_colour(Vector3 colour, Vector3 point, const Frame &across, float width) {
  const float along = dot(point, across.tangent), aside = dot(point, across.bitangent) / width;
  const float board = std::floor(aside), place = aside - board;
  const auto id = static_cast<std::uint32_t>(static_cast<int>(board) + 4096);
  const float tone = 0.88f + 0.24f * hash_unit(id);
  const float gap = std::fmin(place, 1 - place) < 0.012f ? 0.45f : 1.0f;
  const Vector3 own = {along + 7 * width * hash_unit(id + 77), 0.35f * width * hash_unit(id + 99), (place - 0.5f) * width};
  return (gap * tone) * wood_colour(colour, own, 0.14f * width);
}

Vector3 tile_colour(Vector3 colour, Vector3 point, const Frame &across, float width) {
  const float u = dot(point, across.tangent) / width, v = dot(point, across.bitangent) / width;
  const float nearest = std::fmin(std::fabs(u - std::round(u)), std::fabs(v - std::round(v)));
  const auto id =
      static_cast<std::uint32_t>(static_cast<int>(std::floor(u)) * 73 + static_cast<int>(std::floor(v)) * 179 + 65536);
  return (nearest < 0.01f ? 0.6f : 0.94f + 0.12f * hash_unit(id)) * colour;
}

} // namespace runner
