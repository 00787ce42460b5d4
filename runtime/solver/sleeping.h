// What the solver does for matter that sleeps; see kernels/integration/sleep.h. Part of solver.h.
#pragma once

namespace loam {

template <class Executor> void Solver<Executor>::wake_all() {
  const float infinity = std::numeric_limits<float>::infinity();
  executor_.for_each(count_, WakeWithin{now_.positions.data(), now_.rests.data(), {}, infinity});
  awake_ = 1;
}

// Wakes what colliders move near, and tells whether nothing is awake: then there is nothing to do in this substep.
template <class Executor> bool Solver<Executor>::all_asleep(const StepInput &input, std::uint32_t index) {
  const float r = settings_.kernel_radius;
  for (const ColliderState &collider : input.colliders) {
    const Pose start = interpolate(collider.start, collider.end, static_cast<double>(index) / input.substeps);
    const Pose end = interpolate(collider.start, collider.end, static_cast<double>(index + 1) / input.substeps);
    ColliderView view = {};
    view.start = start;
    view.end = end;
    if (at_rest(view) && !shapes_.moves(collider.shape)) continue;
    const float extent = shapes_.extent(collider.shape);
    const Vec3<float> way = end.position - start.position;
    executor_.for_each(count_,
                       WakeWithin{now_.positions.data(), now_.rests.data(), end.position, extent + length(way) + 2.0f * r});
    awake_ = 1;
  }
  if (awake_ > 0) awake_ = executor_.reduce(count_, CountAwake{now_.velocities.data(), now_.rests.data()});
  lap(schedule_.sleep, particles());
  return awake_ == 0;
}

template <class Executor> void Solver<Executor>::find_active_cells() {
  const int cells = table_.grid.cell_count();
  const auto room = static_cast<std::size_t>(cells);
  if (room > active_cells_.capacity()) {
    awake_cells_.reserve(room + room / 4);
    near_cells_.reserve(room + room / 4);
    active_cells_.reserve(room + room / 4);
  }
  executor_.for_each(cells,
                     MarkAwakeCells{cell_starts_.data(), now_.velocities.data(), now_.rests.data(), awake_cells_.data()});
  const auto mark_beside = [&](const Array<std::uint8_t> &marked, Array<std::uint8_t> &result) {
    executor_.for_each(cells, MarkCellsBeside{table_.grid, cell_starts_.data(), marked.data(), result.data()});
  };
  mark_beside(awake_cells_, active_cells_);
  mark_beside(active_cells_, near_cells_);
  mark_beside(near_cells_, active_cells_);
  table_.active_cells = active_cells_.data();
  executor_.for_each(count_, PinSleepers{keys_.data(), near_cells_.data(), now_.velocities.data(), now_.rests.data()});
  lap(schedule_.sleep, 0);
}

template <class Executor> void Solver<Executor>::fall_asleep() {
  executor_.for_each_particle(now_.velocities.data(),
                              LookAround{now_.rests.data(), settings_.sleep_speed, 2.0f * settings_.sleep_speed});
  executor_.for_each(
      count_, FallAsleep{now_.velocities.data(), now_.rests.data(), settings_.sleep_speed, settings_.sleep_delay, h_});
  lap(schedule_.sleep, 0);
}

} // namespace loam
