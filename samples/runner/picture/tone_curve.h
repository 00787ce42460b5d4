// From light to display values, as film does it: a soft shoulder for highlights, a slight toe for shadows.
#pragma once

#include <algorithm>
#include <cmath>

#include "vector.h"

namespace runner {

inline float display_value(float light) {
  const float white = 4.0f; // this much light is pure white
  const float x = std::fmax(0.0f, light);
  const float shoulder =
      std::fmin(1.0f, x * (1 + x / (white * white)) / (1 + x) * (1 + white) / (white + 1 + 1 / white) * 1.05f);
  const float toe = shoulder * (0.62f + 0.76f * shoulder - 0.38f * shoulder * shoulder);
  return toe <= 0.0031308f ? 12.92f * toe : 1.055f * std::pow(toe, 1 / 2.4f) - 0.055f; // sRGB
}

inline Vector3 display_colour(Vector3 light) {
  // Very bright colours bleach, as on film.
  const float brightest = std::max({light.x, light.y, light.z});
  const float bleach = std::clamp(0.18f * (brightest - 1), 0.0f, 0.5f);
  const Vector3 toned = mix(light, Vector3{brightest, brightest, brightest}, bleach);
  return {display_value(toned.x), display_value(toned.y), display_value(toned.z)};
}

} // namespace runner
