// What streams in after a substep. Part of solver.h.
#pragma once

namespace loam {

template <class Executor> void Solver<Executor>::let_in(ParticleSource &source, double seconds) {
  const std::uint64_t before = statistics_.particles_entered;
  source.advance(seconds, *this);
  lap(schedule_.emitters, statistics_.particles_entered - before);
}

template <class Executor> std::uint64_t Solver<Executor>::room() const { return settings_.particle_capacity - particles(); }

template <class Executor> void Solver<Executor>::drop(std::uint64_t count) { statistics_.particles_dropped += count; }

template <class Executor> void Solver<Executor>::enter(const Layer &layer) {
  const auto n = static_cast<std::size_t>(layer.count), at = static_cast<std::size_t>(count_);
  executor_.upload(now_.positions.data() + at, layer.positions, n);
  executor_.upload(now_.velocities.data() + at, layer.velocities, n);
  executor_.upload(now_.ids.data() + at, layer.ids, n);
  set_unstrained(at, layer.count, layer.material, layer.volume);
  awake_ = 1;
  count_ += layer.count;
  statistics_.particles_entered += n;
}

template <class Executor> void Solver<Executor>::release(const Release &release) {
  executor_.for_each(count_, ReleaseParticles{now_.velocities.data(), now_.ids.data(), release.first_id, release.count,
                                              release.inverse_mass, release.velocity_jitter, release.seed});
}

// The state of undeformed matter.
template <class Executor>
void Solver<Executor>::set_unstrained(std::size_t at, int count, std::uint32_t material, float volume) {
  executor_.set(now_.materials.data() + at, count, material);
  executor_.set(now_.rest_volumes.data() + at, count, volume);
  executor_.set(now_.log_volumes.data() + at, count, 0.0f);
  executor_.set(now_.strains.data() + 6 * at, 6 * count, 0.0f);
  if (histories_in_use_) {
    const float history = std::visit([](const auto &law) { return law.initial_history(); }, materials_[material].law);
    executor_.set(now_.histories.data() + at, count, history);
  }
  if (drifts_in_use_) executor_.set(now_.drifts.data() + 3 * at, 3 * count, 0.0f);
  if (warm_start()) executor_.set(stresses_.data() + 6 * at, 6 * count, 0.0f);
  if (warm_start() && drifts_in_use_) executor_.set(answered_drifts_.data() + 3 * at, 3 * count, 0.0f);
  if (displacements_in_use_) executor_.set(now_.displacements.data() + at, count, 0.0f);
  if (now_.free_distances.capacity() > 0) executor_.set(now_.free_distances.data() + at, count, 0.0f);
  if (now_.rests.capacity() > 0) executor_.set(now_.rests.data() + at, count, 0.0f);
  if (now_.ages.capacity() > 0) executor_.set(now_.ages.data() + at, count, 0.0f);
}

} // namespace loam
