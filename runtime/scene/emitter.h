// Streaming emitters: what enters when. See include/loam/emitter.h for the contract.
//
// Layer k enters at start + (k + 1/2) d / speed, d the spacing, and stands where it got to since then at the end of the substep. It is pinned, so that it moves at
// the stream's speed and nothing else, until the next one enters: the distance between layers is exact, whatever the stream runs into. Each place has
// a phase of its own along the flow, the same in every layer, so that layers are not seen as such.
#pragma once

#include <vector>

#include <loam/emitter.h>

#include "scene/nozzle.h"
#include "scene/slot_table.h"
#include "solver/particle_source.h"

namespace loam {

// All that changes while a world steps, and all that a snapshot needs.
struct EmitterState {
  Vec3<double> position{};                      // of the nozzle, m
  double clock = 0;                             // seconds since the emitter was made
  std::uint64_t next_layer = 0;                 // that has not entered
  std::uint32_t held_first = 0, held_count = 0; // ids that the nozzle leads
  std::uint64_t entered = 0, dropped = 0;       // particles
};

class Emitter {
public:
  // Throws Error naming the field. `density` is that of the material.
  Emitter(const loam_emitter_def &def, float kernel_radius, float density, std::uint64_t capacity);
  Emitter() = default;

  void advance(double seconds, std::uint64_t &next_id, ParticleSink &sink);
  void let_go(ParticleSink &sink); // of the layer that the nozzle leads
  void shift_origin(const Vec3<float> &by);
  loam_emitter_report report() const;
  std::uint64_t hash(std::uint64_t hash) const;

  std::uint64_t material() const { return def_.material; }
  const loam_emitter_def &def() const { return def_; } // without the mesh
  std::uint64_t mesh() const { return mesh_; }         // its fingerprint
  const EmitterState &state() const { return state_; }
  // Throws Error INVALID_ARGUMENT if no stream could have come to it, with ids given out up to `next_id`.
  void check_state(const EmitterState &state, std::uint64_t next_id) const;
  void set_state(const EmitterState &state) {
    state_ = state;
    counted = state.entered;
    told = state.dropped;
  }
  std::uint64_t counted = 0, told = 0; // of those that entered and were dropped: in the world's books

private:
  bool past_stop(double time) const {
    const double stop = static_cast<double>(def_.stop);
    return stop > 0 && time >= stop;
  }
  double entry(std::uint64_t layer) const {
    return static_cast<double>(def_.start) + (static_cast<double>(layer) + 0.5) * spacing_ / static_cast<double>(def_.speed);
  }
  void enter(std::uint64_t layer, std::uint64_t &next_id, ParticleSink &sink);

  loam_emitter_def def_{};
  std::uint64_t mesh_ = 0;
  EmitterState state_;
  Nozzle nozzle_;
  double spacing_ = 0, per_layer_ = 0, volume_ = 0; // m; particles; m^3 of one
  float inverse_mass_ = 0;
  std::vector<double> phases_; // of the places, in spacings along the flow
  std::vector<std::uint32_t> choice_, ids_;
  std::vector<Row> positions_, velocities_;
};

// The emitters of a world.
class EmitterScene final : public ParticleSource {
public:
  EmitterScene(std::uint16_t world_tag, std::uint64_t &next_id)
      : table_(IdKind::emitter, "emitter", world_tag, 1024), next_id_(next_id) {}
  loam_emitter_id add(Emitter emitter);
  void remove(loam_emitter_id id) {
    table_.remove(id, "emitter");
    count_in_use();
  }
  Emitter &at(loam_emitter_id id) { return table_.at(id, "emitter"); }
  const Emitter &at(loam_emitter_id id) const { return table_.at(id, "emitter"); }
  bool any() const { return in_use_ > 0; }
  std::size_t slot_count() const { return table_.size(); }
  const Emitter *at_slot(std::size_t slot) const { return table_.at_index(slot); }
  Emitter *at_slot(std::size_t slot) { return table_.at_index(slot); }
  template <class F> void for_each(F &&f) {
    for (std::size_t i = 0; i < table_.size(); ++i)
      if (Emitter *e = table_.at_index(i); e != nullptr) f(*e);
  }
  std::uint64_t hash(std::uint64_t hash) const;

  void advance(double seconds, ParticleSink &sink) override;

private:
  void count_in_use();

  SlotTable<Emitter> table_;
  std::uint64_t &next_id_;
  int in_use_ = 0;
};

} // namespace loam
