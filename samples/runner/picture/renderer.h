// Makes a picture of a frame: particles as lit spheres, solid and glass colliders, decorations, the ground.
#pragma once

#include <atomic>
#include <optional>
#include <vector>

#include "particles.h"
#include "picture/environment.h"
#include "picture/grain_light.h"
#include "picture/ground_light.h"
#include "picture/image.h"
#include "picture/ray_scene.h"
#include "scene.h"

namespace runner {

class Renderer {
public:
  // The scene must have a camera, and must outlive the renderer.
  explicit Renderer(const Scene &scene);

  Image render(const Particles &particles);

private:
  struct Sample {
    Vector3 display; // 0 to 1, ready for the screen
    // What decides whether a pixel needs more samples.
    Hit::Kind kind = Hit::nothing;
    std::uint32_t index = 0;
    int panes = 0;
    Vector3 normal;
  };

  void place_particles(const Particles &particles);
  Ray camera_ray(float x, float y) const;
  Sample sample(float x, float y, float noise);
  static bool differ(const Sample &a, const Sample &b);
  Vector3 shade(const Ray &ray, const Hit &hit, float noise, Vector3 background);
  Vector3 shade_particle(const Ray &ray, const Hit &hit, float noise);
  Vector3 shade_solid(const Ray &ray, const Hit &hit, float noise) const;
  Vector3 direct(const FarLight &light, const Hit &hit, Vector3 view, float noise, int rays, float gloss) const;
  GrainLight grain_light(std::uint32_t index);

  const Scene *scene_;
  SceneCamera camera_;
  Vector3 right_, up_, forward_;
  Environment environment_;
  RayScene rays_;
  std::optional<GroundLight> ground_light_;
  const Particles *particles_ = nullptr;
  std::vector<float> radii_;
  std::vector<Vector3> colours_;
  // Light of the particles that the camera has met so far: threads may gather the same one twice, with the same result.
  enum LightState : std::uint8_t { unknown, being_stored, stored };
  std::vector<std::atomic<std::uint8_t>> grain_light_states_;
  std::vector<GrainLight> grain_lights_;
};

} // namespace runner
