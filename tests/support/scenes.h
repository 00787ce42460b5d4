/* Scenes shared by tests and benchmarks.
 *
 * A Scene is plain data, so that the library (through its public C interface, by World) and the reference solver start from the very same
 * particles. Up is y, the ground is the plane y = 0, particles sit on a cubic lattice of constant `spacing`, moved at random by up to `jitter`
 * spacings along each axis; layers that stand against the ground or a wall, half a spacing off, are not moved along its normal. */
#pragma once

#include <cstdint>
#include <loam/loam.h>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace loam::scenes {

/* ------------------------------------------------------------------------------------------------ descriptions --- */

struct Plane {
  float point[3];
  float normal[3]; // of length 1, away from the solid side
  float friction;
};

struct Scene {
  loam_material_def material;
  float spacing = 0;             // metres; the kernel radius r that belongs to the scene
  std::vector<float> positions;  // x, y, z of each particle
  std::vector<float> velocities; // the same, or empty: at rest
  std::vector<Plane> planes;
  float length = 0;    // what run-outs are measured against: a column's radius, a slab's length
  bool planar = false; // run-outs are distances along x, not from the y axis

  std::size_t count() const { return positions.size() / 3; }
  float volume() const { return spacing * spacing * spacing; } // of a particle
};

/* Lattices and their disorder. The same seed gives the same particles on every machine. */
struct Lattice {
  float spacing = 0.01f;
  float jitter = 0.12f;
  std::uint32_t seed = 1;
};

/* Materials without a call into the library: the definition's fields, all of them set. */
loam_material_def sand(float friction_angle_degrees = 30, float youngs_modulus = 1e6f);
loam_material_def plasticine(float yield_stress = 5e3f, float youngs_modulus = 1e6f);
loam_material_def rubber(float youngs_modulus = 1e5f);

/* A cylinder around the y axis of `radius` spacings, `aspect` times as high, on the ground. */
Scene axisymmetric_column(const loam_material_def &material, int radius, float aspect, float ground_friction = 1,
                          const Lattice &lattice = {});

/* A slab between walls without friction at x = 0, z = 0 and z = `depth` spacings, `length` spacings long, `aspect` times as high; it may run out
 * along x only. */
Scene slab(const loam_material_def &material, int length, float aspect, int depth = 5, float ground_friction = 1,
           const Lattice &lattice = {});

/* A cube of `edge` spacings whose lowest layer starts `height` metres above where it would rest, falling at `speed` m/s. */
Scene drop_block(const loam_material_def &material, int edge, float height, float speed = 0, const Lattice &lattice = {});

/* Exactly `count` particles in a block on the ground, about as high as wide, sheared along x at `shear_rate` per second: with gravity it
 * collapses, and every particle of a plastic material yields from the first steps on. */
Scene jittered_block(const loam_material_def &material, std::size_t count, float shear_rate = 2,
                     const Lattice &lattice = {});

/* A cone of `radius` spacings at the foot and `slope_degrees`, on ground of friction 1: under the angle of repose it stays. */
Scene resting_pile(const loam_material_def &material, int radius, float slope_degrees = 20, const Lattice &lattice = {});

/* ------------------------------------------------------------------------------------------ through the library --- */

/* "LOAM_OK", or the status' name with the library's text: EXPECT_EQ(outcome(loam_world_step(...)), "LOAM_OK"). */
std::string outcome(loam_status status);

/* The library's default world for a scene: its spacing as the kernel radius, room for its particles, the CPU, one thread. */
loam_world_def world_def(const Scene &scene);

/* One material of each law, and of each branch of a law, so weak that all but rubber yield everywhere in a jittered_block. */
std::vector<loam_material_def> each_law();

/* A copy of the particles in the order of their ids, x, y, z (and xx, yy, zz, xy, xz, yz of b - I) one after the other. */
struct Snapshot {
  std::vector<float> positions, velocities, volumes, inverse_masses, strains;
  std::size_t count() const { return volumes.size(); }
};

/* A world with a scene in it. Calls throw std::runtime_error with the library's text when they fail; a test of failures takes `get()` and
 * the C functions. Movable, not copyable. */
class World {
public:
  explicit World(const loam_world_def &def);
  World(const loam_world_def &def, const Scene &scene) : World(def) { add(scene); }
  World(World &&other) noexcept : world_(std::exchange(other.world_, nullptr)) {}
  World &operator=(World &&other) noexcept {
    std::swap(world_, other.world_);
    return *this;
  }
  ~World();

  loam_world *get() const { return world_; }

  /* Material, planes and particles of a scene; answers with the material. */
  loam_material_id add(const Scene &scene);

  void step(float seconds);
  loam_statistics statistics() const;
  std::vector<loam_stage> stages() const;
  bool has_stage(const std::string &name) const;
  std::uint64_t memory_bytes() const; // all effects together
  std::uint64_t state_hash() const;
  Snapshot snapshot() const;

private:
  loam_world *world_ = nullptr;
};

/* Throws std::runtime_error unless the status is LOAM_OK. */
void require(loam_status status, const char *call);

/* How far `share` of the particles lie within, less the scene's length, over it. Positions as in Snapshot. */
double run_out(const std::vector<float> &positions, const Scene &scene, double share = 0.995);

} // namespace loam::scenes
