// Makes a picture of a frame: particles as lit spheres, solid and glass colliders, decorations, the ground.
#pragma once

#include <atomic>
#include <optional>
#include <vector>

#include "particles.h"
#include "picture/camera.h"
#include "picture/environment.h"
#include "picture/grain_light.h"
#include "picture/ground_light.h"
#include "picture/image.h"
#include "picture/ray_scene.h"
#include "picture/still_layer.h"
#include "scene.h"

namespace runner {

class Renderer {
public:
  // The scene must have a camera, and must outlive the renderer.
  // `start` are the particles before the first step.
  Renderer(const Scene &scene, const Particles &start);

  // `cloths` are those of the scene; `time` in seconds says where moving colliders are.
  Image render(const Particles &particles, const std::vector<Mesh> &cloths, double time);

private:
  struct Sample {
    Vector3 display; // 0 to 1, ready for the screen
    // What decides whether a pixel needs more samples.
    Hit::Kind kind = Hit::nothing;
    std::uint32_t index = 0;
    int panes = 0;
    Vector3 normal;
  };

  void place_cloths(const std::vector<Mesh> &cloths);
  void place_particles(const Particles &particles, double time);
  // A ray through the picture at x, y, which lies in the pixel.
  Sample sample(float x, float y, std::size_t pixel, float noise);
  static bool differ(const Sample &a, const Sample &b);
  Vector3 shade(const Ray &ray, const Hit &hit, std::size_t pixel, float noise, Vector3 background);
  Vector3 shade_particle(const Ray &ray, const Hit &hit, float noise);
  Vector3 shade_solid(const Ray &ray, const Hit &hit, std::size_t pixel, float noise) const;
  Vector3 shade_ground(const Hit &hit, Vector3 background) const;
  Vector3 direct(const FarLight &light, const Hit &hit, Vector3 view, float noise, int rays, float gloss) const;
  Vector3 colour_of(const Hit &hit) const; // of a solid or a particle
  GrainLight grain_light(std::uint32_t index);

  static constexpr std::uint32_t none = 0xffffffffu;

  const Scene *scene_;
  Camera camera_;
  Environment environment_;
  RayScene rays_;
  StillLayer still_;
  std::optional<GroundLight> ground_light_;
  std::vector<std::uint32_t> surfaces_; // of each emitter the solid that stands for its particles, or `none`
  std::vector<std::uint32_t> sheets_;   // of each cloth its solid, or `none`
  std::vector<std::uint8_t> in_band_;   // by particle id: has it the emitter's band colour?
  std::vector<float> radii_;            // of the particles that are shown one by one, as all that follows
  std::vector<Vector3> colours_;
  // Light of the particles that the camera has met so far: threads may gather the same one twice, with the same result.
  enum LightState : std::uint8_t { unknown, being_stored, stored };
  std::vector<std::atomic<std::uint8_t>> grain_light_states_;
  std::vector<GrainLight> grain_lights_;
};

} // namespace runner
