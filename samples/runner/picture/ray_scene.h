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
  float lift =
      0; // by how much a ray's origin is lifted off it; 0: as off everything. Coarse surfaces would else shade themselves
};

struct Ground {
  Vector3 point, normal, colour;
  Appearance appearance = Appearance::matte;
};

class RayScene {
public:
  explicit RayScene(const Scene &scene);
  ~RayScene();
  RayScene(const RayScene &) = delete;
  RayScene &operator=(const RayScene &) = delete;

  // Replaces the particles that are shown one by one, four floats each: x, y, z and the radius. Solids that move are absent until this
  // is called for the first time, and then stand where they are at `time`.
  void set_frame(std::vector<float> spheres, double time);
  // Adds a solid whose shape is given anew for each frame, before set_frame. Returns its index.
  std::uint32_t add_surface(Appearance appearance, Vector3 colour, float lift);
  void set_surface(std::uint32_t solid, const Mesh &mesh);
  // The same of a sheet, which sheet_ahead() finds from then on.
  void set_sheet(std::uint32_t solid, const Mesh &mesh);
  // How far from a point the next sheet is along a direction of length 1, or `limit` if that is less.
  float sheet_ahead(Vector3 from, Vector3 direction, float limit) const;

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
  struct Moving {
    std::uint32_t solid;
    const SceneCollider *collider;
    const Mesh *mesh;
  };

  void add_mesh(RTCSceneTy *to, std::uint32_t id, const Mesh &mesh, const Pose &pose, bool bounding);
  void replace_mesh(std::uint32_t id, const Mesh &mesh, const Pose &pose);

  RTCDeviceTy *device_ = nullptr;
  RTCSceneTy *opaque_ = nullptr;
  RTCSceneTy *glass_ = nullptr;
  RTCSceneTy *sheets_ = nullptr; // those of the opaque ones that are sheets
  RTCGeometryTy *spheres_geometry_ = nullptr;
  std::vector<float> spheres_;
  std::vector<Solid> solids_; // by Embree geometry id
  std::vector<Moving> moving_;
  std::vector<bool> replaced_; // of each solid: does it stand in the scene with the mesh of an earlier frame?
  std::optional<Ground> ground_;
  bool has_glass_ = false;
  bool bounds_known_ = false;
  std::uint32_t panes_ = 0;
  Vector3 low_ = {1e30f, 1e30f, 1e30f}, high_ = {-1e30f, -1e30f, -1e30f};
  float lift_ = 1e-5f;
};

} // namespace runner
