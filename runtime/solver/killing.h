// What killers do at the end of a step. Part of solver.h.
#pragma once

namespace loam {

template <class Executor> void Solver<Executor>::keep_ages(bool keep) {
  if (!keep) {
    now_.ages.free();
    other_.ages.free();
    return;
  }
  if (now_.ages.capacity() > 0) return;
  Array<float> now = executor_.template array<float>(), other = executor_.template array<float>(); // both or none
  now.reserve(static_cast<std::size_t>(settings_.particle_capacity));
  other.reserve(static_cast<std::size_t>(settings_.particle_capacity));
  executor_.set(now.data(), count_, 0.0f);
  now_.ages.swap(now);
  other_.ages.swap(other);
}

// Throws Error OUT_OF_MEMORY.
template <class Executor> void Solver<Executor>::prepare_killers(const StepInput &input) {
  if (input.killers.empty()) {
    killer_views_.free();
    return;
  }
  killed_.killers.clear();
  for (const KillerState &killer : input.killers) killed_.killers.push_back(killer.view);
  if (killer_views_.capacity() < killed_.killers.size()) killer_views_.reserve(killed_.killers.size());
  executor_.upload(killer_views_.data(), killed_.killers.data(), killed_.killers.size());
}

// The sort's arrays and the other copy of the particles hold nothing between substeps.
template <class Executor> void Solver<Executor>::kill(const StepInput &input) {
  if (input.killers.empty()) return;
  Executor &ex = executor_;
  if (now_.ages.capacity() > 0) ex.for_each(count_, AgeParticles{now_.ages.data(), input.seconds});
  ex.set(counters_.data() + 2, 1, 0);
  ex.for_each(count_, FindKilled{now_.positions.data(), now_.materials.data(),
                                 now_.ages.capacity() > 0 ? now_.ages.data() : nullptr, killer_views_.data(),
                                 static_cast<int>(input.killers.size()), order_.data(), keys_.data(), counters_.data() + 2});
  const auto n = static_cast<std::size_t>(ex.read(counters_.data() + 2));
  if (n > 0) {
    auto &[killers, places, killer_of, ids, materials] = killed_;
    for (std::vector<std::uint32_t> *list : {&places, &killer_of, &ids, &materials}) list->resize(n);
    ex.download(places.data(), order_.data(), n);
    ex.download(killer_of.data(), keys_.data(), n);
    ex.for_each(static_cast<int>(n), NameKilled{order_.data(), now_.ids.data(), now_.materials.data(), other_.ids.data(),
                                                other_.materials.data()});
    ex.download(ids.data(), other_.ids.data(), n);
    ex.download(materials.data(), other_.materials.data(), n);
    for (std::size_t i = 0; i < n; ++i) {
      input.killers[killer_of[i]].killed->push_back(ids[i]);
      ++(*input.removed)[materials[i]];
    }
    for (const KillerState &killer : input.killers) std::sort(killer.killed->begin(), killer.killed->end());
    fill_holes(places);
    statistics_.particles_killed = n;
    if (schedule_.sleep >= 0) { // who lay on them falls
      const float r = settings_.kernel_radius, infinity = std::numeric_limits<float>::infinity();
      for (const KillerState &killer : input.killers) {
        if (killer.killed->empty()) continue;
        const KillerView &view = killer.view;
        const float extent = view.kind == KillerKind::sphere ? view.radius : length(view.half_extents);
        const bool bounded = view.kind != KillerKind::age && !view.outside;
        ex.for_each(count_, WakeWithin{now_.positions.data(), now_.rests.data(), view.pose.position,
                                       bounded ? extent + 2.0f * r : infinity});
      }
      awake_ = 1;
    }
  }
  lap(schedule_.killers, n);
}

} // namespace loam
