// One substep, as algorithm 1 of the XPBI paper has it. Part of solver.h.
#pragma once

namespace loam {

template <class Executor> void Solver<Executor>::substep(const StepInput &input, std::uint32_t index) {
  Executor &ex = executor_;
  h_ = input.seconds / static_cast<float>(input.substeps);
  const bool last = index + 1 == input.substeps;

  if (count_ > 0) search_neighbours(); // sort by cell; lists, corrected gradients and constraint records on x^n
  const float greatest_start_speed = greatest_start * settings_.kernel_radius / h_;
  ex.for_each(count_, ApplyForces{now_.velocities.data(), h_ * input.gravity, greatest_start_speed, counters_.data()});
  lap(schedule_.forces, particles());
  if (schedule_.fields >= 0) {
    fields_.apply(count_, now_.positions.data(), now_.velocities.data(), index, true, greatest_start_speed,
                  counters_.data());
    lap(schedule_.fields, particles());
  }
  try {
    prepare_contacts(input, index);
    if (fluids_.in_use) reserve_fluids();
    if (schedule_.convergence >= 0)
      convergence_.reserve(static_cast<std::size_t>(settings_.particle_capacity) + cloth_.row_count());
    if (!cloth_.empty()) {
      cloth_.find_contacts(cloth_substep(input));
      if (schedule_.find_cloth_contacts >= 0) lap(schedule_.find_cloth_contacts, cloth_.vertex_count());
    }
  } catch (...) {
    // Memory for contacts was refused. Back to before the forces: the other copy still has the motion as it was before the sort.
    ex.for_each(count_, RestoreMotion{other_.velocities.data(), other_.free_distances.data(), now_.velocities.data(),
                                      now_.free_distances.data(), order_.data()});
    throw;
  }

  // Stages that write another copy of the velocities write those of visited particles only.
  if (schedule_.sleep >= 0) ex.copy(other_.velocities.data(), now_.velocities.data(), static_cast<std::size_t>(count_));
  if (!cloth_.empty()) {
    cloth_.prepare(cloth_substep(input), counters_.data());
    lap(schedule_.prepare_cloth, cloth_.constraint_count());
    if (schedule_.fields >= 0) {
      cloth_.for_each_sheet([&](int vertices, const Row *positions, Row *velocities) {
        fields_.apply(vertices, positions, velocities, index, false, unlimited_speed, counters_.data());
      });
      lap(schedule_.fields, cloth_.vertex_count());
    }
  }

  if constexpr (fluid_is_built) {
    if (fluids_.in_use && count_ > 0) {
      if (schedule_.viscosity >= 0) diffuse_velocities();
      prepare_fluids();
      if (schedule_.vorticity_confinement >= 0) mark_compression(input.gravity);
      if (schedule_.surface_tension >= 0) pull_surfaces();
    }
  }
  const auto bodies = [this](auto &&f) { for_each_body(f); };
  if (schedule_.convergence >= 0) convergence_.begin(bodies);
  if constexpr (fluid_is_built) {
    if (fluids_.in_use && count_ > 0) start_fluids();
  }

  if (schedule_.warm_start >= 0 && count_ > 0) start_inelastic(input.iterations);
  iterate(input);
  if (last && count_ > 0) measure(input.gravity);

  if (schedule_.velocity_smoothing >= 0 && count_ > 0) {
    // A share of 1 would be a step to the neighbours' mean; more overshoots.
    const float coefficient = std::min(1.0f, settings_.velocity_smoothing * h_);
    Row *smoothed = other_.velocities.data();
    for_each_particle_meeting([&](const Meetings &meetings) {
      return SmoothVelocities{now_.positions.data(), smoothed, kernel_, coefficient, meetings};
    });
    now_.velocities.swap(other_.velocities);
    lap(schedule_.velocity_smoothing, particles());
  }
  if constexpr (fluid_is_built) {
    if (schedule_.vorticity_confinement >= 0 && count_ > 0) confine_vorticity();
  }
  ex.for_each(count_, LimitSpeed{now_.velocities.data(), settings_.kernel_radius / h_, counters_.data()});
  lap(schedule_.speed_limit, particles());
  if (!cloth_.empty()) {
    cloth_.finish(cloth_substep(input), counters_.data(), reactions_.view(nullptr, collider_views_.data(), last));
    // Light particles between heavy cloths may have been thrown.
    if (schedule_.cloth_particles >= 0)
      ex.for_each(count_, LimitSpeed{now_.velocities.data(), settings_.kernel_radius / h_, counters_.data()});
    lap(schedule_.finish_cloth, cloth_.vertex_count());
  }
  if (contact_count_ > 0)
    ex.for_each(contact_count_, SolveContactsWithinLimit{{contacts_.data(), now_.velocities.data(), h_},
                                                         settings_.kernel_radius / h_,
                                                         counters_.data()});
  // After the contacts, which take back what they gave against what is changed here; before the sweep, for colliders let nothing pass.
  if (schedule_.cloth_particles >= 0) cloth_.sweep_particles(cloth_substep(input));
  if (contact_count_ > 0) {
    const Reactions reactions = reactions_.view(now_.positions.data(), collider_views_.data(), last);
    if (reactions_.any()) ex.for_each(contact_count_, AddReactions{contacts_.data(), now_.velocities.data(), reactions});
    sweep_contacts(reactions);
    lap(schedule_.final_contacts, static_cast<std::uint64_t>(contact_count_));
  }

  if (schedule_.sleep >= 0) {
    ex.for_each(count_, HoldSleepers{now_.velocities.data(), now_.rests.data()});
    lap(schedule_.sleep, 0);
  }

  // Strain and position with the same velocity.
  for (int m = 0; m < static_cast<int>(materials_.size()); ++m) {
    const int stage = schedule_.strain[static_cast<std::size_t>(m)];
    if (stage < 0 || count_ == 0) continue;
    with_law(m, [&](const auto &law, StrainLimit limit) {
      using Law = std::remove_cvref_t<decltype(law)>;
      if constexpr (!is_fluid<Law>()) {
        const auto update = [&](auto non_affine) {
          ex.for_each_particle_of(m, now_.velocities.data(),
                                  UpdateStrain<Law, non_affine.value>{
                                      law, limit, h_, now_.strains.data(), now_.histories.data(), now_.log_volumes.data(),
                                      now_.drifts.data(), drift_stiffness(), stresses_.data(), answered_drifts_.data(),
                                      neighbour_counts_.data(), counters_.data() + 1, counters_.data() + 3});
        };
        if (settings_.projected_tensor)
          update(std::bool_constant<Law::resists_zero_energy_modes>());
        else
          update(std::false_type());
      }
    });
    lap(stage, particles());
  }
  const bool displaced = fluids_.in_use && count_ > 0;
  if constexpr (fluid_is_built) {
    if (displaced) displace_fluids(input);
  }
  if (now_.free_distances.capacity() > 0) {
    ex.for_each(count_, SpendFreeDistances{now_.free_distances.data(), now_.positions.data(), now_.velocities.data(), h_,
                                           collider_motion_.greatest()});
    free_distances_hold_ = true;
    lap(schedule_.find_contacts, 0);
  }
  ex.for_each(count_,
              Advance{now_.positions.data(), now_.velocities.data(), now_.log_volumes.data(), now_.rest_volumes.data(), h_});
  if (displaced) finish_displacements();
  lap(schedule_.advance, particles());
  if (!cloth_.empty()) {
    cloth_.advance(cloth_substep(input));
    cloth_.tear(h_);
    lap(schedule_.finish_cloth, cloth_.vertex_count());
  }
  if (schedule_.sleep >= 0 && count_ > 0) fall_asleep();
}

template <class Executor> void Solver<Executor>::sweep_contacts(const Reactions &reactions) {
  const float margin = 0.05f * 0.5f * settings_.kernel_radius;
  with_deforming(deforms_, [&](auto deforms) {
    executor_.for_each(contact_count_, SweepContactsOf<deforms.value>{
                                           contacts_.data(), now_.positions.data(), now_.velocities.data(),
                                           collider_views_.data(), static_cast<int>(views_.size()), h_, margin, reactions});
  });
}

template <class Executor> typename Solver<Executor>::ClothSubstep Solver<Executor>::cloth_substep(const StepInput &input) {
  return {h_,
          input.gravity,
          collider_views_.data(),
          static_cast<int>(views_.size()),
          collider_motion_.greatest(),
          deforms_,
          {now_.positions.data(), now_.velocities.data(), count_, static_cast<int>(settings_.particle_capacity),
           settings_.kernel_radius}};
}

// Iterations of matter start from the last substep's stress.
template <class Executor> void Solver<Executor>::start_inelastic(std::uint32_t iterations) {
  const float inverse_radius = 1 / settings_.kernel_radius, most = static_cast<float>(iterations);
  const auto with_start = [&](int m, auto &&f) {
    const float density = materials_[static_cast<std::size_t>(m)].density;
    with_constraint(m, [&](const auto &law, StrainLimit, const auto &multiplier) {
      using Law = std::remove_cvref_t<decltype(law)>;
      using Form = std::remove_cvref_t<decltype(multiplier)>;
      const float wave_speed = std::sqrt((law.bulk() + 2.0f / 3.0f * law.twice_mu()) / density);
      if (wave_speed * h_ * inverse_radius > radii_per_iteration * most) return; // all of it starts from zero
      if constexpr (std::is_same_v<Form, TensorOf<Law>>)
        f(WarmStart<Law, Form>{law, h_, multiplier, stresses_.data(), answered_drifts_.data(), inverse_radius, most});
    });
  };
  for (int pass = 0; pass < executor_.pass_count(); ++pass)
    with_start(executor_.pass_material(pass), [&]<class Law, class Form>(const WarmStart<Law, Form> &start) {
      executor_.for_each_block(pass, now_.velocities.data(), StartInelastic<Law, Form>{start});
    });
  lap(schedule_.warm_start, particles());
}

// The nonlinear iterations: as many as asked for, or until they have converged.
template <class Executor> void Solver<Executor>::iterate(const StepInput &input) {
  if (schedule_.convergence < 0) {
    for (; iterations_done_ < input.iterations; ++iterations_done_) iterate_once(input);
    return;
  }
  const auto bodies = [this](auto &&f) { for_each_body(f); };
  const double fall = static_cast<double>(h_ * length(input.gravity));
  while (iterations_done_ < input.iterations && !(iterations_done_ > 1 && convergence_.error() <= input.tolerance)) {
    convergence_.begin_iteration(bodies);
    lap(schedule_.convergence, 0);
    iterate_once(input);
    ++iterations_done_;
    convergence_.end_iteration(bodies, fall);
    lap(schedule_.convergence, particles() + cloth_.vertex_count());
  }
  statistics_.solution_error = std::max(statistics_.solution_error, convergence_.error());
  if (convergence_.error() > input.tolerance) ++statistics_.substeps_unsolved;
}

template <class Executor> template <class F> void Solver<Executor>::for_each_body(F &&f) {
  if (count_ > 0) f(count_, now_.velocities.data());
  cloth_.for_each_sheet([&](int vertices, const Row *, Row *velocities) { f(vertices, velocities); });
}

template <class Executor> double Solver<Executor>::greatest_speed() {
  float speed = 0;
  executor_.session([&] {
    for_each_body([&](int count, const Row *velocities) {
      speed = std::max(speed, executor_.reduce(count, GreatestSpeedBeside{velocities, {0, 0, 0}}));
    });
  });
  return static_cast<double>(speed);
}

// Inelastic constraints and fluids, position correction, cloth, contacts.
template <class Executor> void Solver<Executor>::iterate_once(const StepInput &input) {
  // Without particles, lists and visits are those of a substep that had some.
  if (count_ > 0) {
    if (settings_.jacobi) {
      solve_at_once();
    } else {
      solve_in_turn();
    }
    if (schedule_.position_correction >= 0) correct_positions();
  }
  if (!cloth_.empty()) {
    cloth_.solve(cloth_substep(input));
    lap(schedule_.solve_cloth, cloth_.constraint_count());
    if (schedule_.cloth_self_contact >= 0) {
      cloth_.solve_self_contacts(cloth_substep(input));
      lap(schedule_.cloth_self_contact, cloth_.self_contact_count());
    }
    if (schedule_.cloth_particles >= 0) {
      cloth_.solve_particle_contacts(cloth_substep(input));
      lap(schedule_.cloth_particles, cloth_.particle_contact_count());
    }
  }
  if (contact_count_ > 0) {
    executor_.for_each(contact_count_, SolveContacts{contacts_.data(), now_.velocities.data(), h_});
    lap(schedule_.contacts, static_cast<std::uint64_t>(contact_count_));
  }
  if (schedule_.cloth_contacts >= 0) {
    cloth_.solve_contacts(cloth_substep(input));
    lap(schedule_.cloth_contacts, cloth_.contact_count());
  }
}

// For semi-implicit plasticity, matter is elastic inside the loop.
template <class Executor> template <class F> void Solver<Executor>::with_constraint(int material, F &&f) {
  with_law(material, [&](const auto &law, StrainLimit limit) {
    using Law = std::remove_cvref_t<decltype(law)>;
    if constexpr (!is_fluid<Law>()) {
      const auto with_form = [&](const auto &multiplier) {
        if (settings_.semi_implicit)
          f(Elastic{{law.lame}}, limit, multiplier);
        else
          f(law, limit, multiplier);
      };
      if (settings_.projected_tensor)
        with_form(TensorOf<Law>{drift_stiffness()});
      else
        with_form(ScalarMultiplier());
    }
  });
}

template <class Executor> void Solver<Executor>::solve_in_turn() {
  for (int pass = 0; pass < executor_.pass_count(); ++pass) {
    const int m = executor_.pass_material(pass);
    if constexpr (fluid_is_built) {
      if (is_fluid_material(m))
        executor_.for_each_block(pass, now_.velocities.data(), SolveFluid<FluidMotion::velocities>{{h_, 1.0f}});
    }
    with_constraint(m, [&](const auto &law, StrainLimit limit, const auto &multiplier) {
      using Stage = SolveInelastic<std::remove_cvref_t<decltype(law)>, std::remove_cvref_t<decltype(multiplier)>>;
      executor_.for_each_block(pass, now_.velocities.data(), Stage{law, limit, h_, multiplier});
    });
    lap(schedule_.solve[static_cast<std::size_t>(m)], static_cast<std::uint64_t>(executor_.pass_particles(pass)));
  }
}

template <class Executor> void Solver<Executor>::solve_at_once() {
  const JacobiRows rows = jacobi_rows();
  Row *velocities = now_.velocities.data();
  int stage = schedule_.gradients;
  if constexpr (fluid_is_built) {
    if (fluids_.in_use) solve_fluids_at_once<FluidTurn::velocities>(rows);
  }
  for (int m = 0; m < static_cast<int>(materials_.size()); ++m) {
    if (schedule_.solve[static_cast<std::size_t>(m)] < 0) continue;
    stage = schedule_.solve[static_cast<std::size_t>(m)];
    with_constraint(m, [&](const auto &law, StrainLimit limit, const auto &multiplier) {
      using Stage = JacobiImpulse<std::remove_cvref_t<decltype(law)>, std::remove_cvref_t<decltype(multiplier)>>;
      executor_.for_each_particle_of(m, velocities, Stage{law, limit, h_, multiplier, corrections_.data(), rows});
    });
    lap(stage, particles());
  }
  apply_at_once(rows);
  lap(stage, particles());
}

template <class Executor> JacobiRows Solver<Executor>::jacobi_rows() {
  JacobiRows rows = {};
  for (int j = 0; j < 3; ++j) {
    rows.column[j] = jacobi_rows_[j].data();
    if (drifts_in_use_) rows.along_drift[j] = jacobi_drift_rows_[j].data();
  }
  return rows;
}

// Every particle writes its own velocity and reads none but its own: the impulses are in the rows.
template <class Executor> void Solver<Executor>::apply_at_once(const JacobiRows &rows) {
  const auto apply = [&](auto non_affine) {
    for_each_particle_meeting(
        [&](const Meetings &meetings) {
          return JacobiApply<non_affine.value>{rows, now_.positions.data(), kernel_, meetings};
        },
        reach);
  };
  if (drifts_in_use_)
    apply(std::true_type());
  else
    apply(std::false_type());
}

template <class Executor> void Solver<Executor>::correct_positions() {
  const float least = settings_.minimum_distance * settings_.kernel_radius;
  Row *velocities = now_.velocities.data();
  const auto stage = [&](float share, const Meetings &meetings) {
    return CorrectPositions{now_.positions.data(), h_, least, settings_.kernel_radius, share, up_, meetings};
  };
  if (settings_.jacobi) {
    // A particle touches about six others; a third of each pair's violation at a time does not overshoot.
    for_each_particle_meeting([&](const Meetings &meetings) {
      return CorrectPositionsAtOnce{stage(1.0f / 3.0f, meetings), other_.velocities.data()};
    });
    now_.velocities.swap(other_.velocities);
  } else {
    for (int pass = 0; pass < executor_.pass_count(); ++pass) {
      const Meetings meetings = meetings_of(executor_.pass_material(pass));
      executor_.for_each_block(pass, velocities, CorrectPositionsInTurn{stage(1.0f, meetings)});
    }
  }
  lap(schedule_.position_correction, particles());
}

} // namespace loam
