// The state as a list of arrays, out and in. Part of solver.h.
#pragma once

namespace loam {

template <class Executor> std::vector<StateSection> Solver<Executor>::state(std::uint64_t particles) {
  std::vector<StateSection> list;
  const auto add = [&](StateKind kind, auto &array, std::uint32_t stride, std::uint32_t saved,
                       std::uint32_t few_values = 0) {
    list.push_back({kind, 0, reinterpret_cast<std::byte *>(array.data()), stride, saved, particles, few_values});
  };
  add(StateKind::positions, now_.positions, 4, 3); // the true volume follows from the next two
  add(StateKind::log_volumes, now_.log_volumes, 1, 1);
  add(StateKind::rest_volumes, now_.rest_volumes, 1, 1, 1);
  add(StateKind::velocities, now_.velocities, 4, 4, 8);
  add(StateKind::strains, now_.strains, 6, 6);
  if (histories_in_use_) add(StateKind::histories, now_.histories, 1, 1, 1);
  if (drifts_in_use_) add(StateKind::drifts, now_.drifts, 3, 3);
  if (warm_start()) add(StateKind::stresses, stresses_, 6, 6);
  if (warm_start() && drifts_in_use_) add(StateKind::answered_drifts, answered_drifts_, 3, 3);
  if (settings_.sleep_speed > 0) add(StateKind::rests, now_.rests, 1, 1, 1);
  if (now_.ages.capacity() > 0) add(StateKind::ages, now_.ages, 1, 1, 1);
  if (displacements_in_use_) add(StateKind::displacements, now_.displacements, 1, 1, 1);
  add(StateKind::ids, now_.ids, 1, 1);
  add(StateKind::materials, now_.materials, 1, 1, 1);
  return list;
}

template <class Executor>
void Solver<Executor>::read_state(const StateSection &section, std::uint64_t first, std::size_t count,
                                  std::uint32_t *words) {
  const std::size_t size = std::size_t(4) * section.stride;
  executor_.download(reinterpret_cast<std::byte *>(words), section.data + first * size, count * size);
}

template <class Executor>
void Solver<Executor>::write_state(const StateSection &section, std::uint64_t first, std::size_t count,
                                   const std::uint32_t *words) {
  const std::size_t size = std::size_t(4) * section.stride;
  executor_.upload(section.data + first * size, reinterpret_cast<const std::byte *>(words), count * size);
}

template <class Executor> void Solver<Executor>::shift_origin(const Vec3<float> &by) {
  free_distances_hold_ = false;
  executor_.session([&] {
    executor_.for_each(count_, ShiftPositions{now_.positions.data(), by});
    cloth_.shift_origin(by);
  });
}

template <class Executor> void Solver<Executor>::adopt_state(std::uint64_t particles) {
  count_ = static_cast<int>(particles);
  awake_ = 1; // to be counted
  free_distances_hold_ = false;
  shapes_.for_each_deforming([](DeformingMesh<Executor> &mesh) { mesh.renew(); });
  executor_.session([&] {
    executor_.for_each(count_, RestoreVolumes{now_.positions.data(), now_.log_volumes.data(), now_.rest_volumes.data()});
  });
}

} // namespace loam
