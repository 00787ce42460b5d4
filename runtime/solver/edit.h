// The host's bulk edits, found by id. Part of solver.h. Nothing changes before all that may fail has been done.
#pragma once

namespace loam {

// Where the particles of these ids are. Throws Error INVALID_HANDLE for an id that no particle has, INVALID_ARGUMENT for one that is named twice.
template <class Executor>
std::vector<std::uint32_t> Solver<Executor>::places_of(const std::uint32_t *ids, std::size_t count) {
  struct Wanted {
    std::uint32_t id, at;
  };
  std::vector<Wanted> wanted(count);
  for (std::size_t k = 0; k < count; ++k) wanted[k] = {ids[k], static_cast<std::uint32_t>(k)};
  std::sort(wanted.begin(), wanted.end(),
            [](const Wanted &a, const Wanted &b) { return a.id < b.id || (a.id == b.id && a.at < b.at); });
  for (std::size_t k = 1; k < count; ++k)
    if (wanted[k].id == wanted[k - 1].id)
      throw Error(LOAM_ERROR_INVALID_ARGUMENT, format("ids[%u] is %u, as ids[%u] is; name each particle once", wanted[k].at,
                                                      wanted[k].id, wanted[k - 1].at));
  constexpr std::uint32_t nowhere = 0xffffffffu;
  std::vector<std::uint32_t> places(count, nowhere), present(static_cast<std::size_t>(count_));
  executor_.session([&] { executor_.download(present.data(), now_.ids.data(), present.size()); });
  for (std::size_t i = 0; i < present.size(); ++i) {
    const auto found = std::lower_bound(wanted.begin(), wanted.end(), present[i],
                                        [](const Wanted &a, std::uint32_t id) { return a.id < id; });
    if (found != wanted.end() && found->id == present[i]) places[found->at] = static_cast<std::uint32_t>(i);
  }
  for (std::size_t k = 0; k < count; ++k)
    if (places[k] == nowhere)
      throw Error(LOAM_ERROR_INVALID_HANDLE,
                  format("ids[%zu] is %u: no particle has this id; it was removed, or never given out", k, ids[k]));
  return places;
}

template <class Executor>
std::vector<std::uint64_t> Solver<Executor>::remove_particles(const std::uint32_t *ids, std::uint64_t count) {
  std::vector<std::uint64_t> removed(materials_.size(), 0);
  if (count == 0) return removed;
  std::vector<std::uint32_t> holes = places_of(ids, static_cast<std::size_t>(count));
  std::vector<std::uint32_t> materials(static_cast<std::size_t>(count_));
  executor_.session([&] { executor_.download(materials.data(), now_.materials.data(), materials.size()); });
  for (const std::uint32_t i : holes) ++removed[materials[i]];
  executor_.session([&] { fill_holes(holes); });
  return removed;
}

// Takes out the particles in these places, which it sorts. Within a session.
template <class Executor> void Solver<Executor>::fill_holes(std::vector<std::uint32_t> &holes) {
  std::sort(holes.begin(), holes.end());
  std::vector<std::uint32_t> &fillers = fillers_;
  fillers.clear();
  const auto left = static_cast<std::uint32_t>(count_) - static_cast<std::uint32_t>(holes.size());
  const auto behind = std::lower_bound(holes.begin(), holes.end(), left); // holes from here on are cut off
  auto hole = behind;
  for (std::uint32_t i = left; i < static_cast<std::uint32_t>(count_); ++i) {
    if (hole != holes.end() && *hole == i)
      ++hole;
    else
      fillers.push_back(i);
  }
  const int moved = static_cast<int>(fillers.size());
  executor_.upload(order_.data(), holes.data(), fillers.size());
  executor_.upload(keys_.data(), fillers.data(), fillers.size());
  executor_.for_each(moved, FillHoles{particle_arrays(), order_.data(), keys_.data()});
  count_ = static_cast<int>(left);
}

template <class Executor> void Solver<Executor>::set_motion(const ParticleMotion &motion) {
  const auto n = static_cast<std::size_t>(motion.count);
  if (n == 0) return;
  const std::vector<std::uint32_t> places = places_of(motion.ids, n);
  const auto rows = [n](const float *values) {
    std::vector<Row> list(values != nullptr ? n : 0);
    for (std::size_t i = 0; i < list.size(); ++i) list[i] = {values[3 * i], values[3 * i + 1], values[3 * i + 2], 0};
    return list;
  };
  const std::vector<Row> positions = rows(motion.positions), velocities = rows(motion.velocities);
  // The other copy of the particles and the sort's arrays hold nothing between steps.
  executor_.session([&] {
    executor_.upload(order_.data(), places.data(), n);
    executor_.upload(other_.positions.data(), positions.data(), positions.size());
    executor_.upload(other_.velocities.data(), velocities.data(), velocities.size());
    executor_.for_each(static_cast<int>(n),
                       SetMotion{particle_arrays(), order_.data(), positions.empty() ? nullptr : other_.positions.data(),
                                 velocities.empty() ? nullptr : other_.velocities.data()});
  });
}

} // namespace loam
