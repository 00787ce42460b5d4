// A scene as its file describes it: what to simulate, for how long, and how to look at it.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <loam/loam.h>

#include "deformation.h"
#include "distance_field.h"
#include "mesh.h"
#include "motion.h"
#include "vector.h"

namespace runner {

// Where a table or value stands in the scene file, for messages about it that come later.
struct Place {
  std::uint32_t line = 0;
  std::string key;
};

// How matter is shown: its particles one by one, or a surface around those of an emitter.
enum class Look { grains, smooth, glossy };

struct SceneMaterial {
  Place place;
  std::string name;
  loam_material_def def{};
  Vector3 colour = {0.76f, 0.62f, 0.42f}; // linear RGB
  float colour_variation = 0.15f;         // share by which grains differ
  Look look = Look::grains;
};

struct SceneRegion {
  std::uint32_t kind = LOAM_REGION_NONE;
  Vector3 center;
  std::array<float, 4> rotation = {0, 0, 0, 1};
  Vector3 half_extents;
  float radius = 0;
  float half_height = 0;
  std::filesystem::path file; // MESH
};

// What fills a region at the start, or a stream.
struct SceneEmitter {
  Place place;
  std::string material;
  SceneRegion region, cut;
  loam_fill_def def{};                    // without material, region and cut
  std::optional<loam_emitter_def> stream; // without material and mesh
  std::filesystem::path nozzle;           // its mesh
  Vector3 colour;                         // the material's, unless the emitter has its own
  // Grains change colour with their height at the start, every band_height, so that one sees where they went. 0: they do not.
  Vector3 band_colour;
  float band_height = 0;
};

// How a collider or decoration looks. It has no part in the simulation.
enum class Appearance { hidden, glass, matte, wood, metal, glossy, tiles };

// An axle through the collider's origin, on which what matter does to the collider turns it.
struct SceneHinge {
  Vector3 axis = {0, 0, 1}; // unit
  double inertia = 0;       // about the axle, kg m^2
  double damping = 0;       // of the bearing, N m s
};

struct SceneCollider {
  Place place;
  std::string name; // by which cloths are attached to it; empty: none
  std::uint32_t kind = LOAM_COLLIDER_PLANE;
  std::filesystem::path file; // of all but PLANE: the key in Scene::meshes of what it is, or of what is shown for it
  float radius = 0, half_height = 0;
  Vector3 half_extents;
  DistanceField field; // GRID
  Pose pose;           // at the start
  std::vector<Motion> motions;
  std::vector<Deformation> deformations; // MESH only
  std::optional<SceneHinge> hinge;
  bool moves() const { return !motions.empty() || hinge.has_value(); }
  float friction = 0, restitution = 0, stick = 0;
  Appearance appearance = Appearance::matte;
  Vector3 colour = {0.5f, 0.5f, 0.5f};
};

// Vertices of a cloth that are held.
struct SceneAttachment {
  Place place;
  std::vector<std::uint32_t> vertices;
  std::optional<std::size_t> collider; // by its place in the scene; none: space
  float compliance = 0;
  double release = std::numeric_limits<double>::infinity(); // seconds: when they are let go of
};

struct SceneCloth {
  Place place;
  std::filesystem::path file; // the key in Scene::meshes
  loam_cloth_def def{};       // without the mesh
  std::vector<SceneAttachment> attachments;
  Place wind_place;
  Vector3 wind_velocity;
  float drag = 0, lift = 0;
  Appearance appearance = Appearance::matte; // or hidden or glossy
  Vector3 colour = {0.55f, 0.53f, 0.50f};
};

// An upright cylinder with rounded edges that is only looked at.
struct SceneDecoration {
  Vector3 center;
  float radius = 0;
  float half_height = 0;
  float rounding = 0;
  Appearance appearance = Appearance::matte;
  Vector3 colour = {0.5f, 0.5f, 0.5f};
};

// An axis-aligned box in which particles are counted frame by frame.
struct SceneWatch {
  Vector3 low, high;
};

struct SceneCamera {
  Vector3 eye, target;
  Vector3 up = {0, 1, 0};
  float vertical_field_of_view = 35; // degrees
  int width = 960, height = 720;
};

struct SceneLight {
  Vector3 direction = {-0.5f, 0.8f, 0.45f}; // towards the key light
  Vector3 colour = {3.2f, 2.9f, 2.5f};
  Vector3 sky = {0.42f, 0.50f, 0.62f};           // from straight above
  Vector3 horizon = {0.30f, 0.29f, 0.29f};       // from all around
  Vector3 background = {0.055f, 0.062f, 0.072f}; // behind everything, where no ground is seen
  float exposure = 1;
};

struct SceneField {
  Place place;
  loam_field_def def{};
};

struct SceneKiller {
  Place place;
  std::string material; // empty: all
  loam_killer_def def{};
};

// Materials of which any two meet as bodies that stay apart.
struct SceneContact {
  Place place;
  std::vector<std::string> materials; // two or more
  float friction = 0.3f;
};

struct Scene {
  std::filesystem::path path;
  std::string title;
  loam_world_def world{};              // without hooks and particle_capacity
  std::uint64_t particle_capacity = 0; // 0: as many as all emitters make
  Place world_place;
  std::optional<loam_accuracy_def> accuracy; // none: the world's substeps and iterations
  double frame_rate = 60;
  std::uint64_t frames = 120;
  std::vector<SceneMaterial> materials;
  std::vector<SceneContact> contacts; // of pairs that are named twice, the last holds
  std::vector<SceneEmitter> emitters;
  std::vector<SceneCollider> colliders;
  std::vector<SceneCloth> cloths;
  std::vector<SceneField> fields;
  std::vector<SceneKiller> killers;
  std::vector<SceneDecoration> decorations;
  std::optional<SceneWatch> watch;
  std::optional<SceneCamera> camera; // without one there are no pictures
  SceneLight light;
  std::map<std::filesystem::path, Mesh> meshes; // every file that a region, a collider or a cloth names
};

} // namespace runner
