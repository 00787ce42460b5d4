// Light on the ground around the scene, on a grid: soft shadows without a ray at every pixel.
#pragma once

#include <vector>

#include "picture/environment.h"
#include "picture/ray_scene.h"

namespace runner {

class GroundLight {
public:
  // The ground must exist.
  GroundLight(const RayScene &scene, const Environment &environment);

  Vector3 irradiance(Vector3 position) const;

private:
  Vector3 gather(Vector3 position, float turn) const;
  void smooth();

  static constexpr int cells = 120;
  const RayScene *scene_;
  const Environment *environment_;
  Vector3 center_, along_, across_;
  float half_ = 1;
  std::vector<Vector3> grid_; // (cells + 1)^2 values at the cells' corners
};

// The share of light that reaches a point from far away along `direction` through panes of glass.
float glass_transmittance(const RayScene &scene, const Ray &ray);

// The share of light that a pane throws back, both its faces taken together. `cosine` is that of the angle to its normal.
float glass_reflectance(float cosine);

} // namespace runner
