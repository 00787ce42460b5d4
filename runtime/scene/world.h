// The world as the host described it: its definition, materials, colliders, and the backend that holds the particles.
#pragma once

#include <memory>

#include <loam/loam.h>

#include "scene/accuracy.h"
#include "scene/cloth.h"
#include "scene/emitter.h"
#include "scene/field.h"
#include "scene/killer.h"
#include "scene/slot_table.h"
#include "scene/step_thread.h"
#include "solver/backend.h"

namespace loam {

class SnapshotReader;
class SnapshotWriter;

// Throws Error INVALID_ARGUMENT naming the field.
void check_world_def(const loam_world_def &def);
loam_world_def default_world();

} // namespace loam

// The opaque type of the public headers.
struct loam_world {
public:
  explicit loam_world(const loam_world_def &def);

  void log(std::int32_t level, const char *text) const;

  void step(float seconds);
  void begin_step(float seconds);
  void wait();
  bool is_stepping() const { return busy_ && step_thread_->is_running(); }
  // Throws BUSY between begin_step() and wait().
  void check_not_stepping() const;
  void shift_origin(const float offset[3]);
  void set_gravity(const float gravity[3]);
  void wake() { input_.wake = true; }
  void set_accuracy(const loam_accuracy_def &def);
  const loam_accuracy_def &accuracy() const { return accuracy_; }
  loam_statistics statistics() const;
  std::uint32_t backend_kind() const { return backend_kind_; }
  std::uint32_t instruction_set() const { return execution_.instruction_set; }
  loam::Backend &backend() { return *backend_; }
  const loam::Backend &backend() const { return *backend_; }
  const loam::Schedule &schedule() const;

  loam_material_id create_material(const loam_material_def &def);
  void set_material(loam_material_id id, const loam_material_def &def);
  void destroy_material(loam_material_id id);
  void set_meeting(loam_material_id a, loam_material_id b, std::uint32_t meeting, float friction);
  const loam_material_def &material(loam_material_id id) const;

  loam_collider_id create_collider(const loam_collider_def &def);
  void destroy_collider(loam_collider_id id);
  void pose_collider(loam_collider_id id, const float position[3], const float rotation[4], bool at_once);
  void move_vertices(loam_collider_id id, const float *positions, std::uint32_t vertex_count, bool at_once);
  void set_contact(loam_collider_id id, loam_material_id material, const loam_collider_contact *contact);
  loam_collider_contact contact(loam_collider_id id, loam_material_id material) const;
  loam_collider_reaction collider_reaction(loam_collider_id id) const;
  loam_collider_report collider_report(loam_collider_id id) const;

  loam::ClothScene &cloths() { return cloths_; }
  void attach_cloth(loam_cloth_id id, const loam_cloth_attachment_def &def);

  loam_emitter_id create_emitter(const loam_emitter_def &def);
  void destroy_emitter(loam_emitter_id id);
  loam_emitter_report emitter_report(loam_emitter_id id) const { return emitters_.at(id).report(); }
  loam_field_id create_field(const loam_field_def &def);
  void set_field(loam_field_id id, const loam_field_def &def);
  void destroy_field(loam_field_id id);
  loam_killer_id create_killer(const loam_killer_def &def);
  void set_killer(loam_killer_id id, const loam_killer_def &def);
  void destroy_killer(loam_killer_id id);
  const loam::KillerScene &killers() const { return killers_; }
  std::uint64_t capacity_needed() const; // that would have left no particle of a stream without room; 0: there was room
  std::uint64_t state_hash() { return emitters_.hash(backend_->state_hash()); }

  std::uint64_t fill(const loam_fill_def &def);
  std::uint32_t add(const loam_particles_def &def);
  void remove_particles(const std::uint32_t *ids, std::uint64_t count);
  void move_particles(const std::uint32_t *ids, std::uint64_t count, const float *positions, const float *velocities);
  void map(loam_particle_view &view);
  void unmap();

  // In world_snapshot.cpp.
  std::uint64_t snapshot_size();
  std::uint64_t save(std::byte *memory, std::uint64_t capacity);
  void restore(const std::byte *memory, std::uint64_t bytes);

private:
  struct Material {
    loam_material_def def;
    std::uint64_t particles = 0;
    int emitters = 0;
    float stiffness_share = 1; // that the present substep can carry
  };
  struct Contact { // between two materials, by their slots, the lower first
    std::size_t a, b;
    float friction;
  };
  struct Collider {
    int shape = -1; // as the backend numbers them
    loam::ContactLaw law{};
    std::vector<loam::PairLaw> pairs; // materials that have another law
    bool asks_reaction = false;
    loam::ColliderReaction reaction{};
    loam::Pose pose{}, target{};
    loam_collider_report report{};
    loam_collider_def def{};          // without mesh and grid
    std::uint64_t mesh = 0, grid = 0; // their fingerprints
    std::uint32_t vertex_count = 0;   // of a mesh that deforms
  };
  struct Moving; // what a snapshot brings of the scene
  Moving moving() const;
  template <class Fields> void exchange(Fields &fields, Moving &moving) const;
  void write(loam::SnapshotWriter &writer);
  void check(const Moving &moving) const;
  void list_vertices(std::vector<loam::StateSection> &state);
  void check_state(const loam::SnapshotReader &snapshot, const std::vector<loam::StateSection> &state,
                   std::uint64_t next_id) const;
  std::uint64_t count_streams();
  void count_killed();
  int killer_material(const loam_killer_def &def) const;
  void check_unmapped() const;
  void check_step(float seconds) const;
  void run_step(float seconds);
  void check_motion(std::uint64_t count, const float *positions, const float *velocities) const;
  void check_named(std::uint64_t count) const;
  void check_room(std::uint64_t count) const; // for so many more particles
  void send_materials();
  void limit_stiffness(); // to what a substep can carry
  loam::StepChoice choose_step(float seconds);
  double load() const; // what a step's cost grows with
  void add_particles(loam_material_id material, const char *argument, loam::NewParticles particles, bool pinned);

  loam_world_def def_;
  loam::ExecutionSettings execution_{};
  std::uint32_t backend_kind_ = LOAM_BACKEND_CPU;
  std::uint16_t tag_;
  loam::SlotTable<Material> materials_;
  std::vector<Contact> contacts_;
  loam::SlotTable<Collider> colliders_;
  loam::ClothScene cloths_;
  std::vector<int> index_of_slot_; // while there is cloth: where each of colliders_ is among those of the step
  std::uint64_t next_id_ = 0;      // of particles; those of removed ones do not come back
  loam::EmitterScene emitters_;
  loam::FieldScene fields_;
  loam::KillerScene killers_;
  std::vector<std::uint64_t> removed_; // by killers in a step, by material
  std::unique_ptr<loam::Backend> backend_;
  loam::StepInput input_{};
  loam_accuracy_def accuracy_ = loam::default_accuracy();
  loam::BudgetControl budget_;
  loam::StepChoice choice_{}; // of the last step
  std::uint64_t dropped_ = 0; // of all streams so far
  bool mapped_ = false;
  bool busy_ = false; // a step was begun and not waited for
  std::unique_ptr<loam::StepThread>
      step_thread_; // since the first asynchronous step; the last member, since it uses the others
};
