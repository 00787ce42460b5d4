// The one virtual interface between the scene and the machine that runs it.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include <loam/loam.h>

#include "kernels/contact/contact_law.h"
#include "kernels/contact/pose.h"
#include "kernels/integration/fields.h"
#include "kernels/integration/killers.h"
#include "kernels/materials/laws.h"
#include "schedule/schedule.h"
#include "solver/cloth_backend.h"
#include "solver/collider_shape.h"
#include "solver/execution_settings.h"
#include "solver/particle_source.h"
#include "solver/state_section.h"

namespace loam {

template <class List> struct VariantOf;
template <class... Types> struct VariantOf<TypeList<Types...>> { using Type = std::variant<Types..., Fluid>; };
// A material is of a law or a fluid.
using LawVariant = VariantOf<Laws>::Type;

// A material as the solver sees it. Its index is that of the particles' material numbers.
struct SolverMaterial {
  LawVariant law;
  std::string name;
  bool in_use;                      // there are particles of it
  std::vector<float> meetings = {}; // by the other's index, see meetings.h; empty: it shares gradients with all
  float density = 0;                // kg/m^3; of matter with a stiffness
};

// What stays for the life of a world.
struct SolverSettings {
  float kernel_radius;
  float gradient_cutoff;
  float minimum_distance;   // share of r; 0: off
  float velocity_smoothing; // 1/s; 0: off
  bool jacobi;
  bool semi_implicit;
  bool projected_tensor;       // the multiplier form: the tensor or the scalar
  float zero_energy_stiffness; // see kernels/inelastic/non_affine.h; the tensor form only
  std::uint64_t particle_capacity;
  std::uint64_t pair_capacity; // 0: grows
  bool keep_free_distances =
      true;                // false is for tests: every particle is asked for contacts in every substep, with the same result
  float sleep_speed = 0;   // m/s; 0: nothing sleeps
  float sleep_delay = 0;   // s
  bool warm_start = false; // see kernels/inelastic/warm_start.h; the tensor form only
};

// The law of contact with one material, by its number.
struct PairLaw {
  std::uint32_t material;
  ContactLaw law;
};

// What particles did to a collider in a step.
struct ColliderReaction {
  double impulse[3], torque[3]; // the latter about the collider's origin
  std::uint64_t contacts;       // in the last substep
};

// A collider during a step: it moves from `start` to `end`.
struct ColliderState {
  int shape; // as add_shape() answered
  ContactLaw law;
  Pose start, end;
  std::span<const PairLaw> pairs = {};  // materials that have another law
  ColliderReaction *reaction = nullptr; // receives it; null: not asked for
};

struct FieldState {
  FieldKind kind;
  Vec3<float> centre, velocity;
  float radius, softening; // m
  double strength;         // wind: 1/s; attractor: m^3/s^2; blast: m/s
  double wait;             // blast: seconds from the step's beginning; under 0: it is over
};

struct KillerState {
  KillerView view;
  std::vector<std::uint32_t> *killed; // receives the ids of the step
};

struct StepInput {
  float seconds;
  std::uint32_t substeps, iterations;
  double tolerance = 0; // of the iterations, see convergence.h; 0: as many as given
  Vec3<float> gravity;
  std::vector<ColliderState> colliders;
  bool wake = false;                // all that sleeps
  float stiffness_share = 1;        // the least of the materials; for the statistics
  ParticleSource *source = nullptr; // where there are emitters
  std::vector<FieldState> fields = {};
  std::vector<KillerState> killers = {};
  std::vector<std::uint64_t> *removed = nullptr; // where there are killers: receives how many of each material went

  Surroundings surroundings() const {
    return {!colliders.empty(), source != nullptr, !fields.empty(), !killers.empty(), tolerance > 0};
  }
};

struct NewParticles {
  std::uint32_t material;
  std::uint32_t first_id;
  float volume, inverse_mass;
  const float *positions;  // 3 each
  const float *velocities; // 3 each, or null
  Vec3<float> velocity;    // where `velocities` is null
  std::uint64_t count;
};

// New positions, velocities or both of particles by their ids.
struct ParticleMotion {
  const std::uint32_t *ids;
  const float *positions, *velocities; // 3 each, or null: they stay
  std::uint64_t count;
};

class Backend {
public:
  virtual ~Backend() = default;
  virtual void set_materials(const std::vector<SolverMaterial> &materials) = 0;
  virtual int add_shape(const ColliderShape &shape) = 0;
  virtual void remove_shape(int shape) = 0;
  // Of a mesh that deforms: where its vertices, 3 floats each, are to be at the end of the next step, or are now.
  virtual void move_vertices(int shape, const float *positions, bool at_once) = 0;
  virtual void add_particles(const NewParticles &particles) = 0;
  // Both throw Error and change nothing for an id that no particle has, or that is named twice. Answers how many of each material went.
  virtual std::vector<std::uint64_t> remove_particles(const std::uint32_t *ids, std::uint64_t count) = 0;
  virtual void release_particles(const Release &release) = 0;
  // Whether particles have ages; they begin at 0. Throws Error OUT_OF_MEMORY.
  virtual void keep_ages(bool keep) = 0;
  virtual void set_motion(const ParticleMotion &motion) = 0;
  virtual std::uint64_t particle_count() const = 0;
  // Throws Error; then the particles stand at the end of the last whole substep, and `statistics.substeps_done` says of which.
  virtual void step(const StepInput &input) = 0;
  virtual void map(loam_particle_view &view) = 0;
  // Copies the particles to buffers that steps leave alone, and gives the view of those.
  virtual void keep(loam_particle_view &view) = 0;
  // Gives them back; false if there are none.
  virtual bool drop() = 0;
  virtual std::uint64_t state_hash() = 0;
  // Takes `by` away from the positions of particles and cloth.
  virtual void shift_origin(const Vec3<float> &by) = 0;
  // What a step starts from, as it would be with so many particles; at most the capacity. Cloths add theirs.
  virtual std::vector<StateSection> state(std::uint64_t particles) = 0;
  virtual void read_state(const StateSection &section, std::uint64_t first, std::size_t count, std::uint32_t *words) = 0;
  virtual void write_state(const StateSection &section, std::uint64_t first, std::size_t count,
                           const std::uint32_t *words) = 0; // whole elements
  // Adds that of a mesh that deforms.
  virtual void list_vertices(int shape, std::uint32_t object, std::vector<StateSection> &list) = 0;
  // After new state was written for so many particles: all that follows from it.
  virtual void adopt_state(std::uint64_t particles) = 0;
  virtual double greatest_speed() = 0; // of particles and cloth
  virtual const loam_statistics &statistics() const = 0;
  // Of what the world contains now.
  virtual const Schedule &schedule(const Surroundings &surroundings) = 0;
  virtual std::vector<MemoryUse> memory() const = 0;
  virtual ClothBackend &cloth() = 0;
};

// `instruction_set` of the settings is one that this machine has.
std::unique_ptr<Backend> make_cpu_backend(const SolverSettings &solver, const ExecutionSettings &execution);

// Throws Error BACKEND_UNAVAILABLE where there is no device. Where the library was built without CUDA it always does.
std::unique_ptr<Backend> make_cuda_backend(const SolverSettings &solver, const ExecutionSettings &execution);
bool cuda_available();

} // namespace loam
