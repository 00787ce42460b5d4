#include "scene/emitter.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "kernels/integration/measures.h"
#include "scene/checks.h"
#include "scene/fingerprint.h"
#include "scene/random.h"

namespace loam {

namespace {

// Where in the distance between layers each place has its particle: all shares of it alike, from -1/2 to 1/2, in a random order.
std::vector<double> make_phases(std::size_t places, std::uint32_t seed) {
  std::vector<double> phases(places);
  for (std::size_t i = 0; i < places; ++i) phases[i] = (static_cast<double>(i) + 0.5) / static_cast<double>(places) - 0.5;
  Random random = {seed};
  for (std::size_t i = places; i > 1; --i) std::swap(phases[i - 1], phases[static_cast<std::size_t>(random.next() % i)]);
  return phases;
}

void check_emitter(const loam_emitter_def &def, double r) {
  check_choice("nozzle", def.nozzle, LOAM_NOZZLE_MESH);
  check_vector("position", def.position, 1e6 * r);
  check_vector("direction", def.direction, 1e6);
  const double x = static_cast<double>(def.direction[0]), y = static_cast<double>(def.direction[1]),
               z = static_cast<double>(def.direction[2]);
  if (!(x * x + y * y + z * z > 1e-12))
    throw Error(LOAM_ERROR_INVALID_ARGUMENT, format("direction is (%g, %g, %g); its length must be over 1e-6", x, y, z));
  check_above("speed", static_cast<double>(def.speed), 0, 1e4);
  check_range("flow", static_cast<double>(def.flow), 0, 1e18);
  check_range("mass_flow", static_cast<double>(def.mass_flow), 0, 1e24);
  if (def.flow > 0 && def.mass_flow > 0)
    throw Error(LOAM_ERROR_INVALID_ARGUMENT, format("flow is %g and mass_flow is %g; give one of them at most",
                                                    static_cast<double>(def.flow), static_cast<double>(def.mass_flow)));
  if (def.spacing != 0.0f) check_range("spacing", static_cast<double>(def.spacing), 0.5 * r, 1e3 * r);
  const double spacing = def.spacing != 0.0f ? static_cast<double>(def.spacing) : r;
  if (def.nozzle == LOAM_NOZZLE_DISC) check_range("radius", static_cast<double>(def.radius), 0.5 * spacing, 1e6 * r);
  check_range("jitter", static_cast<double>(def.jitter), 0, 0.5);
  check_range("velocity_jitter", static_cast<double>(def.velocity_jitter), 0, 1e4);
  check_range("start", static_cast<double>(def.start), 0, 1e6);
  check_range("stop", static_cast<double>(def.stop), 0, 1e6);
  if (def.stop != 0.0f && !(def.stop > def.start))
    throw Error(LOAM_ERROR_INVALID_ARGUMENT, format("stop is %g; it must be 0 or over start, which is %g",
                                                    static_cast<double>(def.stop), static_cast<double>(def.start)));
  check_choice("when_full", def.when_full, LOAM_FULL_DROP);
}

} // namespace

Emitter::Emitter(const loam_emitter_def &def, float kernel_radius, float density, std::uint64_t capacity) : def_(def) {
  const double r = static_cast<double>(kernel_radius);
  check_emitter(def, r);
  spacing_ = def.spacing != 0.0f ? static_cast<double>(def.spacing) : r;
  nozzle_ = make_nozzle(def, spacing_, capacity);
  def_.mesh = {};
  mesh_ = def.nozzle == LOAM_NOZZLE_MESH ? mesh_fingerprint(def.mesh) : 0;
  state_.position = {static_cast<double>(def.position[0]), static_cast<double>(def.position[1]),
                     static_cast<double>(def.position[2])};
  const auto places = static_cast<double>(nozzle_.places.size());
  // The opening's matter, shared out among its places.
  volume_ = nozzle_.area * spacing_ / places;
  inverse_mass_ = static_cast<float>(1 / (static_cast<double>(density) * volume_));
  if (!(inverse_mass_ > 0.0f && inverse_mass_ <= 1e30f))
    throw Error(LOAM_ERROR_INVALID_ARGUMENT,
                format("a particle of %g m^3 and %g kg/m^3 has a mass that single precision cannot hold", volume_,
                       static_cast<double>(density)));
  const bool by_mass = def.mass_flow > 0;
  const double flow =
      by_mass ? static_cast<double>(def.mass_flow) / static_cast<double>(density) : static_cast<double>(def.flow);
  const double speed = static_cast<double>(def.speed), most = nozzle_.area * speed;
  if (flow > most * (1 + 1e-6))
    throw Error(LOAM_ERROR_INVALID_ARGUMENT,
                format("%s is %g; an opening of %g m^2 carries at most %g at %g m/s", by_mass ? "mass_flow" : "flow",
                       static_cast<double>(by_mass ? def.mass_flow : def.flow), nozzle_.area,
                       by_mass ? most * static_cast<double>(density) : most, speed));
  per_layer_ = flow > 0 ? std::min(places, places * flow / most) : places;
  phases_ = make_phases(nozzle_.places.size(), def.seed);
  choice_.resize(nozzle_.places.size());
  ids_.resize(nozzle_.places.size());
  positions_.resize(nozzle_.places.size());
  velocities_.resize(nozzle_.places.size());
}

void Emitter::advance(double seconds, std::uint64_t &next_id, ParticleSink &sink) {
  state_.clock += seconds;
  while (entry(state_.next_layer) <= state_.clock) {
    let_go(sink);
    if (past_stop(entry(state_.next_layer))) return;
    enter(state_.next_layer++, next_id, sink);
  }
}

void Emitter::let_go(ParticleSink &sink) {
  if (state_.held_count > 0)
    sink.release({state_.held_first, state_.held_count, inverse_mass_, def_.velocity_jitter, def_.seed});
  state_.held_count = 0;
}

void Emitter::enter(std::uint64_t layer, std::uint64_t &next_id, ParticleSink &sink) {
  const double k = static_cast<double>(layer);
  const auto wanted = static_cast<std::uint64_t>(std::floor((k + 1) * per_layer_) - std::floor(k * per_layer_));
  const std::uint64_t due = std::min<std::uint64_t>(wanted, choice_.size());
  const std::uint64_t count = std::min({due, sink.room(), 0xffffffffu - next_id});
  if (count < due) {
    state_.dropped += due - count;
    sink.drop(due - count);
  }
  if (count == 0) return;

  Random random = {(static_cast<std::uint64_t>(def_.seed) << 32 ^ layer) * 0x9E3779B97F4A7C15u};
  for (std::size_t i = 0; i < choice_.size(); ++i) choice_[i] = static_cast<std::uint32_t>(i);
  const float v = def_.speed;
  const double gone = (state_.clock - entry(layer)) * static_cast<double>(v), jitter = static_cast<double>(def_.jitter);
  const Vec3<float> n = {static_cast<float>(nozzle_.along.x), static_cast<float>(nozzle_.along.y),
                         static_cast<float>(nozzle_.along.z)};
  for (std::size_t i = 0; i < count; ++i) {
    if (due < choice_.size()) // the first `count` of a random order
      std::swap(choice_[i], choice_[i + static_cast<std::size_t>(random.next() % (choice_.size() - i))]);
    const double a = spacing_ * random.between(-jitter, jitter), b = spacing_ * random.between(-jitter, jitter);
    const std::uint32_t place = choice_[i];
    const Vec3<double> x = state_.position + nozzle_.places[place] + a * nozzle_.across[0] + b * nozzle_.across[1] +
                           (gone + spacing_ * phases_[place]) * nozzle_.along;
    positions_[i] = {static_cast<float>(x.x), static_cast<float>(x.y), static_cast<float>(x.z), static_cast<float>(volume_)};
    velocities_[i] = {v * n.x, v * n.y, v * n.z, 0};
    ids_[i] = static_cast<std::uint32_t>(next_id + i);
  }
  sink.enter({static_cast<std::uint32_t>(def_.material & 0xffffffffu), static_cast<std::uint32_t>(next_id),
              static_cast<int>(count), static_cast<float>(volume_), positions_.data(), velocities_.data(), ids_.data()});
  state_.held_first = static_cast<std::uint32_t>(next_id);
  state_.held_count = static_cast<std::uint32_t>(count);
  state_.entered += count;
  next_id += count;
}

loam_emitter_report Emitter::report() const {
  loam_emitter_report report = {};
  report.struct_size = sizeof report;
  report.stopped = past_stop(entry(state_.next_layer)) ? 1 : 0;
  report.entered = state_.entered;
  report.dropped = state_.dropped;
  report.volume = volume_;
  report.volume_flow = per_layer_ * volume_ * static_cast<double>(def_.speed) / spacing_;
  return report;
}

void Emitter::shift_origin(const Vec3<float> &by) {
  state_.position =
      state_.position - Vec3<double>{static_cast<double>(by.x), static_cast<double>(by.y), static_cast<double>(by.z)};
}

void Emitter::check_state(const EmitterState &state, std::uint64_t next_id) const {
  for (const double x : {state.position.x, state.position.y, state.position.z}) check_range("position", x, -1e15, 1e15);
  check_range("clock of an emitter", state.clock, 0, 1e12);
  check_range("number of layers", static_cast<double>(state.next_layer), 0, 1e18);
  // All layers whose time has come have entered, and no others.
  const bool none_early =
      state.next_layer == 0 || (entry(state.next_layer - 1) <= state.clock && !past_stop(entry(state.next_layer - 1)));
  const bool none_missing = entry(state.next_layer) > state.clock || past_stop(entry(state.next_layer));
  if (!none_early || !none_missing)
    throw Error(LOAM_ERROR_INVALID_ARGUMENT, format("%llu layers of a stream by the time %g s are not what its speed gives",
                                                    static_cast<unsigned long long>(state.next_layer), state.clock));
  if (state.held_count > nozzle_.places.size() || std::uint64_t(state.held_first) + state.held_count > next_id)
    throw Error(LOAM_ERROR_INVALID_ARGUMENT, "a nozzle leads particles that never were");
  const auto most = static_cast<double>(nozzle_.places.size()) * static_cast<double>(state.next_layer);
  check_range("number of particles of a stream", static_cast<double>(state.entered) + static_cast<double>(state.dropped), 0,
              most);
}

std::uint64_t Emitter::hash(std::uint64_t hash) const {
  for (const std::uint64_t word : {std::bit_cast<std::uint64_t>(state_.clock), state_.next_layer, state_.entered,
                                   static_cast<std::uint64_t>(state_.held_first) << 32 | state_.held_count})
    hash = StateHash::mix(hash, word);
  return hash;
}

loam_emitter_id EmitterScene::add(Emitter emitter) {
  const loam_emitter_id id = table_.add(std::move(emitter));
  count_in_use();
  return id;
}

void EmitterScene::count_in_use() {
  in_use_ = 0;
  for_each([&](Emitter &) { ++in_use_; });
}

std::uint64_t EmitterScene::hash(std::uint64_t hash) const {
  for (std::size_t i = 0; i < table_.size(); ++i)
    if (const Emitter *e = table_.at_index(i); e != nullptr) hash = e->hash(hash);
  return hash;
}

void EmitterScene::advance(double seconds, ParticleSink &sink) {
  for_each([&](Emitter &e) { e.advance(seconds, next_id_, sink); });
}

} // namespace loam
