// A scene brought to life in a Loam world, through the public C interface only.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <loam/loam.h>

#include "mesh.h"
#include "particles.h"
#include "scene.h"

namespace runner {

class Simulation {
public:
  // Throws Error with the library's own text and the place in the scene file that it is about.
  // Colliders on hinges get motions as they turn.
  explicit Simulation(Scene &scene);

  // What a frame begins with.
  struct State {
    std::vector<std::byte> world;
    std::vector<double> spins;
    std::uint64_t frame;
  };
  State save() const;
  // Accuracy becomes what it was then.
  void restore(const State &state);
  void use_accuracy(const loam_accuracy_def &accuracy);
  loam_accuracy_def accuracy() const;
  // Frames that took what stability needs, more than their budget.
  std::uint64_t over_budget() const { return over_budget_; }

  // One frame of 1 / frame_rate seconds.
  void step();

  Particles read_particles() const;
  // Each cloth of the scene as it lies now.
  std::vector<Mesh> read_cloths() const;
  loam_statistics statistics() const;
  std::vector<loam_stage> stages() const;
  std::vector<loam_memory> memory() const;
  std::uint64_t state_hash() const;
  std::string backend() const;         // "cpu" or "cuda"
  std::string instruction_set() const; // "avx2" and so on; empty on CUDA
  std::uint64_t particle_count() const { return particle_count_; }

private:
  struct Destroy {
    void operator()(loam_world *world) const { loam_world_destroy(world); }
  };

  // Makes the world with room for so many particles and fills it. Returns false if that was too few.
  bool build(std::uint64_t particle_capacity);
  void make_cloths();
  // Of those whose time has come within a frame that ends at `end`.
  void release_attachments(double end);
  void check(loam_status status, const Place &place) const;

  std::uint32_t emitter_of(std::uint32_t id, std::uint32_t material) const;
  void turn_hinges(double seconds);
  using MoveVertices = decltype(loam_collider_move_vertices);
  // Vertices go, or are placed, where they are at `time`.
  void deform(double time, MoveVertices *move);

  Scene *scene_;
  std::unique_ptr<loam_world, Destroy> world_;
  std::vector<std::uint32_t> material_ids_; // the lower 32 bits, by index in the scene
  std::vector<loam_collider_id> collider_ids_;
  std::vector<loam_cloth_id> cloth_ids_;
  std::vector<std::uint64_t> emitter_ends_; // of each emitter the id after its last particle's; streams have none
  std::vector<double> spins_;               // of the colliders' hinges, radians a second
  std::uint64_t stream_count_ = 0;          // particles that all streams make
  std::uint64_t frame_ = 0, over_budget_ = 0;
  std::uint64_t particle_count_ = 0;
};

} // namespace runner
