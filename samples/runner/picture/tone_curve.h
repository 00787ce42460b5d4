// From light to display values, as film does it: a soft shoulder for highlights, a slight toe for shadows.
#pragma once

#include <algorithm>
#include <cmath>

#include "vector.h"

namespace runner {

inline float display_value(float light) {
  const float white = 4.5f; // this much light is pure white
  const float x = std::fmax(0.0f, light);
  const float compressed = std::fmin(1.0f, x * (1 + x / (white * white)) / (1 + 0.82f * x) * 0.93f);
  const float contrast = compressed * (0.80f + 0.36f * compressed - 0.16f * compressed * compressed);
  return contrast <= 0.0031308f ? 12.92f * contrast : 1.055f * std::pow(contrast, 1 / 2.4f) - 0.055f; // sRGB
}

inline Vector3 display_colour(Vector3 light) {
  // Very bright colours bleach, as on film.
  const float brightest = std::max({light.x, light.y, light.z});
  const float bleach = std::clamp(0.18f * (brightest - 1), 0.0f, 0.5f);
  const Vector3 toned = mix(light, Vector3{brightest, brightest, brightest}, bleach);
  return {display_value(toned.x), display_value(toned.y), display_value(toned.z)};
}

} // namespace runner
