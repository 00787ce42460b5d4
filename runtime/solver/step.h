// What stands around the substeps: neighbours, contacts' preparation, statistics. Part of solver.h.
#pragma once

namespace loam {

template <class Executor> void Solver<Executor>::step(const StepInput &input) {
  compile_schedule(input.surroundings());
  schedule_.begin_step();

  const float g = length(input.gravity);
  up_ = g > 0.0f ? (-1.0f / g) * input.gravity : Vec3<float>{0, 1, 0};
  statistics_.substeps_done = 0;
  statistics_.pair_visits = 0;
  statistics_.iterations_done = 0;
  statistics_.iterations = statistics_.substeps_unsolved = 0;
  statistics_.solution_error = statistics_.stretch = statistics_.penetration = statistics_.density_error = 0;
  statistics_.particles_entered = statistics_.particles_dropped = statistics_.particles_killed = 0;
  statistics_.step_seconds = 0;
  residual_ = 0;
  virial_moment_ = 0;
  contact_count_ = 0;
  cloth_.begin_step();
  pairs_ = 0;
  executor_.set(counters_.data(), 4, 0);
  contact_laws_.prepare(input.colliders, materials_); // memory may be refused from here on: no substep was done
  const auto begin = std::chrono::steady_clock::now();
  executor_.lap();
  const auto end_deforming = [&](double share) {
    shapes_.for_each_deforming([share](DeformingMesh<Executor> &mesh) { mesh.end_step(share); });
  };
  executor_.session([&] {
    shapes_.for_each_deforming([](DeformingMesh<Executor> &mesh) { mesh.begin_step(); });
    try {
      run_substeps(input);
    } catch (...) { // they stop with the particles, at the end of the last whole substep
      end_deforming(static_cast<double>(statistics_.substeps_done) / input.substeps);
      throw;
    }
    kill(input);
    finish_statistics(input);
    reactions_.read(input.colliders);
    end_deforming(1);
  });
  statistics_.step_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

template <class Executor> void Solver<Executor>::run_substeps(const StepInput &input) {
  reactions_.prepare(input.colliders, static_cast<double>(settings_.kernel_radius),
                     static_cast<double>(input.seconds) / input.substeps, [this] { return greatest_mass(); });
  fields_.prepare(input.fields, static_cast<double>(input.seconds) / input.substeps, input.substeps);
  prepare_killers(input);
  // Cloth cannot tell whom it touches, so nothing sleeps beside it.
  if ((input.wake || !cloth_.empty()) && schedule_.sleep >= 0) wake_all();
  if (count_ == 0 && cloth_.empty() && input.source == nullptr) return;
  for (std::uint32_t i = 0; i < input.substeps; ++i) {
    if (schedule_.sleep >= 0 && fields_.wake(count_, now_.positions.data(), now_.rests.data(), i)) awake_ = 1;
    const bool idle = schedule_.sleep >= 0 && count_ > 0 && all_asleep(input, i) && cloth_.empty();
    iterations_done_ = 0;
    if (!idle) substep(input, i);
    if (input.source != nullptr) let_in(*input.source, static_cast<double>(input.seconds) / input.substeps);
    ++statistics_.substeps_done;
    statistics_.pairs = pairs_;
    statistics_.pair_visits += pairs_ * iterations_done_;
    statistics_.iterations_done += iterations_done_;
    statistics_.iterations = std::max(statistics_.iterations, iterations_done_);
  }
}

// Of what can move. Where nothing can, that of a particle of water.
template <class Executor> float Solver<Executor>::greatest_mass() {
  const float r = settings_.kernel_radius,
              least =
                  std::min(executor_.reduce(count_, LeastInverseMass{now_.velocities.data()}), cloth_.least_inverse_mass());
  return least < LeastInverseMass::identity() ? 1.0f / least : 1000.0f * r * r * r;
}

template <class Executor> void Solver<Executor>::compile_schedule(const Surroundings &surroundings) {
  const bool cloth = !cloth_.empty(), self_contact = cloth_.any_self_contact();
  if (schedule_is_current_ && surroundings == scheduled_ && cloth == schedule_has_cloth_ &&
      self_contact == (schedule_.cloth_self_contact >= 0))
    return;
  SceneContents contents;
  contents.surroundings = surroundings;
  for (const SolverMaterial &material : materials_) contents.materials.push_back({material.name, material.in_use});
  const bool only_fluid = fluids_.in_use && std::none_of(materials_.begin(), materials_.end(), [](const SolverMaterial &m) {
                            return m.in_use && !std::holds_alternative<Fluid>(m.law);
                          });
  contents.position_correction = (settings_.minimum_distance > 0.0f && !only_fluid) || distance_between_materials_;
  contents.velocity_smoothing = settings_.velocity_smoothing > 0.0f && !only_fluid;
  contents.warm_start = warm_start() && std::any_of(materials_.begin(), materials_.end(), [](const SolverMaterial &m) {
                          return m.in_use && !std::holds_alternative<Fluid>(m.law);
                        });
  contents.cloth = cloth;
  contents.cloth_self_contact = self_contact;
  for (std::size_t m = 0; m < materials_.size(); ++m)
    if (const Fluid *fluid = std::get_if<Fluid>(&materials_[m].law)) {
      contents.materials[m].fluid = true;
      contents.materials[m].viscous = fluid->kinematic_viscosity > 0.0f;
      contents.materials[m].surface_tension = fluid->kinematic_surface_tension > 0.0f;
      contents.materials[m].vorticity_confinement = fluid->vorticity_confinement > 0.0f;
    }
  contents.sleep = settings_.sleep_speed > 0.0f;
  contents.particles =
      std::any_of(materials_.begin(), materials_.end(), [](const SolverMaterial &material) { return material.in_use; });
  schedule_.compile(contents);
  if (schedule_.convergence < 0) convergence_.free();
  schedule_is_current_ = true;
  scheduled_ = surroundings;
  schedule_has_cloth_ = cloth;
}

template <class Executor> void Solver<Executor>::make_grid() {
  const float cell = 2.0f * settings_.kernel_radius;
  // A cell is a hair wider than the support, so that rounding in the cell coordinate cannot hide a neighbour two cells away.
  const float inverse_cell = 1.0f / (cell * 1.0001f);
  const CellBounds::Value bounds = executor_.reduce(count_, CellBounds{now_.positions.data(), inverse_cell});
  const Colouring colouring = Colouring::choose(count_);
  const int period = colouring.period();
  table_ = {};
  table_.colouring = colouring;
  table_.grid.inverse_cell = inverse_cell;

  std::int64_t size[3];
  for (int k = 0; k < 3; ++k) {
    table_.grid.origin[k] = bounds.lower[k];
    const std::int64_t extent = static_cast<std::int64_t>(bounds.upper[k]) - bounds.lower[k] + 1;
    size[k] = (extent + period - 1) / period * period;
  }
  // The table of cells is bounded by the particles; wider scenes wrap around.
  const std::int64_t most = std::max<std::int64_t>(32768, 4 * static_cast<std::int64_t>(settings_.particle_capacity));
  while (size[0] * size[1] > most || size[0] * size[1] * size[2] > most) {
    std::int64_t *widest = std::max_element(size, size + 3);
    *widest = std::max<std::int64_t>(period, (*widest / 2 + period - 1) / period * period);
  }
  for (int k = 0; k < 3; ++k) table_.grid.size[k] = static_cast<int>(size[k]);
  const auto cells = static_cast<std::size_t>(table_.grid.cell_count()) + 1;
  if (cells > cell_starts_.capacity()) cell_starts_.reserve(cells + cells / 4);
}

template <class Executor> void Solver<Executor>::search_neighbours() {
  Executor &ex = executor_;
  make_grid();
  const int cells = table_.grid.cell_count();
  int key_bits = 1;
  while (((cells - 1) >> key_bits) != 0) ++key_bits;
  ex.for_each(count_, AssignCells{table_.grid, now_.positions.data(), keys_.data(), order_.data()});
  ex.sort(keys_.data(), order_.data(), count_, key_bits);
  ex.for_each(count_, MoveParticles{now_.arrays(), other_.arrays(), order_.data(), x_.data(), y_.data(), z_.data()});
  std::swap(now_, other_);
  if (warm_start()) {
    ex.for_each(count_, MoveValues<6>{stresses_.data(), other_.strains.data(), order_.data()});
    stresses_.swap(other_.strains);
    if (drifts_in_use_) {
      ex.for_each(count_, MoveValues<3>{answered_drifts_.data(), other_.drifts.data(), order_.data()});
      answered_drifts_.swap(other_.drifts);
    }
  }
  ex.for_each(count_, MarkCells{keys_.data(), cell_starts_.data(), count_, cells});
  lap(schedule_.sort, particles());
  if (schedule_.sleep >= 0) find_active_cells();

  const float r = settings_.kernel_radius, least = settings_.minimum_distance * r;
  // Pairs that can come too close within the substep; a pair's approach is a fraction of r in any motion that is resolved.
  const float greatest = distance_between_materials_ ? std::max(least, r) : least;
  const float close = schedule_.position_correction >= 0 ? greatest + 0.5f * r : 0.0f;
  const CandidateTest test = {4.0f * r * r, close * close, settings_.jacobi};
  table_.particle_count = count_;
  table_.material_count = std::max(1, static_cast<int>(materials_.size()));
  int in_use = 0;
  for (int m = 0; m < static_cast<int>(materials_.size()); ++m)
    if (materials_[static_cast<std::size_t>(m)].in_use) {
      ++in_use;
      table_.only_material = m;
    }
  if (in_use != 1) table_.only_material = -1;
  table_.keys = keys_.data();
  table_.starts = cell_starts_.data();
  table_.x = x_.data();
  table_.y = y_.data();
  table_.z = z_.data();
  table_.materials = now_.materials.data();
  table_.neighbour_counts = neighbour_counts_.data();
  table_.close_counts = close_counts_.data();
  table_.spare_rows = static_cast<int>(spare_row_);
  const auto check = [&](std::uint64_t pairs) {
    const std::uint64_t most = 1500000000ull;
    statistics_.pairs_peak = std::max(statistics_.pairs_peak, pairs);
    if (settings_.pair_capacity != 0 && pairs > settings_.pair_capacity)
      throw Error(LOAM_ERROR_CAPACITY,
                  format("the particles have %llu neighbour pairs; pair_capacity is %llu and would have to be that many",
                         static_cast<unsigned long long>(pairs), static_cast<unsigned long long>(settings_.pair_capacity)));
    if (pairs > most)
      throw Error(LOAM_ERROR_CAPACITY,
                  format("the particles have %llu neighbour pairs, more than the %llu that a world can hold: are many of "
                         "them in one place, or is kernel_radius too large?",
                         static_cast<unsigned long long>(pairs), static_cast<unsigned long long>(most)));
    pairs_ = pairs;
  };
  try {
    ex.find_neighbours(table_, test, neighbour_counts_.data(), close_counts_.data(), check, schedule_);
  } catch (...) {
    // Memory for the lists was refused, or they are too long: what sleeps has its mass back.
    if (schedule_.sleep >= 0) ex.for_each(count_, HoldSleepers{now_.velocities.data(), now_.rests.data()});
    throw;
  }

  const auto gradients = [&](auto non_affine, const Meetings &meetings) {
    return ComputeGradients<non_affine.value>{now_.positions.data(),
                                              now_.velocities.data(),
                                              now_.strains.data(),
                                              histories_in_use_ ? now_.histories.data() : nullptr,
                                              now_.drifts.data(),
                                              now_.rest_volumes.data(),
                                              neighbour_counts_.data(),
                                              close_counts_.data(),
                                              settings_.jacobi ? corrections_.data() : nullptr,
                                              kernel_,
                                              settings_.gradient_cutoff,
                                              record_size_,
                                              meetings};
  };
  if (!drifts_in_use_ && !fluids_.in_use)
    for_each_particle_meeting([&](const Meetings &meetings) { return gradients(std::false_type(), meetings); });
  else
    for (int m = 0; m < static_cast<int>(materials_.size()); ++m)
      with_law(m, [&](const auto &law, StrainLimit) {
        using Law = std::remove_cvref_t<decltype(law)>;
        if constexpr (!is_fluid<Law>()) {
          if (!materials_[static_cast<std::size_t>(m)].in_use) return;
          const auto visit = [&](auto non_affine) {
            ex.for_each_particle_of(m, now_.velocities.data(), gradients(non_affine, meetings_of(m)));
          };
          if (Law::resists_zero_energy_modes && drifts_in_use_)
            visit(std::bool_constant<Law::resists_zero_energy_modes>());
          else
            visit(std::false_type());
        }
      });
  lap(schedule_.gradients, pairs_);
}

template <class Executor> void Solver<Executor>::prepare_contacts(const StepInput &input, std::uint32_t index) {
  contact_count_ = 0;
  views_before_.swap(views_);
  views_.clear();
  collider_motion_ = {};
  deforms_ = false;
  for (const ColliderState &collider : input.colliders) {
    ColliderView view = {};
    view.law = collider.law;
    view.of_materials = contact_laws_.of(views_.size());
    view.start = interpolate(collider.start, collider.end, static_cast<double>(index) / input.substeps);
    view.end = interpolate(collider.start, collider.end, static_cast<double>(index + 1) / input.substeps);
    view.shape = shapes_.place(collider.shape, index, input.substeps);
    deforms_ = deforms_ || shapes_.moves(collider.shape);
    collider_motion_.include(view, shapes_.extent(collider.shape), shapes_.motion(collider.shape, input.substeps));
    views_.push_back(view);
  }
  prepare_free_distances();
  if (views_.empty()) return;
  copy_in(collider_views_, views_);

  const float r = settings_.kernel_radius, stand_off = 0.5f * r;
  // What gravity gives in four substeps is no impact.
  const float rest_speed = 4.0f * h_ * length(input.gravity);
  const FreeDistances free_distances = {now_.free_distances.data(), collider_motion_.enough(stand_off + r) + 0.01f * r};
  for (int attempt = 0; attempt < 2; ++attempt) {
    executor_.set(counters_.data() + 2, 1, 0);
    with_deforming(deforms_, [&](auto deforms) {
      executor_.for_each(count_,
                         FindContactsOf<deforms.value>{now_.positions.data(), now_.velocities.data(), collider_views_.data(),
                                                       static_cast<int>(views_.size()), h_, stand_off, r, contacts_.data(),
                                                       static_cast<int>(contacts_.capacity()), counters_.data() + 2,
                                                       free_distances, now_.materials.data(), rest_speed,
                                                       fluids_.in_use ? 1.0f : 0.25f}); // a wall counts in a fluid's density
    });
    contact_count_ = executor_.read(counters_.data() + 2);
    if (static_cast<std::size_t>(contact_count_) <= contacts_.capacity()) break;
    const auto found = static_cast<std::size_t>(contact_count_);
    contacts_.reserve(std::min(found + found / 4 + 256, static_cast<std::size_t>(settings_.particle_capacity)));
  }
  lap(schedule_.find_contacts, particles());
}

// Free distances are held while there are colliders (one plane is enough for them to pay), and forgotten where a collider came, went or was placed.
template <class Executor> void Solver<Executor>::prepare_free_distances() {
  if (views_.empty() || !settings_.keep_free_distances) {
    now_.free_distances.free();
    other_.free_distances.free();
  } else {
    if (now_.free_distances.capacity() == 0) { // both or none: memory may be refused
      Array<float> now = executor_.template array<float>(), other = executor_.template array<float>();
      now.reserve(static_cast<std::size_t>(settings_.particle_capacity));
      other.reserve(static_cast<std::size_t>(settings_.particle_capacity));
      now_.free_distances.swap(now);
      other_.free_distances.swap(other);
    }
    if (!free_distances_hold_ || !go_on(views_before_, views_)) executor_.set(now_.free_distances.data(), count_, 0.0f);
  }
  free_distances_hold_ = false; // until this substep is over: it may fail
}

// Residual and virial, on the velocities of the last iteration. The terms go where the other copy of the strains is: 4 of its 6 floats.
template <class Executor> void Solver<Executor>::measure(const Vec3<float> &gravity) {
  static_assert(ConstraintTerms::term_count <= 6);
  float *terms = other_.strains.data();
  executor_.set(terms, ConstraintTerms::term_count * count_, 0.0f);
  for (int m = 0; m < static_cast<int>(materials_.size()); ++m) {
    if (schedule_.solve[static_cast<std::size_t>(m)] < 0) continue;
    with_constraint(m, [&](const auto &law, StrainLimit limit, const auto &multiplier) {
      using Stage = MeasureConstraint<std::remove_cvref_t<decltype(law)>, std::remove_cvref_t<decltype(multiplier)>>;
      executor_.for_each_particle_of(m, now_.velocities.data(), Stage{law, limit, h_, multiplier, up_, terms});
    });
  }
  const SumTerms::Value sums = executor_.reduce(count_, SumTerms{terms});
  const double squared = sums.term[ConstraintTerms::value_squared];
  residual_ = squared > 0 ? std::sqrt(sums.term[ConstraintTerms::residual_squared] / squared) : 0;

  double support = 0;
  if (contact_count_ > 0)
    support = executor_.reduce(contact_count_,
                               ContactMoment{contacts_.data(), now_.positions.data(), now_.velocities.data(), up_}) /
              static_cast<double>(h_);
  const double moment = executor_.reduce(count_, WeightMoment{now_.positions.data(), now_.velocities.data(), gravity});
  const double weight = moment - support;
  const double stress = sums.term[ConstraintTerms::pair_moment] - sums.term[ConstraintTerms::stress_moment];
  virial_moment_ = length(gravity) > 0.0f && contact_count_ > 0 && std::abs(weight) > 0 ? stress / weight : 0;
  lap(schedule_.statistics, particles());
}

template <class Executor> void Solver<Executor>::finish_statistics(const StepInput &input) {
  const MotionMeasure::Value motion =
      executor_.reduce(count_, MotionMeasure{now_.positions.data(), now_.velocities.data(), now_.strains.data()});
  statistics_.particles = particles();
  statistics_.cloth_tears = cloth_.tear_count();
  if (schedule_.sleep >= 0)
    statistics_.sleeping = static_cast<std::uint64_t>(executor_.reduce(count_, CountSleepers{now_.rests.data()}));
  MeasureContacts::Value contacts = MeasureContacts::identity();
  if (contact_count_ > 0) contacts = executor_.reduce(contact_count_, MeasureContacts{contacts_.data()});
  statistics_.contacts = static_cast<std::uint64_t>(contacts.planes);
  statistics_.penetration = static_cast<double>(contacts.depth);
  if (fluids_.in_use && count_ > 0) {
    const MeanCompression::Value compression =
        executor_.reduce(count_, MeanCompression{fluids_.is_fluid.data(), now_.materials.data(), now_.strains.data()});
    if (compression.count > 0) statistics_.density_error = compression.sum / static_cast<double>(compression.count);
  }
  statistics_.stretch = cloth_.greatest_stretch();
  statistics_.non_finite = static_cast<std::uint64_t>(motion.non_finite);
  statistics_.kinetic_energy = motion.kinetic_energy;
  statistics_.max_speed = motion.max_speed;
  statistics_.mean_speed = count_ > 0 ? motion.speed_sum / count_ : 0;
  for (int k = 0; k < 3; ++k) statistics_.momentum[k] = motion.momentum[k];
  statistics_.speed_limited = static_cast<std::uint64_t>(executor_.read(counters_.data()));
  statistics_.strain_limited = static_cast<std::uint64_t>(executor_.read(counters_.data() + 1));
  statistics_.strain_decomposed = static_cast<std::uint64_t>(executor_.read(counters_.data() + 3));
  statistics_.stiffness_share = static_cast<double>(input.stiffness_share);
  // Their terms are single precision: with the largest radii and moduli they may overflow.
  statistics_.residual = std::isfinite(residual_) ? residual_ : 0;
  statistics_.virial = std::isfinite(virial_moment_) ? virial_moment_ : 0;
  lap(schedule_.statistics, particles());
}

} // namespace loam
