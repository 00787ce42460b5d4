/* The session behind run_session: what it knows of its world, and the calls that it makes. */
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include "random_definitions.h"
#include "session.h"
#include "support/hooks.h"

namespace loam::fuzz {

/* What a call's status may be. */
enum class Expect {
  success,
  failure,      // any error
  invalid,      // INVALID_ARGUMENT
  stale,        // INVALID_HANDLE
  in_use,       // IN_USE
  room_or_none, // success or CAPACITY
  anything      // success or any error
};

struct Collider {
  loam_collider_id id;
  float position[3], rotation[4];               // where it is
  float target_position[3], target_rotation[4]; // where it will be after the next step
  std::vector<float> vertices, target_vertices; // the same of its vertices, if it deforms
};

struct Material {
  loam_material_id id;
  std::uint64_t particles;
};

struct Cloth {
  loam_cloth_id id;
  std::vector<loam_collider_id> held; // by vertex: 0 is free, `by_space` or the collider that it is attached to
  static constexpr loam_collider_id by_space = ~loam_collider_id(0);
};

struct Emitter {
  loam_emitter_id id;
  std::uint64_t entered;
  bool tells;
  double speed; // at most, as it comes out
};

struct Killer {
  loam_killer_id id;
  std::uint64_t total;
};

/* Of each particle that ever was, by id. */
struct Particle {
  bool here, streamed; // the latter came from a nozzle, which leads it for a while
  float inverse_mass;  // negative: not seen yet
  std::uint32_t material;
  float position[3]; // as last seen
};

/* What the session knows of a world's state: all that a snapshot takes back. */
struct Known {
  std::uint32_t substeps = 1;
  std::uint64_t count = 0;
  std::vector<Particle> particles;
  std::vector<Material> materials;
  std::vector<Collider> colliders;
  std::vector<Cloth> cloths;
  double cloth_speed = 0; // the greatest that was seen of any
  std::vector<Emitter> emitters;
  std::vector<loam_field_id> fields;
  std::vector<Killer> killers;
};

/* A snapshot with what was known then. */
struct Saved {
  std::vector<unsigned char> bytes;
  std::uint64_t hash = 0, description = 0;
  Known known;
};

class Session {
public:
  explicit Session(const SessionOptions &options) : options_(options) {}
  ~Session() { loam_world_destroy(world_); }
  SessionReport run();

private:
  using Action = void (Session::*)(Random &);

  void act(Random &random);
  void create_world(Random &random);
  void destroy_world();
  void step(Random &random);
  void change_settings(Random &random);
  void create_material(Random &random);
  void change_material(Random &random);
  void change_meeting(Random &random);
  void destroy_material(Random &random);
  void create_collider(Random &random);
  void destroy_collider(Random &random);
  void pose_collider(Random &random);
  void deform_collider(Random &random);
  void fill(Random &random);
  void add(Random &random);
  void map(Random &random);
  void unmap();
  void ask(Random &random);
  void change_contact(Random &random);
  void remove(Random &random);
  void move(Random &random);
  void keep(Random &random);
  void shift_origin(Random &random);
  void wake(Random &random);
  void save(Random &random);
  void restore(Random &random);
  void roll_back(Random &random);
  void bad_bulk(Random &random);
  void create_cloth(Random &random);
  void destroy_cloth(Random &random);
  void attach(Random &random);
  void release(Random &random);
  void blow(Random &random);
  void bad_cloth(Random &random);
  void change_emitters(Random &random);
  void change_fields(Random &random);
  void change_killers(Random &random);
  void bad_number_or_choice(Random &random);
  void bad_handle(Random &random);
  void bad_pointer(Random &random);

  /* Makes a call, unless this run leaves it out, and judges what came of it. True if it succeeded. */
  template <class Call> bool call(const char *name, Expect expect, Call &&call);
  void judge(const char *name, Expect expect, loam_status status);
  void find(const char *text, ...) __attribute__((format(printf, 2, 3)));
  void step_for(float seconds, bool in_the_background);
  void check_after_step(float seconds, double collider_speed);
  void look();
  double look_at_cloth(const Cloth &cloth); // answers with its greatest speed
  void check_view(const loam_particle_view &view);
  bool save_to(std::vector<unsigned char> &bytes);
  std::vector<std::uint32_t> some_ids(Random &random) const;
  void born(std::uint64_t count, bool streamed);
  bool a_stream_tells() const;
  void count_effects();
  void check_memory(bool world_is_gone);
  double greatest_distance(const float from[3]) const;
  double greatest_collider_speed(float seconds) const;

  std::uint64_t hash() const {
    std::uint64_t hash = 0;
    if (world_ != nullptr) (void)loam_world_state_hash(world_, &hash);
    return hash;
  }
  bool leaves_out() const { return options_.leave_out != nullptr && (*options_.leave_out)[report_.refused.size() - 1]; }
  loam_material_id any_material(Random &random) const { return now_.materials[random.below(now_.materials.size())].id; }
  template <class List> static auto &any(List &list, Random &random) { return list[random.below(list.size())]; }

  SessionOptions options_;
  SessionReport report_;
  loam_world *world_ = nullptr;
  loam_world_def def_{};
  hooks::Allocator allocator_;
  hooks::ThreadJobs thread_jobs_;
  hooks::LateJobs late_jobs_;
  hooks::Log log_;
  bool refuses_ = false, memory_refused_ = false;
  bool mapped_ = false;
  loam_status status_ = LOAM_OK;  // of the last call that was judged
  std::uint64_t description_ = 0; // another number after each change of what a snapshot asks to be the same
  Known now_;
  Saved saved_;
  const float *kept_ = nullptr; // positions of the kept frame
  std::vector<float> kept_positions_;
  std::vector<std::uint64_t> stale_;
};

template <class Call> bool Session::call(const char *name, Expect expect, Call &&call) {
  if (leaves_out()) return false;
  const std::uint64_t before = hash();
  const std::uint64_t refusals = allocator_.refusals;
  const loam_status status = call();
  const bool is_step = std::strcmp(name, "step") == 0;
  memory_refused_ = allocator_.refusals > refusals;
  judge(name, expect, status);
  ++report_.calls;
  if (options_.verbose)
    std::printf("  %zu %s: %s %s\n", report_.refused.size(), name, loam_status_name(status), loam_last_error());
  if (status == LOAM_OK) return true;
  ++report_.failures;
  const bool went_on = is_step && (status == LOAM_ERROR_CAPACITY || status == LOAM_ERROR_OUT_OF_MEMORY);
  if (went_on) {
    if (memory_refused_) report_.repeatable = false;
  } else {
    if (hash() != before) find("%s failed and changed the state", name);
    report_.refused.back() = true;
  }
  return false;
}

} // namespace loam::fuzz
