// The fluids' part of a substep. Part of solver.h.
#pragma once

namespace loam {

// How fluids meet everything, and behind that table the one of whose gradients reach whom.
template <class Executor>
void Solver<Executor>::meet_fluids(const std::vector<SolverMaterial> &materials, std::vector<float> &table) {
  const std::size_t n = materials.size();
  std::vector<float> reach(n * n), is_fluid(n);
  for (std::size_t m = 0; m < n; ++m) is_fluid[m] = std::holds_alternative<Fluid>(materials[m].law) ? 1.0f : 0.0f;
  for (std::size_t own = 0; own < n; ++own)
    for (std::size_t other = 0; other < n; ++other) {
      float &meeting = table[own * n + other];
      if (is_fluid[own] + is_fluid[other] > 0) meeting = Meetings::left_to_density;
      reach[own * n + other] = is_fluid[other] > 0 ? Meetings::gradients_shared : meeting;
    }
  table.insert(table.end(), reach.begin(), reach.end());
  copy_in(fluids_.is_fluid, is_fluid);
  std::vector<float> viscosities(n, -1.0f);
  bool viscous = false;
  for (std::size_t m = 0; m < n; ++m)
    if (const Fluid *fluid = std::get_if<Fluid>(&materials[m].law)) {
      viscosities[m] = fluid->density * fluid->kinematic_viscosity;
      viscous = viscous || (materials[m].in_use && fluid->kinematic_viscosity > 0.0f);
    }
  if (viscous) copy_in(fluids_.viscosities, viscosities);
}

template <class Executor> template <class F> void Solver<Executor>::for_each_fluid(F &&f) {
  for (int m = 0; m < static_cast<int>(materials_.size()); ++m)
    if (materials_[static_cast<std::size_t>(m)].in_use && is_fluid_material(m)) f(m);
}

// Memory for this substep, before anything changes.
template <class Executor> void Solver<Executor>::reserve_fluids() {
  const std::size_t rows = spare_row_ + executor_.spare_rows();
  if (contact_count_ > 0 && fluids_.walls.capacity() == 0) fluids_.walls.reserve(rows);
  const auto reserve = [&](Array<Row> &array) {
    if (array.capacity() > 0) return;
    array.reserve(rows);
    executor_.set(array.data(), static_cast<int>(rows), Row{0, 0, 0, 0});
  };
  if (schedule_.surface_tension >= 0) reserve(fluids_.surface);
  if (schedule_.vorticity_confinement >= 0) {
    reserve(fluids_.vortex_marks);
    reserve(fluids_.vorticity);
  }
  if (schedule_.viscosity >= 0)
    for (Array<Row> &marks : fluids_.marks) reserve(marks);
}

// After prepare_fluids(), which leaves the gradients that surfaces are known by.
template <class Executor> void Solver<Executor>::pull_surfaces() {
  const float r = settings_.kernel_radius;
  // So much of what a particle's inertia could carry in a substep: a quarter more flies apart.
  constexpr float carried = 0.1f;
  executor_.for_each(count_, ClearSurface{now_.materials.data(), fluids_.is_fluid.data(), fluids_.surface.data()});
  for_each_fluid([&](int m) {
    const Fluid &fluid = std::get<Fluid>(materials_[static_cast<std::size_t>(m)].law);
    const float tension = std::min(fluid.kinematic_surface_tension, carried * r * (r / h_) * (r / h_));
    executor_.for_each_particle_of(m, now_.velocities.data(),
                                   FindSurface{surface_calibration * fluid.density * tension, 0.1f / r,
                                               carried * fluid.density * (r / h_) * (r / h_), fluids_.surface.data()});
  });
  const PullSurface pull = {now_.positions.data(), fluids_.surface.data(), 1.0f / r, 8.0f * h_ / (r * r * r * r * r)};
  for_each_fluid([&](int m) { executor_.for_each_particle_of(m, now_.velocities.data(), pull); });
  lap(schedule_.surface_tension, particles());
}

// Velocities are diffused between this copy of them and the other.
template <class Executor> void Solver<Executor>::diffuse_velocities() {
  const float r = settings_.kernel_radius;
  // Disordered fluid is a little stiffer than the lattice. More stages than this carry no more than is visible in so long a substep.
  constexpr float disorder = 1.3f;
  constexpr int most_stages = 16;
  const auto carried = [](int stages) { return static_cast<float>(stages * stages + stages); };
  const float rate = 2.0f * disorder * fluids_.calibration.viscous_rate * h_ / (r * r);
  const float greatest = carried(most_stages) / rate;
  int stages = 1;
  while (stages < most_stages && carried(stages) < rate * fluids_.viscosity) ++stages;

  executor_.for_each(count_,
                     MarkViscosity{now_.materials.data(), fluids_.viscosities.data(), now_.positions.data(),
                                   now_.velocities.data(), greatest, fluids_.marks[0].data(), fluids_.marks[1].data()});
  ViscousPair pair = {now_.positions.data(), fluids_.marks[0].data(), kernel_, fluids_.calibration.viscous_scale * h_,
                      viscous_softening * r * r};
  executor_.for_each_particle(now_.velocities.data(), MeasureViscosity{pair, fluids_.marks[1].data()});
  pair.marks = fluids_.marks[1].data();
  executor_.copy(other_.velocities.data(), now_.velocities.data(), static_cast<std::size_t>(count_));
  for (int j = 1; j <= stages; ++j) {
    const float share = static_cast<float>(2 * j - 1) / static_cast<float>(j);
    executor_.for_each_particle(now_.velocities.data(),
                                DiffuseVelocities{pair, 0.5f * carried(stages), share, 1.0f - share,
                                                  2.0f * share / carried(stages), other_.velocities.data()});
    now_.velocities.swap(other_.velocities);
  }
  lap(schedule_.viscosity, particles() * static_cast<std::uint64_t>(stages));
}

template <class Executor> void Solver<Executor>::prepare_fluids() {
  const float r = settings_.kernel_radius;
  if (contact_count_ > 0) {
    executor_.set(fluids_.walls.data(), static_cast<int>(spare_row_ + executor_.spare_rows()), Row{0, 0, 0, 0});
    executor_.for_each(contact_count_, CountWalls{contacts_.data(), fluids_.walls.data(), 0.5f * r, 0.5f / r,
                                                  fluids_.calibration.wall_value, fluids_.calibration.wall_slope});
  }
  // Displacements undo half of a compression in a substep, at most this much, and no more than this much a second: more would overshoot, and what was lifted
  // that way would fall, and boil.
  constexpr float share_at_once = 0.5f, most_at_once = 0.03f, most_per_second = 20.0f;
  // Their multipliers are forgotten within about this time, or in few iterations they would overshoot too.
  constexpr float memory = 1.0f / 120.0f;
  // Without it, what displacements push a hair below the rest density falls freely in the next substep, and loses its pressure.
  constexpr float tolerance = 0.005f;
  for_each_fluid([&](int m) {
    executor_.for_each_particle_of(
        m, now_.velocities.data(),
        PrepareFluid{now_.positions.data(), now_.velocities.data(), now_.histories.data(), now_.displacements.data(),
                     neighbour_counts_.data(), close_counts_.data(), contact_count_ > 0 ? fluids_.walls.data() : nullptr,
                     now_.strains.data(), kernel_, h_, fluids_.calibration.per_calibration,
                     0.1f * fluids_.calibration.full_response, std::min(most_at_once, most_per_second * h_), share_at_once,
                     memory / (memory + h_), tolerance, 1.0f / fluids_.calibration.slope});
  });
  lap(schedule_.prepare_fluids, particles());
}

template <class Executor> template <class F> void Solver<Executor>::for_each_confined(F &&f) {
  for_each_fluid([&](int m) {
    const Fluid &fluid = std::get<Fluid>(materials_[static_cast<std::size_t>(m)].law);
    if (fluid.vorticity_confinement > 0.0f)
      f(m, fluid, VortexPair{now_.positions.data(), fluids_.vortex_marks.data(), kernel_, static_cast<float>(m)});
  });
}

// After prepare_fluids().
template <class Executor> void Solver<Executor>::mark_compression(const Vec3<float> &gravity) {
  executor_.for_each(count_, ClearVorticity{now_.materials.data(), fluids_.vortex_marks.data(), fluids_.vorticity.data()});
  for_each_confined([&](int m, const Fluid &, const VortexPair &) {
    executor_.for_each_particle_of(m, now_.velocities.data(), MarkCompression{h_ * gravity, fluids_.vortex_marks.data()});
  });
  lap(schedule_.vorticity_confinement, 0);
}

// After the solve. The sources stand where the other copy of the velocities is.
template <class Executor> void Solver<Executor>::confine_vorticity() {
  constexpr float strength = 4; // more feeds what shakes
  const float r = settings_.kernel_radius, curl = fluids_.calibration.curl;
  Row *sources = other_.velocities.data();
  executor_.set(sources, count_, Row{0, 0, 0, 0});
  for_each_confined([&](int m, const Fluid &, const VortexPair &pair) {
    executor_.for_each_particle_of(m, now_.velocities.data(), MeasureVorticity{pair, curl, fluids_.vorticity.data()});
  });
  for_each_confined([&](int m, const Fluid &fluid, const VortexPair &pair) {
    executor_.for_each_particle_of(m, now_.velocities.data(),
                                   WeighVorticity{pair, fluids_.vorticity.data(), strength * r * r,
                                                  fluid.vorticity_confinement / (h_ * fluid.density), h_ / (r * r),
                                                  sources});
  });
  for_each_confined([&](int m, const Fluid &fluid, const VortexPair &pair) {
    executor_.for_each_particle_of(m, now_.velocities.data(), ConfineVorticity{pair, sources, curl * h_ * fluid.density});
  });
  lap(schedule_.vorticity_confinement, particles());
}

// One round over the fluids' constraints, of the velocities or what stands in their place.
template <class Executor> template <FluidTurn Turn> void Solver<Executor>::solve_fluids_at_once(const JacobiRows &rows) {
  using Impulse = FluidImpulse<Turn>;
  constexpr float fluid_relaxation = 0.5f; // particles share neighbours: all at once would overshoot
  for_each_fluid([&](int m) {
    executor_.for_each_particle_of(m, now_.velocities.data(),
                                   Impulse{{h_, fluid_relaxation}, fluids_.calibration.per_calibration, rows});
  });
}

// For Jacobi: rounds of fluids alone.
template <class Executor> JacobiRows Solver<Executor>::empty_jacobi_rows() {
  const JacobiRows rows = jacobi_rows();
  for (int j = 0; j < 3; ++j) {
    executor_.set(rows.column[j], count_, Row{0, 0, 0, 0});
    if (rows.along_drift[j] != nullptr) executor_.set(rows.along_drift[j], count_, Row{0, 0, 0, 0});
  }
  return rows;
}

template <class Executor> template <class Stage> void Solver<Executor>::solve_fluids_in_turn(const Stage &stage) {
  for (int pass = 0; pass < executor_.pass_count(); ++pass)
    if (is_fluid_material(executor_.pass_material(pass))) executor_.for_each_block(pass, now_.velocities.data(), stage);
}

// The iterations start from the pressure of the last substep.
template <class Executor> void Solver<Executor>::start_fluids() {
  if (settings_.jacobi) {
    const JacobiRows rows = empty_jacobi_rows();
    solve_fluids_at_once<FluidTurn::start>(rows);
    apply_at_once(rows);
  } else {
    solve_fluids_in_turn(StartFluid<FluidMotion::velocities>{});
  }
  lap(schedule_.prepare_fluids, 0);
}

// After all that changes velocities: `now_.velocities` becomes what particles move by, until finish_displacements().
template <class Executor> void Solver<Executor>::displace_fluids(const StepInput &input) {
  executor_.for_each(count_,
                     StartDisplacements{now_.velocities.data(), now_.materials.data(), fluids_.is_fluid.data(),
                                        schedule_.sleep >= 0 ? now_.rests.data() : nullptr, other_.velocities.data()});
  now_.velocities.swap(other_.velocities);
  const auto keep_out = [&] {
    if (contact_count_ > 0)
      executor_.for_each(contact_count_, KeepDisplacementsOut{contacts_.data(), now_.velocities.data(), h_});
  };
  JacobiRows rows = {};
  if (settings_.jacobi) {
    rows = empty_jacobi_rows();
    solve_fluids_at_once<FluidTurn::start_displacements>(rows);
    apply_at_once(rows);
  } else {
    solve_fluids_in_turn(StartFluid<FluidMotion::displacements>{});
  }
  keep_out();
  for (std::uint32_t i = 0; i < iterations_done_; ++i) {
    if (settings_.jacobi) {
      solve_fluids_at_once<FluidTurn::displacements>(rows);
      apply_at_once(rows);
    } else {
      solve_fluids_in_turn(SolveFluid<FluidMotion::displacements>{{h_, 1.0f}});
    }
    keep_out();
  }
  for_each_fluid([&](int m) {
    executor_.for_each_particle_of(m, now_.velocities.data(),
                                   KeepMultipliers{now_.histories.data(), now_.displacements.data()});
  });
  const float per_substep = settings_.kernel_radius / h_;
  executor_.for_each(count_, LimitDisplacements{other_.velocities.data(), now_.strains.data(), now_.ids.data(),
                                                now_.velocities.data(), 0.25f * per_substep, per_substep});
  keep_out();
  if (schedule_.cloth_particles >= 0) cloth_.sweep_particles(cloth_substep(input), false);
  if (contact_count_ > 0) sweep_contacts();
  lap(schedule_.displace_fluids, particles());
}

template <class Executor> void Solver<Executor>::finish_displacements() { now_.velocities.swap(other_.velocities); }

// A view's densities, of fluid.
template <class Executor>
void Solver<Executor>::measure_fluids(const std::uint32_t *materials, const float *strains, float *densities) {
  if (fluids_.in_use) executor_.for_each(count_, FluidDensities{fluids_.is_fluid.data(), materials, strains, densities});
}

} // namespace loam
