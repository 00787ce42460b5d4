// From pixels to rays.
#pragma once

#include "picture/ray_scene.h"
#include "scene.h"

namespace runner {

class Camera {
public:
  explicit Camera(const SceneCamera &camera);
  // x and y in pixels from the upper left corner of the picture.
  Ray ray(float x, float y) const;
  int width() const { return width_; }
  int height() const { return height_; }
  Vector3 target() const { return target_; }

private:
  int width_, height_;
  Vector3 eye_, target_, right_, up_, forward_;
  float scale_;
};

} // namespace runner
