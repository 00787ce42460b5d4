// A world's step: how it is cut, what the solver is told, and what is to be kept in the books afterwards.
#include <algorithm>
#include <chrono>
#include <system_error>

#include "scene/checks.h"
#include "scene/material.h"
#include "scene/pose.h"
#include "scene/world.h"

using namespace loam;

void loam_world::check_step(float seconds) const {
  check_above("seconds", static_cast<double>(seconds), 0, 1);
  check_unmapped();
  if (cloths_.any_mapped()) throw Error(LOAM_ERROR_IN_USE, "a cloth's buffers are mapped; call loam_cloth_unmap first");
  const std::uint32_t most = accuracy_.substeps != 0 ? accuracy_.substeps : accuracy_.most_substeps;
  if (!(seconds / static_cast<float>(most) >= 1e-9f))
    throw Error(LOAM_ERROR_INVALID_ARGUMENT, format("seconds is %g; over %u substeps that is less than 1e-9 s a substep",
                                                    static_cast<double>(seconds), most));
}

void loam_world::step(float seconds) {
  check_step(seconds);
  run_step(seconds);
}

void loam_world::begin_step(float seconds) {
  check_step(seconds);
  if (step_thread_ == nullptr) {
    try {
      step_thread_ = std::make_unique<StepThread>([this](float s) { run_step(s); });
    } catch (const std::system_error &error) {
      throw Error(LOAM_ERROR_OUT_OF_MEMORY, format("no thread for the asynchronous step: %s", error.what()));
    }
  }
  step_thread_->begin(seconds);
  busy_ = true;
}

void loam_world::wait() {
  if (!busy_) throw Error(LOAM_ERROR_INVALID_ARGUMENT, "no step was begun with loam_world_step_async");
  // Not busy even if the step failed: wait() throws after the step is over.
  struct Done {
    bool &busy;
    ~Done() { busy = false; }
  } const done{busy_};
  step_thread_->wait();
}

void loam_world::check_not_stepping() const {
  if (busy_) throw Error(LOAM_ERROR_BUSY, "an asynchronous step was begun; call loam_world_wait first");
}

const loam::Schedule &loam_world::schedule() const {
  return backend_->schedule(
      {!colliders_.empty(), emitters_.any(), fields_.any(), killers_.any(), accuracy_.mode == LOAM_ACCURACY_TOLERANCE});
}

double loam_world::load() const {
  return static_cast<double>(backend_->particle_count()) + static_cast<double>(cloths_.vertex_count());
}

loam::StepChoice loam_world::choose_step(float seconds) {
  if (accuracy_.substeps != 0) return choose_substeps(accuracy_, {});
  StepNeeds needs = {static_cast<double>(seconds),
                     static_cast<double>(def_.kernel_radius),
                     backend_->greatest_speed(),
                     0,
                     static_cast<double>(length(input_.gravity)),
                     cloths_.any()};
  for (std::size_t i = 0; i < materials_.size(); ++i)
    if (const Material *m = materials_.at_index(i); m != nullptr && (m->particles > 0 || m->emitters > 0))
      needs.wave_speed = std::max(needs.wave_speed, wave_speed(m->def));
  for (std::size_t i = 0; i < colliders_.size(); ++i)
    if (const Collider *c = colliders_.at_index(i); c != nullptr)
      needs.speed = std::max(needs.speed, static_cast<double>(length(c->target.position - c->pose.position) / seconds));
  emitters_.for_each([&](const Emitter &e) { needs.speed = std::max(needs.speed, static_cast<double>(e.def().speed)); });
  return accuracy_.mode == LOAM_ACCURACY_BUDGET ? budget_.choose(accuracy_, needs, load())
                                                : choose_substeps(accuracy_, needs);
}

