#include "session.h"

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <map>

#include "random_definitions.h"
#include "support/hooks.h"

namespace loam::fuzz {
namespace {

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
};

struct Material {
  loam_material_id id;
  std::uint64_t particles;
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
  void fill(Random &random);
  void add(Random &random);
  void map(Random &random);
  void unmap();
  void ask(Random &random);
  void bad_number_or_choice(Random &random);
  void bad_handle(Random &random);
  void bad_pointer(Random &random);

  /* Makes a call, unless this run leaves it out, and judges what came of it. True if it succeeded. */
  template <class Call> bool call(const char *name, Expect expect, Call &&call);
  void judge(const char *name, Expect expect, loam_status status);
  void find(const char *text, ...) __attribute__((format(printf, 2, 3)));
  void check_after_step(float seconds, double collider_speed);
  void look();
  void check_view(const loam_particle_view &view);
  void check_memory(bool world_is_gone);
  double greatest_distance(const float from[3]) const;
  double greatest_collider_speed(float seconds) const;

  std::uint64_t hash() const {
    std::uint64_t hash = 0;
    if (world_ != nullptr) (void)loam_world_state_hash(world_, &hash);
    return hash;
  }
  bool leaves_out() const { return options_.leave_out != nullptr && (*options_.leave_out)[report_.refused.size() - 1]; }
  loam_material_id any_material(Random &random) const { return materials_[random.below(materials_.size())].id; }

