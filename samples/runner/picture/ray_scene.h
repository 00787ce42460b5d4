// What rays can meet: solid surfaces, particles, the ground, and glass, which lets them pass.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "mesh.h"
#include "scene.h"
#include "vector.h"

// Embree's own types, so that only ray_scene.cpp needs its headers.
struct RTCDeviceTy;
struct RTCSceneTy;
struct RTCGeometryTy;

namespace runner {

struct Ray {
  Vector3 origin, direction;
  Vector3 at(float distance) const { return origin + distance * direction; }
};

struct Hit {
  enum Kind { nothing, ground, solid, particle } kind = nothing;
  float distance = 1e30f;
  Vector3 position, normal; // the normal faces the ray's origin
  std::uint32_t index = 0;  // of the solid or the particle
};

struct Solid {
  Appearance appearance = Appearance::matte;
  Vector3 colour;
  Vector3 origin; // of its own frame, for textures
};

struct Ground {
  Vector3 point, normal, colour;
};

class RayScene {
public:
  explicit RayScene(const Scene &scene);
  ~RayScene();
  RayScene(const RayScene &) = delete;
  RayScene &operator=(const RayScene &) = delete;

  // Replaces the particles: four floats each, x, y, z and the radius.
  void set_particles(std::vector<float> spheres);

  Hit closest(const Ray &ray) const;
  bool occluded(const Ray &ray) const;
  // The next pane of glass between two distances along a ray: its normal faces the ray's origin.
  std::optional<Hit> glass(const Ray &ray, float from, float to) const;

  const float *sphere(std::uint32_t index) const { return &spheres_[4 * static_cast<std::size_t>(index)]; }
  const std::vector<Solid> &solids() const { return solids_; }
  const std::optional<Ground> &ground() const { return ground_; }
  bool has_glass() const { return has_glass_; }
  Vector3 low() const { return low_; }
  Vector3 high() const { return high_; }
  // By how much a ray's origin is lifted off the surface that it leaves.
  float lift() const { return lift_; }

private:
  void add_mesh(RTCSceneTy *to, const Mesh &mesh, Vector3 position, const std::array<float, 4> &rotation);

  RTCDeviceTy *device_ = nullptr;
  RTCSceneTy *opaque_ = nullptr;
  RTCSceneTy *glass_ = nullptr;
  RTCGeometryTy *spheres_geometry_ = nullptr;
  std::uint32_t spheres_id_ = 0xffffffffu; // until there are particles: no geometry's id
  std::vector<float> spheres_;
  std::vector<Solid> solids_; // by Embree geometry id
  std::optional<Ground> ground_;
  bool has_glass_ = false;
  bool bounds_known_ = false;
  Vector3 low_ = {1e30f, 1e30f, 1e30f}, high_ = {-1e30f, -1e30f, -1e30f};
  float lift_ = 1e-5f;
};

} // namespace runner