void loam_world::run_step(float seconds) {
  const auto begin = std::chrono::steady_clock::now();
  input_.seconds = seconds;
  choice_ = choose_step(seconds);
  input_.substeps = choice_.substeps;
  input_.iterations = choice_.iterations;
  input_.tolerance = accuracy_.mode == LOAM_ACCURACY_TOLERANCE ? static_cast<double>(accuracy_.tolerance) : 0;
  limit_stiffness();
  input_.colliders.clear();
  if (cloths_.any()) index_of_slot_.assign(colliders_.size(), 0);
  for (std::size_t i = 0; i < colliders_.size(); ++i)
    if (Collider *c = colliders_.at_index(i); c != nullptr) {
      if (cloths_.any()) index_of_slot_[i] = static_cast<int>(input_.colliders.size());
      input_.colliders.push_back(
          {c->shape, c->law, c->pose, c->target, c->pairs, c->asks_reaction ? &c->reaction : nullptr});
    }
  cloths_.use_colliders(backend_->cloth(), index_of_slot_);
  input_.source = emitters_.any() ? &emitters_ : nullptr;
  fields_.list(input_.fields);
  killers_.begin_step(input_.killers);
  removed_.assign(input_.killers.empty() ? 0 : materials_.size(), 0);
  input_.removed = &removed_;
  try {
    backend_->step(input_);
    input_.wake = false;
  } catch (const Error &) {
    (void)count_streams();
    fields_.advance(static_cast<double>(seconds), input_.substeps, backend_->statistics().substeps_done);
    // Colliders stop with the particles, at the end of the last whole substep.
    const double share = static_cast<double>(backend_->statistics().substeps_done) / input_.substeps;
    for (std::size_t i = 0; i < colliders_.size(); ++i)
      if (Collider *c = colliders_.at_index(i); c != nullptr) c->pose = interpolate(c->pose, c->target, share);
    throw;
  }
  // Whatever else is to be told of the step: it was done, and what it cost is known.
  if (accuracy_.mode == LOAM_ACCURACY_BUDGET)
    budget_.learn(choice_, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(),
                  iteration_seconds(schedule()), load(), static_cast<double>(accuracy_.budget));
  for (std::size_t i = 0; i < colliders_.size(); ++i)
    if (Collider *c = colliders_.at_index(i); c != nullptr) c->pose = c->target;
  fields_.advance(static_cast<double>(seconds), input_.substeps, input_.substeps);
  const std::uint64_t untold = count_streams();
  count_killed();
  if (untold > 0)
    throw Error(LOAM_ERROR_CAPACITY,
                format("%llu particles of streams found no room and were dropped; the step was done. particle_capacity is "
                       "%llu and would have to be %llu so far",
                       static_cast<unsigned long long>(untold), static_cast<unsigned long long>(def_.particle_capacity),
                       static_cast<unsigned long long>(capacity_needed())));
  if (choice_.exceeds_budget)
    throw Error(
        LOAM_ERROR_BUDGET,
        format("budget is %g s; %u substeps of %u iterations, which stability needs, take %g s; the step was done with them",
               static_cast<double>(accuracy_.budget), choice_.substeps, choice_.iterations, choice_.least_budget));
}

loam_statistics loam_world::statistics() const {
  loam_statistics values = backend_->statistics();
  values.particles = backend_->particle_count();
  values.capacity_needed = capacity_needed();
  values.substeps = choice_.substeps;
  if (!(input_.tolerance > 0)) values.iterations = choice_.iterations; // even if nothing was there to be solved
  values.substeps_reason = choice_.reason;
  values.least_budget = choice_.least_budget;
  return values;
}

void loam_world::count_killed() {
  killers_.end_step();
  bool changed = false;
  for (std::size_t i = 0; i < removed_.size(); ++i)
    if (Material *m = removed_[i] > 0 ? materials_.at_index(i) : nullptr; m != nullptr) {
      m->particles -= removed_[i];
      changed = changed || (m->particles == 0 && m->emitters == 0);
    }
  if (changed) send_materials(); // fewer in use: needs no memory
}

// What streamed in, into the books. Answers how many were dropped that the host wants to be told of.
std::uint64_t loam_world::count_streams() {
  std::uint64_t untold = 0;
  emitters_.for_each([&](Emitter &emitter) {
    const EmitterState &state = emitter.state();
    materials_.at(emitter.material(), "material").particles += state.entered - emitter.counted;
    emitter.counted = state.entered;
    const std::uint64_t dropped = state.dropped - emitter.told;
    emitter.told = state.dropped;
    dropped_ += dropped;
    if (emitter.def().when_full == LOAM_FULL_TELL) untold += dropped;
  });
  return untold;
}

std::uint64_t loam_world::capacity_needed() const { return dropped_ > 0 ? def_.particle_capacity + dropped_ : 0; }

void loam_world::limit_stiffness() {
  input_.stiffness_share = 1;
  if (def_.multiplier != LOAM_MULTIPLIER_PROJECTED_TENSOR) return; // the scalar form gives way by itself
  const double substep = static_cast<double>(input_.seconds) / input_.substeps;
  bool changed = false;
  for (std::size_t i = 0; i < materials_.size(); ++i) {
    Material *m = materials_.at_index(i);
    if (m == nullptr) continue;
    const float share =
        static_cast<float>(stiffness_share(m->def, static_cast<double>(def_.kernel_radius), substep, input_.iterations));
    changed = changed || share != m->stiffness_share;
    m->stiffness_share = share;
    if (m->particles > 0 || m->emitters > 0) input_.stiffness_share = std::min(input_.stiffness_share, share);
  }
  if (changed) send_materials();
}

void loam_world::set_accuracy(const loam_accuracy_def &def) {
  check_accuracy(def);
  if (def.mode == LOAM_ACCURACY_BUDGET && accuracy_.mode != LOAM_ACCURACY_BUDGET) budget_.reset();
  if (def.budget != accuracy_.budget) budget_.forgive();
  accuracy_ = def;
}
