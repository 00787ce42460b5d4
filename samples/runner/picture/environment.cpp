#include "picture/environment.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace runner {
namespace {

float smooth_step(float from, float to, float a) {
  const float t = std::clamp((a - from) / (to - from), 0.0f, 1.0f);
  return t * t * (3 - 2 * t);
}

} // namespace

Environment::Environment(const SceneLight &light, Vector3 up) : light_(light), up_(normalized(up)) {
  key_ = {normalized(light.direction), light.colour, 0.11f};
  front_ = key_.direction - dot(key_.direction, up_) * up_;
  front_ = length(front_) > 1e-3f ? normalized(front_) : Frame(up_).tangent;
  side_ = cross(up_, front_);
  // Opposite to the key light, a little aside and lower.
  const Vector3 rim = normalized(-front_ + 0.55f * side_ + 0.45f * up_);
  const float strength = 0.33f * std::max({light.colour.x, light.colour.y, light.colour.z});
  rim_ = {rim, strength * Vector3{0.72f, 0.88f, 1.0f}, 0.08f};
}

Vector3 Environment::ambient(Vector3 direction) const {
  const float height = dot(direction, up_);
  const float share = std::sqrt(std::clamp(height, 0.0f, 1.0f));
  return mix(light_.horizon, light_.sky, share);
}

Vector3 Environment::mirrored(Vector3 direction) const {
  const float height = dot(direction, up_);
  // Below the horizon lies the table: darker the steeper one looks down on it.
  Vector3 light = height >= 0 ? mix(0.55f * light_.horizon, 0.8f * light_.sky, std::sqrt(height))
                              : mix(0.55f * light_.horizon, light_.background, std::fmin(1.0f, -3 * height));

  // Softboxes: upright rectangles in azimuth, counted from the key light, and elevation.
  const float azimuth = std::atan2(dot(direction, side_), dot(direction, front_));
  const float elevation = std::asin(std::clamp(height, -1.0f, 1.0f));
  const auto softbox = [&](float turn, float half_width, float low, float high) {
    constexpr float edge = 0.05f;
    const float aside = std::fabs(std::remainder(azimuth - turn, 2 * std::numbers::pi_v<float>));
    return smooth_step(half_width + edge, half_width - edge, aside) * smooth_step(low - edge, low + edge, elevation) *
           smooth_step(high + edge, high - edge, elevation);
  };
  light += (4.6f * softbox(0.0f, 0.20f, -0.75f, 0.95f)) * Vector3{1.0f, 0.95f, 0.88f};  // beside the key light
  light += (3.0f * softbox(2.65f, 0.10f, -0.75f, 0.95f)) * Vector3{0.80f, 0.92f, 1.0f}; // the rim strip
  light += (0.7f * softbox(-1.9f, 0.35f, -0.5f, 0.7f)) * Vector3{1.0f, 0.97f, 0.92f};   // a dim wall
  return light;
}

Vector3 Environment::background(float across, float down) const {
  // A spot on the backdrop behind the scene.
  const float x = across - 0.5f, y = down - 0.45f;
  const float glow = std::exp(-(x * x * 5 + y * y * 4));
  return (0.55f + 1.9f * glow) * light_.background;
}

} // namespace runner
