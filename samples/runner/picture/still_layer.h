// What does not move from picture to picture, gathered once: the panes of glass before each pixel, and the sky's light on the solid
// surfaces that are seen there. Particles are left out, so that a picture does not depend on which were made before it.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "picture/camera.h"
#include "picture/environment.h"
#include "picture/ray_scene.h"

namespace runner {

// One crossing of a glass surface along a ray.
struct Pane {
  float distance = 0;
  Vector3 mirrored; // light that it throws towards the camera
  Vector3 passing;  // share of the light behind it that comes through
};

struct Panes {
  std::array<Pane, 8> panes;
  std::size_t count = 0;
};

// All glass along a ray up to a distance.
Panes find_panes(const RayScene &scene, const Environment &environment, const Ray &ray, float to);

struct SkyLight {
  Vector3 irradiance;
  float open = 0; // the share of the hemisphere in which the sky is seen
};

// Sky light at a point, with so many rays.
SkyLight gather_sky_light(const RayScene &scene, const Environment &environment, Vector3 position, Vector3 normal, int rays,
                          float turn);

class StillLayer {
public:
  // The scene must hold no particles yet.
  StillLayer(const RayScene &scene, const Environment &environment, const Camera &camera);

  std::span<const Pane> panes(std::size_t pixel) const {
    return {panes_.data() + first_pane_[pixel], first_pane_[pixel + 1] - first_pane_[pixel]};
  }
  // True if the pixels around have as many panes: then the pixel's panes serve all of its samples.
  bool evenly_glazed(std::size_t pixel) const { return evenly_glazed_[pixel] != 0; }
  // The light for a solid hit at the pixel; null if the pixel's own ray met another surface there.
  const SkyLight *sky_light(std::size_t pixel, const Hit &hit) const;

private:
  struct Surface {
    std::uint32_t solid = none;
    Vector3 normal;
    SkyLight light;
  };
  static constexpr std::uint32_t none = 0xffffffffu;

  std::vector<std::size_t> first_pane_;
  std::vector<Pane> panes_;
  std::vector<std::uint8_t> evenly_glazed_;
  std::vector<Surface> surfaces_;
};

} // namespace runner
