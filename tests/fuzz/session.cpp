#include "session.h"

#include <cstdarg>

#include "session_actions.h"

namespace loam::fuzz {

void Session::find(const char *text, ...) {
  char line[512];
  va_list arguments;
  va_start(arguments, text);
  std::vsnprintf(line, sizeof line, text, arguments);
  va_end(arguments);
  report_.findings.push_back("call " + std::to_string(report_.refused.size()) + ": " + line);
}

void Session::judge(const char *name, Expect expect, loam_status status) {
  status_ = status;
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
  now_.substeps = def_.substeps;
}

void Session::destroy_world() {
  if (world_ == nullptr) return;
  for (const Material &material : now_.materials) stale_.push_back(material.id);
  for (const Collider &collider : now_.colliders) stale_.push_back(collider.id);
  for (const Cloth &cloth : now_.cloths) stale_.push_back(cloth.id);
  for (const Emitter &emitter : now_.emitters) stale_.push_back(emitter.id);
  for (const loam_field_id field : now_.fields) stale_.push_back(field);
  for (const Killer &killer : now_.killers) stale_.push_back(killer.id);
  now_ = {};
  ++description_;
  kept_ = nullptr;
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
  // The allocator of the tests wants to be called on this thread.
  step_for(seconds, random.chance(0.1) && def_.allocator.allocate == nullptr);
}

void Session::step_for(float seconds, bool in_the_background) {
  const double speed = greatest_collider_speed(seconds);
  const bool may_lack_room = def_.pair_capacity != 0 || a_stream_tells();
  const Expect expect = mapped_ ? Expect::in_use : may_lack_room ? Expect::room_or_none : Expect::success;
  const auto step = [&] {
    if (!in_the_background) return loam_world_step(world_, seconds);
    const loam_status begun = loam_world_step_async(world_, seconds);
    if (begun != LOAM_OK) return begun;
    std::uint64_t ignored = 0;
    std::uint32_t running = 2;
    if (loam_particles_count(world_, &ignored) != LOAM_ERROR_BUSY)
      find("a world counts its particles in an asynchronous step");
    judge("is stepping", Expect::success, loam_world_is_stepping(world_, &running));
    if (running > 1) find("is stepping: %u", running);
    return loam_world_wait(world_);
  };
  bool done = call("step", expect, step);
  if (!mapped_ && !leaves_out()) {
    const bool lacked_room = !done && status_ == LOAM_ERROR_CAPACITY;
    count_effects();
    loam_statistics now = {};
    now.struct_size = sizeof now;
    judge("statistics", Expect::success, loam_world_get_statistics(world_, &now));
    done = done || (lacked_room && now.particles_dropped > 0 && now.substeps_done == now_.substeps); // a stream's room
  }
  if (done) {
    ++report_.steps;
    report_.particles += now_.count;
    for (Collider &collider : now_.colliders) {
      std::copy(collider.target_position, collider.target_position + 3, collider.position);
      std::copy(collider.target_rotation, collider.target_rotation + 4, collider.rotation);
      collider.vertices = collider.target_vertices;
    }
    check_after_step(seconds, speed);
  }
  if (!mapped_ && !leaves_out()) look();
}

double Session::greatest_distance(const float from[3]) const {
  double greatest = 0;
  for (const Particle &p : now_.particles)
    if (p.here)
      greatest =
          std::max(greatest, std::hypot(double(p.position[0]) - double(from[0]), double(p.position[1]) - double(from[1]),
                                        double(p.position[2]) - double(from[2])));
  return greatest;
}

/* Of any point of a collider that matter may touch during the next step. */
double Session::greatest_collider_speed(float seconds) const {
  const double limit = double(def_.kernel_radius) * now_.substeps; // how far matter goes in a step, twice at most
  double greatest = 0;
  for (const Collider &collider : now_.colliders) {
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
    double own = 0;
    for (std::size_t i = 0; i < collider.vertices.size(); i += 3) {
      const float *from = &collider.vertices[i], *to = &collider.target_vertices[i];
      own = std::max(own, std::hypot(double(to[0]) - double(from[0]), double(to[1]) - double(from[1]),
                                     double(to[2]) - double(from[2])));
    }
    greatest = std::max(greatest, (moved + angle * reach + own) / double(seconds));
  }
  return greatest;
}

void Session::check_after_step(float seconds, double collider_speed) {
  loam_statistics now = {};
  now.struct_size = sizeof now;
  judge("statistics", Expect::success, loam_world_get_statistics(world_, &now));
  if (now.particles != now_.count)
    find("%llu particles instead of %llu", (unsigned long long)now.particles, (unsigned long long)now_.count);
  if (now.non_finite != 0) find("%llu particles are not finite", (unsigned long long)now.non_finite);
  if (now_.count > 0 && now.substeps_done != now_.substeps)
    find("%u substeps instead of %u", now.substeps_done, now_.substeps);
  const double limit = double(def_.kernel_radius) / (double(seconds) / now_.substeps);
  // Cloth falls as fast as it will, and carries along what it hits. How fast it was within the step nobody sees: as fast as it ever was.
  double cloth_speed = 0;
  if (!now_.cloths.empty()) {
    allocator_.refuse(0);
    for (const Cloth &cloth : now_.cloths) now_.cloth_speed = std::max(now_.cloth_speed, look_at_cloth(cloth));
    cloth_speed = now_.cloth_speed;
  }
  double stream_speed = 0; // of what has just come out
  for (const Emitter &emitter : now_.emitters) stream_speed = std::max(stream_speed, emitter.speed);
  if (!(now.max_speed <= std::max(1.001 * stream_speed, 2 * (limit * 1.001 + collider_speed + cloth_speed))))
    find("a particle is at %g m/s; r / substep is %g m/s, colliders go at %g m/s, cloth at %g m/s", now.max_speed, limit,
         collider_speed, cloth_speed);
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
  for (const Cloth &cloth : now_.cloths) look_at_cloth(cloth);
}

void Session::check_view(const loam_particle_view &view) {
  if (view.count != now_.count || view.memory != LOAM_MEMORY_HOST) {
    find("%llu particles mapped", (unsigned long long)view.count);
    return;
  }
  std::vector<bool> seen(now_.particles.size(), false);
  for (Material &material : now_.materials) material.particles = 0;
  for (std::size_t i = 0; i < view.count; ++i) {
    const std::uint32_t id = view.ids[i];
    if (id >= seen.size() || seen[id] || !now_.particles[id].here) {
      find("the id %u is unknown, there twice or that of a removed one", id);
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
    for (Material &material : now_.materials) material.particles += std::uint32_t(material.id) == view.materials[i] ? 1 : 0;
    Particle &known = now_.particles[id];
    const bool was_led = known.inverse_mass == 0 && known.streamed && known.material == view.materials[i];
    if (known.inverse_mass < 0 || was_led) {
      known.inverse_mass = v[3];
      known.material = view.materials[i];
    } else if (known.inverse_mass != v[3] || known.material != view.materials[i]) {
      find("the mass or material of particle %u has changed", id);
    }
    std::copy(x, x + 3, known.position);
  }
}

void Session::change_settings(Random &random) {
  if (random.chance(0.5)) {
    float gravity[3];
    for (float &g : gravity) g = random.chance(0.02) ? 1e6f : random.between(-30, 30);
    call("set gravity", Expect::success, [&] { return loam_world_set_gravity(world_, gravity); });
  } else {
    const auto substeps = std::uint32_t(random.log_between(1, 24)), iterations = std::uint32_t(random.log_between(1, 9));
    const auto set = [&] {
      if (random.chance(0.7)) return loam_world_set_accuracy(world_, substeps, iterations);
      loam_accuracy_def def;
      if (const loam_status status = loam_accuracy_def_default(&def, sizeof def); status != LOAM_OK) return status;
      def.mode = LOAM_ACCURACY_TOLERANCE;
      def.substeps = substeps;
      def.iterations = iterations + 2;
      def.tolerance = random.log_between(LOAM_LEAST_TOLERANCE, 0.5f);
      return loam_world_use_accuracy(world_, &def);
    };
    if (call("set accuracy", Expect::success, set)) now_.substeps = substeps;
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
                                       {12, &Session::deform_collider},
                                       {8, &Session::fill},
                                       {8, &Session::add},
                                       {4, &Session::map},
                                       {3, &Session::ask},
                                       {4, &Session::change_contact},
                                       {5, &Session::remove},
                                       {6, &Session::move},
                                       {3, &Session::keep},
                                       {2, &Session::shift_origin},
                                       {2, &Session::wake},
                                       {4, &Session::save},
                                       {5, &Session::restore},
                                       {4, &Session::roll_back},
                                       {3, &Session::bad_bulk},
                                       {3, &Session::create_cloth},
                                       {1, &Session::destroy_cloth},
                                       {4, &Session::attach},
                                       {2, &Session::release},
                                       {2, &Session::blow},
                                       {2, &Session::bad_cloth},
                                       {6, &Session::change_emitters},
                                       {4, &Session::change_fields},
                                       {6, &Session::change_killers},
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
    else if (now_.materials.empty() && random.chance(0.5))
      create_material(random);
    else if (now_.count == 0 && random.chance(0.3))
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

SessionReport run_session(const SessionOptions &options) { return Session(options).run(); }

} // namespace loam::fuzz
