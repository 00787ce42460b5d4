#include "picture/camera.h"

#include <cmath>
#include <numbers>

namespace runner {

Camera::Camera(const SceneCamera &camera)
    : width_(camera.width), height_(camera.height), eye_(camera.eye), target_(camera.target) {
  forward_ = normalized(camera.target - camera.eye);
  right_ = normalized(cross(forward_, camera.up));
  up_ = cross(right_, forward_);
  scale_ = 2 * std::tan(camera.vertical_field_of_view * std::numbers::pi_v<float> / 360) / static_cast<float>(height_);
}

Ray Camera::ray(float x, float y) const {
  const float across = (x - 0.5f * static_cast<float>(width_)) * scale_;
  const float up = (0.5f * static_cast<float>(height_) - y) * scale_;
  return {eye_, normalized(forward_ + across * right_ + up * up_)};
}

} // namespace runner