  SessionOptions options_;
  SessionReport report_;
  loam_world *world_ = nullptr;
  loam_world_def def_{};
  std::uint32_t substeps_ = 1;
  hooks::Allocator allocator_;
  hooks::ThreadJobs thread_jobs_;
  hooks::LateJobs late_jobs_;
  hooks::Log log_;
  bool refuses_ = false, memory_refused_ = false;
  bool mapped_ = false;
  std::uint64_t count_ = 0;
  std::vector<Material> materials_;
  std::vector<Collider> colliders_;
  std::vector<std::uint64_t> stale_;
  std::vector<float> positions_;                  // as last seen
  std::vector<float> inverse_masses_;             // by id; negative: not seen yet
  std::vector<std::uint32_t> particle_materials_; // by id
};

void Session::find(const char *text, ...) {
  char line[512];
  va_list arguments;
  va_start(arguments, text);
  std::vsnprintf(line, sizeof line, text, arguments);
  va_end(arguments);
  report_.findings.push_back("call " + std::to_string(report_.refused.size()) + ": " + line);
}

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

void Session::judge(const char *name, Expect expect, loam_status status) {
  const std::string text = loam_last_error();
  const char *shown = loam_status_name(status);
  if (std::strcmp(shown, "LOAM_ERROR_UNKNOWN") == 0) find("%s returned the unknown status %d", name, status);
  if (status == LOAM_ERROR_INTERNAL || status == LOAM_ERROR_DEVICE) find("%s: %s: %s", name, shown, text.c_str());
  if ((status == LOAM_OK) != text.empty()) find("%s: %s with the text \"%s\"", name, shown, text.c_str());
  if (memory_refused_ && status == LOAM_ERROR_OUT_OF_MEMORY) return;
  if (!memory_refused_ && status == LOAM_ERROR_OUT_OF_MEMORY) find("%s: out of memory: %s", name, text.c_str());
  bool expected = true;
  switch (expect) {
  case Expect::success:
    expected = status == LOAM_OK;
    break;
  case Expect::failure:
    expected = status != LOAM_OK;
    break;
  case Expect::invalid:
    expected = status == LOAM_ERROR_INVALID_ARGUMENT;
    break;
  case Expect::stale:
    expected = status == LOAM_ERROR_INVALID_HANDLE;
    break;
  case Expect::in_use:
    expected = status == LOAM_ERROR_IN_USE;
    break;
  case Expect::room_or_none:
    expected = status == LOAM_OK || status == LOAM_ERROR_CAPACITY;
    break;
  case Expect::anything:
    break;
  }
  if (!expected) find("%s: unexpected %s: %s", name, shown, text.c_str());
}

// ---------------------------------------------------------------------------------------------------------- worlds ---

void Session::create_world(Random &random) {
  def_ = random_world(random);
  def_.thread_count = options_.thread_count;
  def_.instruction_set = options_.instruction_set;
  const bool refuse = random.chance(0.08);
  refuses_ = refuse && options_.leave_out == nullptr; // a repetition leaves out what was refused
  if (refuse || random.chance(0.2)) def_.allocator = allocator_.hooks();
  if (random.chance(0.2)) def_.log = log_.hooks();
  const bool jobs = random.chance(0.1), late = random.chance(0.5);
  if (jobs) def_.job_system = late ? late_jobs_.hooks() : thread_jobs_.hooks();
  if (!call("create world", Expect::success, [&] { return loam_world_create(&def_, &world_); })) return;
  substeps_ = def_.substeps;
}

void Session::destroy_world() {
  if (world_ == nullptr) return;
  for (const Material &material : materials_) stale_.push_back(material.id);
  for (const Collider &collider : colliders_) stale_.push_back(collider.id);
  materials_.clear();
  colliders_.clear();
  positions_.clear();
  inverse_masses_.clear();
  particle_materials_.clear();
  count_ = 0;
  mapped_ = false;
  judge("destroy world", Expect::success, loam_world_destroy(world_));
  world_ = nullptr;
  check_memory(true);
}

void Session::check_memory(bool world_is_gone) {
  for (const std::string &mistake : allocator_.mistakes) find("allocator: %s", mistake.c_str());
  allocator_.mistakes.clear();
  if (world_is_gone && allocator_.blocks_in_use() > 0) find("%zu blocks were not given back", allocator_.blocks_in_use());
  for (const hooks::JobSystem *jobs :
       {static_cast<hooks::JobSystem *>(&thread_jobs_), static_cast<hooks::JobSystem *>(&late_jobs_)})
    if (jobs->enqueued != jobs->finished) find("%d tasks were not finished", int(jobs->enqueued - jobs->finished));
  for (const hooks::Log::Line &line : log_.lines)
    if (line.text.empty() || line.text.back() == '\n') find("log line \"%s\"", line.text.c_str());
  log_.lines.clear();
}

// -------------------------------------------------------------------------------------------------------- stepping ---

void Session::step(Random &random) {
  const float seconds = random.chance(0.05) ? random.log_between(1e-4, 1) : random.log_between(5e-4, 0.03);
  const double speed = greatest_collider_speed(seconds);
  const Expect expect = mapped_ ? Expect::in_use : def_.pair_capacity != 0 ? Expect::room_or_none : Expect::success;
  if (call("step", expect, [&] { return loam_world_step(world_, seconds); })) {
    ++report_.steps;
    report_.particles += count_;
    for (Collider &collider : colliders_) {
      std::copy(collider.target_position, collider.target_position + 3, collider.position);
      std::copy(collider.target_rotation, collider.target_rotation + 4, collider.rotation);
    }
    check_after_step(seconds, speed);
  }
  if (!mapped_ && !leaves_out()) look();
}

double Session::greatest_distance(const float from[3]) const {
  double greatest = 0;
  for (std::size_t i = 0; i + 2 < positions_.size(); i += 3)
    greatest =
        std::max(greatest, std::hypot(double(positions_[i]) - double(from[0]), double(positions_[i + 1]) - double(from[1]),
                                      double(positions_[i + 2]) - double(from[2])));
  return greatest;
}

/* Of any point of a collider that matter may touch during the next step. */
double Session::greatest_collider_speed(float seconds) const {
  const double limit = double(def_.kernel_radius) * substeps_; // how far matter goes in a step, twice at most
  double greatest = 0;
  for (const Collider &collider : colliders_) {
    double moved = 0, cosine = 0, lengths[2] = {0, 0};
    for (int k = 0; k < 3; ++k)
      moved = std::hypot(moved, double(collider.target_position[k]) - double(collider.position[k]));
    for (int k = 0; k < 4; ++k) {
      cosine += double(collider.rotation[k]) * double(collider.target_rotation[k]);
      lengths[0] = std::hypot(lengths[0], double(collider.rotation[k]));
      lengths[1] = std::hypot(lengths[1], double(collider.target_rotation[k]));
    }
    const double angle = 2 * std::acos(std::min(1.0, std::fabs(cosine) / (lengths[0] * lengths[1]))) + 1e-6;
    const double reach = greatest_distance(collider.position) + moved + 2 * limit;
    greatest = std::max(greatest, (moved + angle * reach) / double(seconds));
  }
  return greatest;
}

void Session::check_after_step(float seconds, double collider_speed) {
  loam_statistics now = {};
  now.struct_size = sizeof now;
  judge("statistics", Expect::success, loam_world_get_statistics(world_, &now));
  if (now.particles != count_)
    find("%llu particles instead of %llu", (unsigned long long)now.particles, (unsigned long long)count_);
  if (now.non_finite != 0) find("%llu particles are not finite", (unsigned long long)now.non_finite);
  if (count_ > 0 && now.substeps_done != substeps_) find("%u substeps instead of %u", now.substeps_done, substeps_);
  const double limit = double(def_.kernel_radius) / (double(seconds) / substeps_);
  if (!(now.max_speed <= 2 * limit * 1.001 + 2 * collider_speed))
    find("a particle is at %g m/s; r / substep is %g m/s, colliders go at %g m/s", now.max_speed, limit, collider_speed);
  const struct {
    const char *name;
    double value;
  } figures[] = {{"residual", now.residual},       {"virial", now.virial},          {"kinetic_energy", now.kinetic_energy},
                 {"max_speed", now.max_speed},     {"mean_speed", now.mean_speed},  {"momentum[0]", now.momentum[0]},
                 {"momentum[1]", now.momentum[1]}, {"momentum[2]", now.momentum[2]}};
  for (const auto &figure : figures)
    if (!std::isfinite(figure.value)) find("%s is %g", figure.name, figure.value);
  if (now.kinetic_energy < 0 || now.mean_speed > now.max_speed * (1 + 1e-6))
    find("kinetic energy %g J, mean speed %g of %g m/s", now.kinetic_energy, now.mean_speed, now.max_speed);
}

/* At the particles, as a host would. */
void Session::look() {
  allocator_.refuse(0);
  loam_particle_view view = {};
  view.struct_size = sizeof view;
  const loam_status status = loam_particles_map(world_, &view);
  judge("map to look", Expect::success, status);
  if (status != LOAM_OK) return;
  check_view(view);
  judge("unmap after looking", Expect::success, loam_particles_unmap(world_));
}

void Session::check_view(const loam_particle_view &view) {
  if (view.count != count_ || view.memory != LOAM_MEMORY_HOST) {
    find("%llu particles mapped", (unsigned long long)view.count);
    return;
  }
  inverse_masses_.resize(count_, -1.0f);
  particle_materials_.resize(count_, 0);
  positions_.resize(3 * count_);
  std::vector<bool> seen(count_, false);
  for (std::size_t i = 0; i < count_; ++i) {
    const std::uint32_t id = view.ids[i];
    if (id >= count_ || seen[id]) {
      find("the id %u is unknown or there twice", id);
      return;
    }
    seen[id] = true;
    const float *x = view.positions + 4 * i, *v = view.velocities + 4 * i;
    bool finite = std::isfinite(view.densities[i]);
    for (int k = 0; k < 4; ++k) finite = finite && std::isfinite(x[k]) && std::isfinite(v[k]);
    for (int k = 0; k < 6; ++k) finite = finite && std::isfinite(view.strains[6 * i + std::size_t(k)]);
    if (!finite) find("a value of particle %u is not finite", id);
    if (!(x[3] > 0) || !(v[3] >= 0) || !(view.densities[i] >= 0))
      find("particle %u: volume %g, inverse mass %g, density %g", id, double(x[3]), double(v[3]), double(view.densities[i]));
    if (inverse_masses_[id] < 0) {
      inverse_masses_[id] = v[3];
      particle_materials_[id] = view.materials[i];
    } else if (inverse_masses_[id] != v[3] || particle_materials_[id] != view.materials[i]) {
      find("the mass or material of particle %u has changed", id);
    }
    std::copy(x, x + 3, &positions_[3 * id]);
  }
}

void Session::change_settings(Random &random) {
  if (random.chance(0.5)) {
    float gravity[3];
    for (float &g : gravity) g = random.chance(0.02) ? 1e6f : random.between(-30, 30);
    call("set gravity", Expect::success, [&] { return loam_world_set_gravity(world_, gravity); });
  } else {
    const auto substeps = std::uint32_t(random.log_between(1, 24)), iterations = std::uint32_t(random.log_between(1, 9));
    if (call("set accuracy", Expect::success, [&] { return loam_world_set_accuracy(world_, substeps, iterations); }))
      substeps_ = substeps;
  }
}

// ------------------------------------------------------------------------------------------ materials and colliders ---

void Session::create_material(Random &random) {
  const loam_material_def def = random_material(random);
  loam_material_id id = 0;
  const Expect expect = mapped_ ? Expect::failure : Expect::anything;
  if (!call("create material", expect, [&] { return loam_material_create(world_, &def, &id); })) return;
  materials_.push_back({id, 0});
  loam_material_def back = {};
  back.struct_size = sizeof back;
  judge("get material", Expect::success, loam_material_get(world_, id, &back));
  if (std::memcmp(&back, &def, sizeof def) != 0) find("a material does not come back as it was given");
}

void Session::change_material(Random &random) {
  if (materials_.empty()) return;
  const Material &material = materials_[random.below(materials_.size())];
  loam_material_def before = {};
  before.struct_size = sizeof before;
  judge("get material", Expect::success, loam_material_get(world_, material.id, &before));
  loam_material_def def = random_material(random);
  if (random.chance(0.6)) scale_numbers(def = before, random);
  if (random.chance(0.1)) spoil(def, random);
  const bool keeps = def.law == before.law && def.density == before.density;
  const bool changed = call("change material", mapped_ ? Expect::failure : Expect::anything,
                            [&] { return loam_material_set(world_, material.id, &def); });
  if (changed && material.particles > 0 && !keeps) find("law or density of a material in use were changed");
}

void Session::change_meeting(Random &random) {
  if (materials_.empty()) return;
  const loam_material_id a = any_material(random), b = any_material(random);
  const std::uint32_t meeting = random.chance(0.7) ? LOAM_MEETING_CONTACT : LOAM_MEETING_SHARED;
  const float friction = random.log_between(0.01, 100);
  call("change meeting", a == b || mapped_ ? Expect::failure : Expect::success,
       [&] { return loam_material_set_meeting(world_, a, b, meeting, friction); });
}

void Session::destroy_material(Random &random) {
  if (materials_.empty()) return;
  const std::size_t which = random.below(materials_.size());
  const Material material = materials_[which];
  const Expect expect = material.particles > 0 || mapped_ ? Expect::anything : Expect::success;
  if (!call("destroy material", expect, [&] { return loam_material_destroy(world_, material.id); })) return;
  if (material.particles > 0) find("a material that is in use was destroyed");
  stale_.push_back(material.id);
  materials_.erase(materials_.begin() + std::ptrdiff_t(which));
}

void Session::create_collider(Random &random) {
  ColliderArrays arrays;
  const loam_collider_def def = random_collider(random, def_.kernel_radius, arrays);
  loam_collider_id id = 0;
  const bool arrays_may_be_refused = // slivers may leave no triangle
      def.kind == LOAM_COLLIDER_MESH || def.kind == LOAM_COLLIDER_HULL || def.kind == LOAM_COLLIDER_GRID;
  const Expect expect = arrays_may_be_refused ? Expect::anything : Expect::success;
  if (!call("create collider", expect, [&] { return loam_collider_create(world_, &def, &id); })) return;
  Collider collider = {};
  collider.id = id;
  for (float *place : {collider.position, collider.target_position}) std::copy(def.position, def.position + 3, place);
  for (float *turn : {collider.rotation, collider.target_rotation}) std::copy(def.rotation, def.rotation + 4, turn);
  colliders_.push_back(collider);
  loam_collider_report found = {};
  found.struct_size = sizeof found;
  judge("report", Expect::success, loam_collider_get_report(world_, id, &found));
  if (found.triangles + found.degenerate_triangles != def.mesh.triangle_count)
    find("%u of %u triangles reported", found.triangles, def.mesh.triangle_count);
}

void Session::destroy_collider(Random &random) {
  if (colliders_.empty()) return;
  const std::size_t which = random.below(colliders_.size());
  if (!call("destroy collider", Expect::success, [&] { return loam_collider_destroy(world_, colliders_[which].id); }))
    return;
  stale_.push_back(colliders_[which].id);
  colliders_.erase(colliders_.begin() + std::ptrdiff_t(which));
}

void Session::pose_collider(Random &random) {
  if (colliders_.empty()) return;
  Collider &collider = colliders_[random.below(colliders_.size())];
  const bool teleport = random.chance(0.2);
  float position[3], rotation[4];
  random_place(random, def_.kernel_radius, position, rotation);
  if (!random.chance(0.2)) { // a small step from where it is, at times a turn
    const bool turn = random.chance(0.3);
    for (int k = 0; k < 3; ++k) position[k] = collider.position[k] + 0.05f * position[k];
    if (!turn) std::copy(collider.rotation, collider.rotation + 4, rotation);
  }
  const auto pose = teleport ? loam_collider_place : loam_collider_move;
  if (!call(teleport ? "place collider" : "move collider", Expect::success,
            [&] { return pose(world_, collider.id, position, rotation); }))
    return;
  std::copy(position, position + 3, collider.target_position);
  std::copy(rotation, rotation + 4, collider.target_rotation);
  if (!teleport) return;
  std::copy(position, position + 3, collider.position);
  std::copy(rotation, rotation + 4, collider.rotation);
}

// ------------------------------------------------------------------------------------------------------- particles ---

void Session::fill(Random &random) {
  if (materials_.empty()) return;
  RegionMeshes meshes;
  loam_fill_def def = random_fill(random, def_.kernel_radius, meshes);
  Material &material = materials_[random.below(materials_.size())];
  def.material = material.id;
  std::uint64_t made = 0;
  if (!call("fill", mapped_ ? Expect::in_use : Expect::anything, [&] { return loam_particles_fill(world_, &def, &made); }))
    return;
  if (made == 0) find("a fill made no particles and said nothing");
  count_ += made;
  material.particles += made;
  look();
}

void Session::add(Random &random) {
  if (materials_.empty()) return;
  ParticleArrays arrays;
  loam_particles_def def = random_particles(random, def_.kernel_radius, arrays);
  Material &material = materials_[random.below(materials_.size())];
  def.material = material.id;
  std::uint32_t first = 0;
  if (!call("add", mapped_ ? Expect::in_use : Expect::anything, [&] { return loam_particles_add(world_, &def, &first); }))
    return;
  if (first != count_) find("the first id is %u, not %u", first, unsigned(count_));
  count_ += def.count;
  material.particles += def.count;
  if (count_ > def_.particle_capacity) find("more particles than particle_capacity");
  look();
}

void Session::unmap() {
  if (call("unmap", mapped_ ? Expect::success : Expect::invalid, [&] { return loam_particles_unmap(world_); }))
    mapped_ = false;
}

void Session::map(Random &) {
  loam_particle_view view = {};
  view.struct_size = sizeof view;
  if (!call("map", mapped_ ? Expect::in_use : Expect::success, [&] { return loam_particles_map(world_, &view); })) return;
  mapped_ = true;
  check_view(view);
  judge("map again", Expect::in_use, loam_particles_map(world_, &view));
}

void Session::ask(Random &random) {
  std::uint64_t count = 0;
  judge("count", Expect::success, loam_particles_count(world_, &count));
  if (count != count_) find("%llu particles instead of %llu", (unsigned long long)count, (unsigned long long)count_);
  loam_stage stages[64];
  loam_memory rows[64];
  std::uint32_t have = 0, backend = 0, instruction_set = 0;
  const std::uint32_t room = random.below(64);
  judge("stages", Expect::success, loam_world_get_stages(world_, stages, room, &have));
  for (std::uint32_t i = 0; i < std::min(have, room); ++i)
    if (std::memchr(stages[i].name, 0, sizeof stages[i].name) == nullptr || !(stages[i].seconds >= 0)) find("stage %u", i);
  judge("memory", Expect::success, loam_world_get_memory(world_, rows, room, &have));
  for (std::uint32_t i = 0; i < std::min(have, room); ++i)
    if (std::memchr(rows[i].effect, 0, sizeof rows[i].effect) == nullptr) find("memory row %u", i);
  judge("backend", Expect::success, loam_world_get_backend(world_, &backend, &instruction_set));
  if (backend != LOAM_BACKEND_CPU || instruction_set == LOAM_INSTRUCTION_SET_AUTO)
    find("backend %u %u", backend, instruction_set);
  if (!materials_.empty()) {
    loam_material_def def = {};
    def.struct_size = sizeof def;
    judge("get material", Expect::success, loam_material_get(world_, any_material(random), &def));
  }
}

// ------------------------------------------------------------------------------------------------------- bad input ---

void Session::bad_number_or_choice(Random &random) {
  const float bad = bad_number(random), position[3] = {0, 0, 0}, rotation[4] = {0, 0, 0, 1};
  float spoilt[4] = {0, 0, 0, 1};
  spoilt[random.below(3)] = bad;
  switch (random.below(9)) {
  case 0: {
    constexpr float times[] = {0.0f, -1.0f, 1.0001f, 1e-12f};
    const float seconds = random.chance(0.5) ? bad : random.pick(times);
    call("step for a bad time", mapped_ ? Expect::failure : Expect::invalid,
         [&] { return loam_world_step(world_, seconds); });
    break;
  }
  case 1:
    call("set bad gravity", Expect::invalid, [&] { return loam_world_set_gravity(world_, spoilt); });
    break;
  case 2: {
    const bool first = random.chance(0.5);
    const std::uint32_t wrong = random.chance(0.5) ? 0 : random.from(10001, ~0u);
    call("set bad accuracy", Expect::invalid,
         [&] { return loam_world_set_accuracy(world_, first ? wrong : 1, first ? 1 : wrong); });
    break;
  }
  case 3: {
    loam_material_def def = random_material(random);
    spoil(def, random);
    loam_material_id id = 0;
    if (call("create a bad material", Expect::anything, [&] { return loam_material_create(world_, &def, &id); }))
      materials_.push_back({id, 0});
    break;
  }
  case 4: {
    ColliderArrays arrays;
    loam_collider_def def = random_collider(random, def_.kernel_radius, arrays);
    spoil(def, random, arrays);
    loam_collider_id id = 0;
    call("create a bad collider", Expect::failure, [&] { return loam_collider_create(world_, &def, &id); });
    break;
  }
  case 5: {
    if (colliders_.empty()) return;
    const loam_collider_id id = colliders_[random.below(colliders_.size())].id;
    const bool turned = random.chance(0.5), none = random.chance(0.3);
    if (none) spoilt[3] = 0;
    const float zero[4] = {0, 0, 0, 0};
    const auto pose = random.chance(0.5) ? loam_collider_place : loam_collider_move;
    call("pose a collider badly", Expect::invalid,
         [&] { return pose(world_, id, turned ? position : spoilt, turned ? (none ? zero : spoilt) : rotation); });
    break;
  }
  case 6: {
    if (materials_.empty()) return;
    RegionMeshes meshes;
    loam_fill_def def = random_fill(random, def_.kernel_radius, meshes);
    def.material = any_material(random);
    spoil(def, random, meshes);
    call("bad fill", Expect::failure, [&] { return loam_particles_fill(world_, &def, nullptr); });
    break;
  }
  case 7: {
    if (materials_.empty()) return;
    ParticleArrays arrays;
    loam_particles_def def = random_particles(random, def_.kernel_radius, arrays);
    def.material = any_material(random);
    spoil(def, random, arrays);
    call("bad add", Expect::failure, [&] { return loam_particles_add(world_, &def, nullptr); });
    break;
  }
  default: {
    loam_world_def def = random_world(random);
    switch (random.below(5)) {
    case 0:
      def.kernel_radius = random.chance(0.5) ? 0.0f : bad;
      break;
    case 1:
      def.substeps = random.chance(0.5) ? 0 : 10001;
      break;
    case 2:
      def.thread_count = 257;
      break;
    case 3:
      def.solver = LOAM_SOLVER_JACOBI + 1 + random.below(9);
      break;
    default:
      def.particle_capacity = random.chance(0.5) ? 0 : std::uint64_t(1) << random.from(29, 63);
      break;
    }
    loam_world *none = world_;
    call("create a bad world", Expect::failure, [&] { return loam_world_create(&def, &none); });
    if (!leaves_out() && none != nullptr) find("a world came of a bad definition");
    break;
  }
  }
}

void Session::bad_handle(Random &random) {
  const std::uint32_t which = random.below(7);
  std::uint64_t id = 0;
  if (!stale_.empty() && random.chance(0.6))
    id = stale_[random.below(stale_.size())];
  else if (random.chance(0.3))
    id = random.next();
  else if (which < 3 && !materials_.empty()) // good, but of another kind
    id = any_material(random);
  else if (which >= 3 && !colliders_.empty())
    id = colliders_[random.below(colliders_.size())].id;
  const float position[3] = {0, 0, 0}, rotation[4] = {0, 0, 0, 1};
  switch (which) {
  case 0:
    call("destroy no collider", Expect::stale, [&] { return loam_collider_destroy(world_, id); });
    break;
  case 1:
    call("move no collider", Expect::stale, [&] { return loam_collider_move(world_, id, position, rotation); });
    break;
  case 2: {
    loam_collider_report report = {};
    report.struct_size = sizeof report;
    call("report no collider", Expect::stale, [&] { return loam_collider_get_report(world_, id, &report); });
    break;
  }
  case 3:
    call("destroy no material", Expect::stale, [&] { return loam_material_destroy(world_, id); });
    break;
  case 4: {
    loam_material_def def = {};
    def.struct_size = sizeof def;
    call("get no material", Expect::stale, [&] { return loam_material_get(world_, id, &def); });
    break;
  }
  case 5: {
    RegionMeshes meshes;
    loam_fill_def def = random_fill(random, def_.kernel_radius, meshes);
    def.material = id;
    call("fill with nothing", mapped_ ? Expect::failure : Expect::stale,
         [&] { return loam_particles_fill(world_, &def, nullptr); });
    break;
  }
  default: {
    ParticleArrays arrays;
    loam_particles_def def = random_particles(random, def_.kernel_radius, arrays);
    def.material = id;
    call("add nothing", mapped_ ? Expect::failure : Expect::stale,
         [&] { return loam_particles_add(world_, &def, nullptr); });
    break;
  }
  }
}

void Session::bad_pointer(Random &random) {
  const float rotation[4] = {0, 0, 0, 1};
  const loam_collider_id collider = colliders_.empty() ? 0 : colliders_.front().id;
  const auto refused = [&](auto &&f) { call("null", Expect::failure, f); };
  std::uint32_t count = 0;
  switch (random.below(14)) {
  case 0:
    return refused([&] { return loam_world_step(nullptr, 0.01f); });
  case 1:
    return refused([&] { return loam_world_set_gravity(world_, nullptr); });
  case 2:
    return refused([&] { return loam_material_create(world_, nullptr, nullptr); });
  case 3:
    return refused([&] { return loam_collider_create(world_, nullptr, nullptr); });
  case 4:
    return refused([&] { return loam_particles_fill(world_, nullptr, nullptr); });
  case 5:
    return refused([&] { return loam_particles_add(world_, nullptr, nullptr); });
  case 6:
    return refused([&] { return loam_particles_map(world_, nullptr); });
  case 7:
    return refused([&] { return loam_world_get_statistics(world_, nullptr); });
  case 8:
    return refused([&] { return loam_world_get_stages(world_, nullptr, 1, &count); });
  case 9:
    return refused([&] { return loam_collider_move(world_, collider, nullptr, rotation); });
  case 10:
    return refused([&] { return loam_world_state_hash(world_, nullptr); });
  case 11:
    return refused([&] { return loam_particles_count(nullptr, nullptr); });
  case 12:
    return refused([&] {
      loam_statistics statistics = {};
      statistics.struct_size = 3;
      return loam_world_get_statistics(world_, &statistics);
    });
  default:
    return refused([&] {
      loam_world *none = nullptr;
      return loam_world_create(nullptr, &none);
    });
  }
}

// -------------------------------------------------------------------------------------------------------------- run ---

void Session::act(Random &random) {
  struct Choice {
    int weight;
    Action action;
  };
  static constexpr Choice choices[] = {{60, &Session::step},
                                       {8, &Session::change_settings},
                                       {6, &Session::create_material},
                                       {4, &Session::change_material},
                                       {5, &Session::change_meeting},
                                       {3, &Session::destroy_material},
                                       {7, &Session::create_collider},
                                       {3, &Session::destroy_collider},
                                       {20, &Session::pose_collider},
                                       {8, &Session::fill},
                                       {8, &Session::add},
                                       {4, &Session::map},
                                       {3, &Session::ask},
                                       {12, &Session::bad_number_or_choice},
                                       {6, &Session::bad_handle},
                                       {3, &Session::bad_pointer}};
  int sum = 0;
  for (const Choice &choice : choices) sum += choice.weight;
  int left = int(random.below(std::size_t(sum)));
  for (const Choice &choice : choices) {
    left -= choice.weight;
    if (left < 0) return (this->*choice.action)(random);
  }
}

SessionReport Session::run() {
  Random shape(options_.seed);
  const std::uint32_t calls = shape.from(10, 90);
  for (std::uint32_t i = 0; i < calls && report_.findings.size() < 5; ++i) {
    Random random(options_.seed, i + 1);
    report_.refused.push_back(false);
    if (world_ != nullptr && random.chance(0.01)) destroy_world();
    const std::uint32_t nth = random.chance(0.15) ? random.from(1, 4) : 0;
    if (refuses_) allocator_.refuse(nth);
    if (world_ == nullptr)
      create_world(random);
    else if (mapped_ ? random.chance(0.4) : random.chance(0.002)) // a host lets go of them soon
      unmap();
    else if (materials_.empty() && random.chance(0.5))
      create_material(random);
    else if (count_ == 0 && random.chance(0.3))
      random.chance(0.7) ? fill(random) : add(random);
    else
      act(random);
    allocator_.refuse(0);
    report_.hashes.push_back(hash());
    check_memory(false);
  }
  destroy_world();
  return std::move(report_);
}

} // namespace

SessionReport run_session(const SessionOptions &options) { return Session(options).run(); }

} // namespace loam::fuzz
