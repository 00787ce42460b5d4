// Fixed sample patterns: the same picture every time, without visible noise.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "vector.h"

namespace runner {

inline float fraction(float a) { return a - std::floor(a); }

// A well mixed 32-bit hash of an integer (the finaliser of a multiply-xorshift generator).
inline std::uint32_t hash(std::uint32_t a) {
  a ^= a >> 16;
  a *= 0x7feb352du;
  a ^= a >> 15;
  a *= 0x846ca68bu;
  return a ^ (a >> 16);
}
// In [0, 1).
inline float hash_unit(std::uint32_t a) { return static_cast<float>(hash(a) >> 8) * (1.0f / 16777216.0f); }

// A value in [0, 1) for a pixel that differs strongly between neighbours, so that errors look like fine grain (interleaved
// gradient noise, Jimenez 2014).
inline float pixel_noise(int x, int y) {
  return fraction(52.9829189f * fraction(0.06711056f * static_cast<float>(x) + 0.00583715f * static_cast<float>(y)));
}

// Point i of n of a Fibonacci spiral over the unit sphere.
inline Vector3 sphere_direction(int i, int n) {
  const float golden = std::numbers::phi_v<float>;
  const float y = 1 - (2 * static_cast<float>(i) + 1) / static_cast<float>(n);
  const float ring = std::sqrt(std::fmax(0.0f, 1 - y * y));
  const float turn = 2 * std::numbers::pi_v<float> * fraction(static_cast<float>(i) * (golden - 1));
  return {ring * std::cos(turn), y, ring * std::sin(turn)};
}

// Point i of n of a spiral over the unit disc, turned by `turn` of a full circle.
inline Vector3 disc_point(int i, int n, float turn) {
  const float radius = std::sqrt((static_cast<float>(i) + 0.5f) / static_cast<float>(n));
  const float angle =
      2 * std::numbers::pi_v<float> * fraction(static_cast<float>(i) * (std::numbers::phi_v<float> - 1) + turn);
  return {radius * std::cos(angle), radius * std::sin(angle), 0};
}

// Direction i of n of the hemisphere over `normal`, as dense as the cosine to it.
inline Vector3 cosine_direction(int i, int n, float turn, Vector3 normal, const Frame &frame) {
  const Vector3 disc = disc_point(i, n, turn);
  const float up = std::sqrt(std::fmax(0.0f, 1 - disc.x * disc.x - disc.y * disc.y));
  return normalized(disc.x * frame.tangent + disc.y * frame.bitangent + up * normal);
}

} // namespace runner
