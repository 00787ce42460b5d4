/* Streams, fields and killers. */
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

void Session::change_fields(Random &random) {
  loam_field_def def = random_field(random, def_.kernel_radius);
  const bool bad = random.chance(0.2);
  if (bad) spoil(def, random);
  const Expect expect = bad ? Expect::invalid : Expect::success;
  if (now_.fields.empty() || random.chance(0.3)) {
    loam_field_id id = 0;
    if (!call("create field", expect, [&] { return loam_field_create(world_, &def, &id); })) return;
    ++description_;
    now_.fields.push_back(id);
    return;
  }
  const std::size_t which = random.below(now_.fields.size());
  const loam_field_id id = now_.fields[which];
  if (random.chance(0.5)) {
    if (call("set field", expect, [&] { return loam_field_set(world_, id, &def); })) ++description_;
  } else if (call("destroy field", Expect::success, [&] { return loam_field_destroy(world_, id); })) {
    ++description_;
    stale_.push_back(id);
    now_.fields.erase(now_.fields.begin() + std::ptrdiff_t(which));
  }
}

void Session::change_killers(Random &random) {
  loam_killer_def def = random_killer(random, def_.kernel_radius);
  const bool bad = random.chance(0.2);
  if (bad) spoil(def, random);
  const Expect expect = bad ? Expect::failure : mapped_ ? Expect::in_use : Expect::success;
  if (now_.killers.empty() || random.chance(0.2)) {
    loam_killer_id id = 0;
    if (!call("create killer", expect, [&] { return loam_killer_create(world_, &def, &id); })) return;
    ++description_;
    now_.killers.push_back({id, 0});
    return;
  }
  const std::size_t which = random.below(now_.killers.size());
  const loam_killer_id id = now_.killers[which].id;
  if (random.chance(0.3)) {
    if (call("set killer", expect, [&] { return loam_killer_set(world_, id, &def); })) ++description_;
  } else if (call("destroy killer", mapped_ ? Expect::in_use : Expect::success,
                  [&] { return loam_killer_destroy(world_, id); })) {
    ++description_;
    stale_.push_back(id);
    now_.killers.erase(now_.killers.begin() + std::ptrdiff_t(which));
  }
}

/* What streams and killers did in a step, whole or not. */
void Session::count_effects() {
  for (Emitter &emitter : now_.emitters) {
    loam_emitter_report report = {};
    report.struct_size = sizeof report;
    judge("emitter's report", Expect::success, loam_emitter_get_report(world_, emitter.id, &report));
    if (report.entered < emitter.entered || !(report.volume > 0) || !(report.volume_flow > 0)) find("an emitter's report");
    born(report.entered - emitter.entered, true);
    emitter.entered = report.entered;
  }
  for (Killer &killer : now_.killers) {
    std::uint64_t total = 0, count = 0;
    std::vector<std::uint32_t> ids(now_.count);
    judge("killed", Expect::success, loam_killer_get_killed(world_, killer.id, &total, ids.data(), ids.size(), &count));
    if (total == killer.total) continue; // its list may be that of a step before
    if (total - killer.total != count || count > ids.size()) find("a killer's count");
    for (std::size_t i = 0; i < std::min<std::size_t>(count, ids.size()); ++i) {
      if (ids[i] >= now_.particles.size() || !now_.particles[ids[i]].here) {
        find("the particle %u was killed and was not there", ids[i]);
        continue;
      }
      now_.particles[ids[i]].here = false;
      --now_.count;
    }
    killer.total = total;
  }
}

} // namespace loam::fuzz
