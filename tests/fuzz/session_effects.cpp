/* Streams. */
#include "session_actions.h"

namespace loam::fuzz {

void Session::change_emitters(Random &random) {
  if (now_.materials.empty()) return;
  if (now_.emitters.size() > 2 || (!now_.emitters.empty() && random.chance(0.4))) {
    const std::size_t which = random.below(now_.emitters.size());
    const loam_emitter_id id = now_.emitters[which].id;
    if (!call("destroy emitter", mapped_ ? Expect::in_use : Expect::success,
              [&] { return loam_emitter_destroy(world_, id); }))
      return;
    ++description_;
    stale_.push_back(id);
    now_.emitters.erase(now_.emitters.begin() + std::ptrdiff_t(which));
    return;
  }
  meshes::Mesh mesh;
  loam_emitter_def def = random_emitter(random, def_.kernel_radius, mesh);
  def.material = any_material(random);
  const bool bad = random.chance(0.2);
  if (bad) spoil(def, random);
  loam_emitter_id id = 0;
  if (!call("create emitter",
            bad       ? Expect::failure
            : mapped_ ? Expect::in_use
                      : Expect::anything,
            [&] { return loam_emitter_create(world_, &def, &id); }))
    return;
  ++description_;
  now_.emitters.push_back(
      {id, 0, def.when_full == LOAM_FULL_TELL, double(def.speed) + std::sqrt(3.0) * double(def.velocity_jitter)});
}

bool Session::a_stream_tells() const {
  return std::any_of(now_.emitters.begin(), now_.emitters.end(), [](const Emitter &emitter) { return emitter.tells; });
}

/* What streams did in a step, whole or not. */
void Session::count_effects() {
  for (Emitter &emitter : now_.emitters) {
    loam_emitter_report report = {};
    report.struct_size = sizeof report;
    judge("emitter's report", Expect::success, loam_emitter_get_report(world_, emitter.id, &report));
    if (report.entered < emitter.entered || !(report.volume > 0) || !(report.volume_flow > 0)) find("an emitter's report");
    born(report.entered - emitter.entered, true);
    emitter.entered = report.entered;
  }
}

} // namespace loam::fuzz
