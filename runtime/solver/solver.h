// The solver's state and its housekeeping, over any executor. The algorithm itself is in substep.h.
#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>

#include "kernels/contact/find_contacts.h"
#include "kernels/contact/solve_contacts.h"
#include "kernels/contact/sweep_contacts.h"
#include "kernels/fluid/displacements.h"
#include "kernels/fluid/measure_fluid.h"
#include "kernels/integration/edit_particles.h"
#include "kernels/integration/integrate.h"
#include "kernels/integration/measures.h"
#include "kernels/integration/release_particles.h"
#include "kernels/neighbours/sort_stages.h"
#include "scene/error.h"
#include "scene/pose.h"
#include "solver/backend.h"
#ifdef LOAM_WITHOUT_CLOTH
#include "solver/no_cloth.h"
#else
#include "solver/cloth_solver.h"
#endif
#include "solver/collider_motion.h"
#include "solver/collider_reactions.h"
#include "solver/collider_shapes.h"
#include "solver/contact_laws.h"
#include "solver/convergence.h"
#include "solver/fields.h"
#include "solver/fluid_state.h"
#include "solver/stages.h"

namespace loam {

template <class Executor> class Solver final : public Backend, private ParticleSink {
public:
  Solver(const SolverSettings &settings, const ExecutionSettings &execution);

  void set_materials(const std::vector<SolverMaterial> &materials) override;
  int add_shape(const ColliderShape &shape) override;
  void remove_shape(int shape) override;
  void move_vertices(int shape, const float *positions, bool at_once) override;
  void add_particles(const NewParticles &particles) override;
  std::vector<std::uint64_t> remove_particles(const std::uint32_t *ids, std::uint64_t count) override;
  void release_particles(const Release &release) override {
    executor_.session([&] { this->release(release); });
  }
  void keep_ages(bool keep) override;
  void set_motion(const ParticleMotion &motion) override;
  std::uint64_t particle_count() const override { return static_cast<std::uint64_t>(count_); }
  void step(const StepInput &input) override;
  void map(loam_particle_view &view) override;
  void keep(loam_particle_view &view) override;
  bool drop() override;
  void shift_origin(const Vec3<float> &by) override;
  std::uint64_t state_hash() override;
  std::vector<StateSection> state(std::uint64_t particles) override;
  void read_state(const StateSection &section, std::uint64_t first, std::size_t count, std::uint32_t *words) override;
  void write_state(const StateSection &section, std::uint64_t first, std::size_t count, const std::uint32_t *words) override;
  void list_vertices(int shape, std::uint32_t object, std::vector<StateSection> &list) override {
    shapes_.deforming(shape)->list_state(object, list);
  }
  void adopt_state(std::uint64_t particles) override;
  double greatest_speed() override;
  const loam_statistics &statistics() const override { return statistics_; }
  const Schedule &schedule(const Surroundings &surroundings) override {
    compile_schedule(surroundings);
    return schedule_;
  }
  std::vector<MemoryUse> memory() const override;
  ClothBackend &cloth() override { return cloth_; }

private:
  template <class T> using Array = typename Executor::template Array<T>;

  // One copy of all particle data; sorting moves it from one to the other.
  struct ParticleStorage {
    Array<Row> positions, velocities;
    Array<float> strains, histories, drifts, log_volumes, rest_volumes;
    Array<std::uint32_t> ids, materials;
    Array<float> free_distances; // while there are colliders
    Array<float> rests;          // where something may sleep
    Array<float> ages;           // while a killer asks
    Array<float> displacements;  // where there is fluid
    ParticleArrays arrays() {
      return {positions.data(),   velocities.data(),   strains.data(),      histories.data(), drifts.data(),
              log_volumes.data(), rest_volumes.data(), ids.data(),          materials.data(), free_distances.data(),
              rests.data(),       ages.data(),         displacements.data()};
    }
    std::uint64_t bytes() const {
      return positions.bytes() + velocities.bytes() + strains.bytes() + histories.bytes() + drifts.bytes() +
             log_volumes.bytes() + rest_volumes.bytes() + ids.bytes() + materials.bytes() + free_distances.bytes() +
             rests.bytes() + ages.bytes() + displacements.bytes();
    }
  };
  // Of the particles as they are.
  ParticleArrays particle_arrays() {
    ParticleArrays arrays = now_.arrays();
    arrays.stresses = stresses_.data();
    arrays.answered_drifts = answered_drifts_.data();
    return arrays;
  }
  bool warm_start() const {
    return settings_.warm_start && settings_.projected_tensor && !settings_.semi_implicit && !settings_.jacobi;
  }
  ParticleStorage make_storage() {
    return {executor_.template array<Row>(),           executor_.template array<Row>(),
            executor_.template array<float>(),         executor_.template array<float>(),
            executor_.template array<float>(),         executor_.template array<float>(),
            executor_.template array<float>(),         executor_.template array<std::uint32_t>(),
            executor_.template array<std::uint32_t>(), executor_.template array<float>(),
            executor_.template array<float>(),         executor_.template array<float>(),
            executor_.template array<float>()};
  }
  void reserve_storage(ParticleStorage &storage, std::size_t rows);
  template <class T> void grow_array(Array<T> &array, std::size_t count);
  void reserve_histories();
  template <class T> void copy_in(Array<T> &array, const std::vector<T> &values) {
    array.reserve(std::max<std::size_t>(values.size(), 1));
    executor_.upload(array.data(), values.data(), values.size());
  }

  // What streams in, in streams.h.
  void let_in(ParticleSource &source, double seconds);
  std::uint64_t room() const override;
  void enter(const Layer &layer) override;
  void release(const Release &release) override;
  void drop(std::uint64_t count) override;
  void set_unstrained(std::size_t at, int count, std::uint32_t material, float volume);

  void fill_holes(std::vector<std::uint32_t> &holes);
  void prepare_killers(const StepInput &input); // in killing.h, as is kill()
  void kill(const StepInput &input);
  std::vector<std::uint32_t> places_of(const std::uint32_t *ids, std::size_t count);

  // The parts of a substep, in substep.h.
  void run_substeps(const StepInput &input);
  void substep(const StepInput &input, std::uint32_t index);
  void search_neighbours();
  void compile_schedule(const Surroundings &surroundings);
  void make_grid();
  void wake_all();
  bool all_asleep(const StepInput &input, std::uint32_t index);
  void find_active_cells();
  void fall_asleep();
  void prepare_contacts(const StepInput &input, std::uint32_t index);
  void prepare_free_distances();
#ifdef LOAM_WITHOUT_CLOTH
  using Cloths = NoCloth<Executor>;
#else
  using Cloths = ClothSolver<Executor>;
#endif
  using ClothSubstep = typename Cloths::Substep;
  ClothSubstep cloth_substep(const StepInput &input);
  void start_inelastic(std::uint32_t iterations);
  void iterate(const StepInput &input);
  void iterate_once(const StepInput &input);
  template <class F> void for_each_body(F &&f); // f(count, velocities): the particles, and each cloth
  void solve_in_turn();
  void solve_at_once();
  void correct_positions();
  JacobiRows jacobi_rows();
  void apply_at_once(const JacobiRows &rows);
  // Of fluids, in fluid.h.
  void meet_fluids(const std::vector<SolverMaterial> &materials, std::vector<float> &table);
  template <class F> void for_each_fluid(F &&f);
  void reserve_fluids();
  void prepare_fluids();
  void start_fluids();
  void diffuse_velocities();
  void pull_surfaces();
  template <class F> void for_each_confined(F &&f);
  void mark_compression(const Vec3<float> &gravity);
  void confine_vorticity();
  template <FluidTurn Turn> void solve_fluids_at_once(const JacobiRows &rows);
  JacobiRows empty_jacobi_rows();
  template <class Stage> void solve_fluids_in_turn(const Stage &stage);
  void displace_fluids(const StepInput &input);
  void finish_displacements();
  void measure_fluids(const std::uint32_t *materials, const float *strains, float *densities);
  bool is_fluid_material(int material) const {
    return std::holds_alternative<Fluid>(materials_[static_cast<std::size_t>(material)].law);
  }
  void sweep_contacts(const Reactions &reactions = {});
  void measure(const Vec3<float> &gravity);
  void finish_statistics(const StepInput &input);
  float greatest_mass();
  template <class F> void with_law(int material, F &&f) {
    std::visit([&](const auto &law) { f(law, limit_of(law)); }, materials_[static_cast<std::size_t>(material)].law);
  }
  // Calls f(law, limit, multiplier form) with what holds inside the iterations.
  template <class F> void with_constraint(int material, F &&f);
  // Two tables: of whose gradients hold what, and of whose gradients move what. They differ for fluids.
  enum Table : std::size_t { holds = 0, reach = 1 };
  Meetings meetings_of(int material, Table table = holds) const {
    const auto m = static_cast<std::size_t>(material);
    if (!contact_between_materials_ || (!fluids_.in_use && materials_[m].meetings.empty())) return {};
    const std::size_t offset = fluids_.in_use && table == reach ? materials_.size() : 0;
    return {now_.materials.data(), meetings_.data() + (offset + m) * materials_.size()};
  }
  // Launches make(meetings) for all particles at once, or material by material where they meet others differently.
  template <class Make> void for_each_particle_meeting(Make &&make, Table table = holds) {
    if (!contact_between_materials_) {
      executor_.for_each_particle(now_.velocities.data(), make(Meetings{}));
      return;
    }
    for (int m = 0; m < static_cast<int>(materials_.size()); ++m)
      if (materials_[static_cast<std::size_t>(m)].in_use)
        executor_.for_each_particle_of(m, now_.velocities.data(), make(meetings_of(m, table)));
  }
  float drift_stiffness() const {
    return settings_.zero_energy_stiffness / (settings_.kernel_radius * settings_.kernel_radius);
  }
  template <class Law> static StrainLimit limit_of(const Law &) { return strain_limit(Law::greatest_strain); }
  void lap(int stage, std::uint64_t items) { executor_.lap(schedule_, stage, items); }
  std::uint64_t particles() const { return static_cast<std::uint64_t>(count_); }

  SolverSettings settings_;
  Executor executor_;
  SmoothingKernel kernel_;
  Schedule schedule_;
  Cloths cloth_{executor_, static_cast<std::size_t>(settings_.particle_capacity)};
  bool schedule_is_current_ = false, schedule_has_cloth_ = false;
  Surroundings scheduled_; // what the schedule was made for
  std::vector<SolverMaterial> materials_;
  int material_capacity_ = 0;
  int count_ = 0;
  std::size_t spare_row_ = 0; // index of the first
  bool histories_in_use_ = false, drifts_in_use_ = false, displacements_in_use_ = false;
  int record_size_ = 0;

  ParticleStorage now_, other_;
  // For the next substep to start from. Each shares a spare array with its like among the particles, and changes places with it in the sort.
  Array<float> stresses_, answered_drifts_;
  Array<std::uint32_t> keys_, order_;
  Array<float> x_, y_, z_;
  Array<int> cell_starts_, neighbour_counts_, close_counts_;
  Array<std::uint8_t> awake_cells_, near_cells_, active_cells_; // where something may sleep
  long long awake_ = 1;                                         // particles, as far as is known; 0 only if none is
  Array<int> counters_;                                         // speed limited, strain limited, contacts, strain decomposed
  Array<float> corrections_, densities_;
  Array<float> meetings_; // material by material
  bool contact_between_materials_ = false, distance_between_materials_ = false;
  Array<Row> jacobi_rows_[3], jacobi_drift_rows_[3];
  FluidState<Executor> fluids_{executor_};
  Convergence<Executor> convergence_{executor_, settings_.jacobi};
  std::uint32_t iterations_done_ = 0; // in this substep
  struct KeptFrame {
    Array<Row> positions, velocities;
    Array<float> strains, densities, histories;
    Array<std::uint32_t> ids, materials;
    std::uint64_t bytes() const {
      return positions.bytes() + velocities.bytes() + strains.bytes() + densities.bytes() + histories.bytes() + ids.bytes() +
             materials.bytes();
    }
  };
  KeptFrame make_frame() {
    return {executor_.template array<Row>(),          executor_.template array<Row>(),
            executor_.template array<float>(),        executor_.template array<float>(),
            executor_.template array<float>(),        executor_.template array<std::uint32_t>(),
            executor_.template array<std::uint32_t>()};
  }
  KeptFrame kept_{make_frame()}; // where the host asked for it
  ColliderShapes<Executor> shapes_{executor_};
  ContactLaws<Executor> contact_laws_{executor_};
  ColliderReactions<Executor> reactions_{executor_};
  Fields<Executor> fields_{executor_};
  Array<KillerView> killer_views_;
  struct Killed { // the host's lists of a step
    std::vector<KillerView> killers;
    std::vector<std::uint32_t> places, killer_of, ids, materials;
  };
  Killed killed_;
  std::vector<std::uint32_t> fillers_;             // of holes
  std::vector<ColliderView> views_, views_before_; // of this substep and the one before
  ColliderMotion collider_motion_;
  bool deforms_ = false;             // do vertices of a collider move in this substep?
  bool free_distances_hold_ = false; // what they say was true at the end of views_before_
  Array<ColliderView> collider_views_;
  Array<Contact> contacts_;
  int contact_count_ = 0;

  CellTable table_{};
  float h_ = 0;
  Vec3<float> up_{0, 1, 0};
  std::uint64_t pairs_ = 0;
  double residual_ = 0, virial_moment_ = 0;
  std::uint64_t speed_limited_ = 0;
  loam_statistics statistics_{};
};

template <class Executor>
Solver<Executor>::Solver(const SolverSettings &settings, const ExecutionSettings &execution)
    : settings_(settings), executor_(execution), kernel_(SmoothingKernel::make(static_cast<double>(settings.kernel_radius))),
      now_(make_storage()), other_(make_storage()), stresses_(executor_.template array<float>()),
      answered_drifts_(executor_.template array<float>()), keys_(executor_.template array<std::uint32_t>()),
      order_(executor_.template array<std::uint32_t>()), x_(executor_.template array<float>()),
      y_(executor_.template array<float>()), z_(executor_.template array<float>()),
      cell_starts_(executor_.template array<int>()), neighbour_counts_(executor_.template array<int>()),
      close_counts_(executor_.template array<int>()), awake_cells_(executor_.template array<std::uint8_t>()),
      near_cells_(executor_.template array<std::uint8_t>()), active_cells_(executor_.template array<std::uint8_t>()),
      counters_(executor_.template array<int>()), corrections_(executor_.template array<float>()),
      densities_(executor_.template array<float>()),
      meetings_(executor_.template array<float>()), jacobi_rows_{executor_.template array<Row>(),
                                                                 executor_.template array<Row>(),
                                                                 executor_.template array<Row>()},
      jacobi_drift_rows_{executor_.template array<Row>(), executor_.template array<Row>(), executor_.template array<Row>()},
      killer_views_(executor_.template array<KillerView>()), collider_views_(executor_.template array<ColliderView>()),
      contacts_(executor_.template array<Contact>()) {
  const auto capacity = static_cast<std::size_t>(settings_.particle_capacity);
  fluids_.calibration = FluidCalibration::of(kernel_, settings_.kernel_radius);
  spare_row_ = capacity;
  keys_.reserve(capacity);
  order_.reserve(capacity);
  // A candidate pack may read a few elements past the last particle.
  x_.reserve(capacity + 16);
  y_.reserve(capacity + 16);
  z_.reserve(capacity + 16);
  counters_.reserve(4);
  statistics_.struct_size = sizeof(loam_statistics);
  set_materials({});
}

// Growing keeps the particles: only the spare rows at the end become more.
template <class Executor> template <class T> void Solver<Executor>::grow_array(Array<T> &array, std::size_t count) {
  if (array.capacity() >= count) return;
  Array<T> fresh = executor_.template array<T>();
  fresh.reserve(count);
  if (array.capacity() > 0) executor_.copy(fresh.data(), array.data(), array.capacity());
  array.swap(fresh);
}

template <class Executor> void Solver<Executor>::reserve_storage(ParticleStorage &storage, std::size_t rows) {
  const auto grow = [&](auto &array, std::size_t per_row) { grow_array(array, rows * per_row); };
  grow(storage.positions, 1);
  grow(storage.velocities, 1);
  grow(storage.strains, 6);
  grow(storage.log_volumes, 1);
  grow(storage.rest_volumes, 1);
  grow(storage.ids, 1);
  grow(storage.materials, 1);
  if (settings_.sleep_speed > 0) grow(storage.rests, 1);
  if (histories_in_use_) grow(storage.histories, 1);
  if (drifts_in_use_) grow(storage.drifts, 3);
  if (displacements_in_use_) grow(storage.displacements, 1);
}

template <class Executor> void Solver<Executor>::set_materials(const std::vector<SolverMaterial> &materials) {
  const int wanted = std::max(1, static_cast<int>(materials.size()));
  // Passes are per material: room for a few more at a time.
  const bool more = wanted > material_capacity_;
  const int capacity = more ? std::max(wanted, std::min(2 * material_capacity_, 4096)) : material_capacity_;
  const std::size_t rows = spare_row_ + executor_.spare_rows();
  bool history = histories_in_use_, drift = drifts_in_use_, displacement = displacements_in_use_;
  for (const SolverMaterial &material : materials)
    std::visit(
        [&](const auto &law) {
          using Law = std::remove_cvref_t<decltype(law)>;
          history = history || Law::has_history;
          drift = drift || (settings_.projected_tensor && Law::resists_zero_energy_modes);
          displacement = displacement || is_fluid<Law>();
        },
        material.law);
  const int fields =
      record_size(settings_.projected_tensor ? ProjectedTensor<false>::state_count : ScalarMultiplier::state_count, drift);
  if (more || fields > record_size_) {
    executor_.reserve(static_cast<std::size_t>(settings_.particle_capacity), capacity, fields);
    record_size_ = fields;
  }
  if (more) {
    reserve_storage(now_, rows);
    reserve_storage(other_, rows);
    if (warm_start()) grow_array(stresses_, 6 * rows);
    if (warm_start() && drifts_in_use_) grow_array(answered_drifts_, 3 * rows);
    neighbour_counts_.reserve(rows);
    close_counts_.reserve(rows);
    if (settings_.jacobi) {
      corrections_.reserve(rows * 6);
      for (Array<Row> &column : jacobi_rows_) column.reserve(rows);
      if (drifts_in_use_)
        for (Array<Row> &column : jacobi_drift_rows_) column.reserve(rows);
    }
    // Spare rows take part in arithmetic: a rest volume of 0 would be a division by 0.
    const int spare = static_cast<int>(rows - spare_row_);
    executor_.set(now_.rest_volumes.data() + spare_row_, spare, 1.0f);
    executor_.set(other_.rest_volumes.data() + spare_row_, spare, 1.0f);
    executor_.set(now_.materials.data() + spare_row_, spare, 0u);
    executor_.set(other_.materials.data() + spare_row_, spare, 0u);
    material_capacity_ = capacity;
  }
  // Both copies or none: memory may be refused between them.
  const auto reserve_both = [&](Array<float> &now, Array<float> &other, std::size_t count) {
    Array<float> first = executor_.template array<float>(), second = executor_.template array<float>();
    first.reserve(count);
    second.reserve(count);
    now.swap(first);
    other.swap(second);
  };
  if (history && !histories_in_use_) {
    reserve_both(now_.histories, other_.histories, rows);
    executor_.set(now_.histories.data(), count_, 0.0f);
    histories_in_use_ = true;
  }
  if (drift && !drifts_in_use_) {
    if (settings_.jacobi)
      for (Array<Row> &column : jacobi_drift_rows_) column.reserve(rows);
    reserve_both(now_.drifts, other_.drifts, 3 * rows);
    executor_.set(now_.drifts.data(), 3 * count_, 0.0f);
    if (warm_start()) {
      answered_drifts_.reserve(3 * rows);
      executor_.set(answered_drifts_.data(), 3 * count_, 0.0f);
    }
    drifts_in_use_ = true;
  }
  if (displacement && !displacements_in_use_) {
    reserve_both(now_.displacements, other_.displacements, rows);
    executor_.set(now_.displacements.data(), count_, 0.0f);
    displacements_in_use_ = true;
  }
  std::vector<float> table;
  bool fluid = false;
  for (const SolverMaterial &material : materials) {
    fluid = fluid || (material.in_use && std::holds_alternative<Fluid>(material.law));
    if (!material.meetings.empty() || fluid) table.resize(materials.size() * materials.size(), Meetings::gradients_shared);
  }
  for (std::size_t m = 0; m < materials.size() && !table.empty(); ++m)
    std::copy(materials[m].meetings.begin(), materials[m].meetings.end(),
              table.begin() + static_cast<std::ptrdiff_t>(m * materials.size()));
  if (fluid) meet_fluids(materials, table);
  if (!table.empty()) copy_in(meetings_, table);
  if (!fluid) { // memory may be refused up to here
    fluids_.walls.free();
    fluids_.is_fluid.free();
  }
  fluids_.viscosity = fluids_.surface_tension = fluids_.vorticity_confinement = 0;
  for (const SolverMaterial &material : materials)
    if (const Fluid *law = std::get_if<Fluid>(&material.law); law != nullptr && material.in_use) {
      fluids_.viscosity = std::max(fluids_.viscosity, law->kinematic_viscosity);
      fluids_.surface_tension = std::max(fluids_.surface_tension, law->kinematic_surface_tension);
      fluids_.vorticity_confinement = std::max(fluids_.vorticity_confinement, law->vorticity_confinement);
    }
  if (fluids_.surface_tension == 0.0f) fluids_.surface.free();
  if (fluids_.vorticity_confinement == 0.0f) {
    fluids_.vortex_marks.free();
    fluids_.vorticity.free();
  }
  if (fluids_.viscosity == 0.0f) {
    fluids_.viscosities.free();
    for (Array<Row> &marks : fluids_.marks) marks.free();
  }
  fluids_.in_use = fluid;
  distance_between_materials_ = std::any_of(materials.begin(), materials.end(),
                                            [](const SolverMaterial &material) { return !material.meetings.empty(); });
  contact_between_materials_ = !table.empty();
  materials_ = materials;
  schedule_is_current_ = false;
}

template <class Executor> int Solver<Executor>::add_shape(const ColliderShape &shape) {
  free_distances_hold_ = false;
  return shapes_.add(shape);
}

template <class Executor> void Solver<Executor>::remove_shape(int shape) {
  free_distances_hold_ = false;
  shapes_.remove(shape);
}

template <class Executor> void Solver<Executor>::move_vertices(int shape, const float *positions, bool at_once) {
  if (at_once) free_distances_hold_ = false;
  executor_.session([&] { shapes_.deforming(shape)->move(positions, at_once); });
}

template <class Executor> void Solver<Executor>::add_particles(const NewParticles &particles) {
  const auto n = static_cast<std::size_t>(particles.count), at = static_cast<std::size_t>(count_);
  if (n == 0) return;
  std::vector<Row> positions(n), velocities(n);
  for (std::size_t i = 0; i < n; ++i) {
    const float *x = particles.positions + 3 * i;
    positions[i] = {x[0], x[1], x[2], particles.volume};
    const float *v = particles.velocities != nullptr ? particles.velocities + 3 * i : &particles.velocity.x;
    velocities[i] = {v[0], v[1], v[2], particles.inverse_mass};
  }
  std::vector<std::uint32_t> ids(n);
  for (std::size_t i = 0; i < n; ++i) ids[i] = particles.first_id + static_cast<std::uint32_t>(i);
  const int count = static_cast<int>(n);
  executor_.upload(now_.positions.data() + at, positions.data(), n);
  executor_.upload(now_.velocities.data() + at, velocities.data(), n);
  executor_.upload(now_.ids.data() + at, ids.data(), n);
  set_unstrained(at, count, particles.material, particles.volume);
  awake_ = 1;
  count_ += count;
}

template <class Executor> void Solver<Executor>::map(loam_particle_view &view) {
  densities_.reserve(static_cast<std::size_t>(settings_.particle_capacity));
  executor_.session([&] {
    executor_.for_each(count_, ComputeDensities{now_.positions.data(), now_.velocities.data(), densities_.data()});
    measure_fluids(now_.materials.data(), now_.strains.data(), densities_.data());
  });
  view.memory = Executor::memory_kind;
  view.count = particles();
  view.ids = now_.ids.data();
  view.positions = &now_.positions.data()->x;
  view.velocities = &now_.velocities.data()->x;
  view.materials = now_.materials.data();
  view.strains = now_.strains.data();
  view.densities = densities_.data();
  view.histories = histories_in_use_ ? now_.histories.data() : nullptr;
}

template <class Executor> void Solver<Executor>::keep(loam_particle_view &view) {
  if (kept_.bytes() == 0) {
    const auto capacity = static_cast<std::size_t>(settings_.particle_capacity);
    KeptFrame frame = make_frame(); // all of it or nothing: memory may be refused
    frame.positions.reserve(capacity);
    frame.velocities.reserve(capacity);
    frame.strains.reserve(6 * capacity);
    frame.densities.reserve(capacity);
    frame.ids.reserve(capacity);
    frame.materials.reserve(capacity);
    kept_ = std::move(frame);
  }
  if (histories_in_use_) kept_.histories.reserve(static_cast<std::size_t>(settings_.particle_capacity));
  const auto n = static_cast<std::size_t>(count_);
  executor_.session([&] {
    executor_.copy(kept_.positions.data(), now_.positions.data(), n);
    executor_.copy(kept_.velocities.data(), now_.velocities.data(), n);
    executor_.copy(kept_.strains.data(), now_.strains.data(), 6 * n);
    if (histories_in_use_) executor_.copy(kept_.histories.data(), now_.histories.data(), n);
    executor_.copy(kept_.ids.data(), now_.ids.data(), n);
    executor_.copy(kept_.materials.data(), now_.materials.data(), n);
    executor_.for_each(count_, ComputeDensities{kept_.positions.data(), kept_.velocities.data(), kept_.densities.data()});
    measure_fluids(kept_.materials.data(), kept_.strains.data(), kept_.densities.data());
  });
  view.memory = Executor::memory_kind;
  view.count = particles();
  view.ids = kept_.ids.data();
  view.positions = &kept_.positions.data()->x;
  view.velocities = &kept_.velocities.data()->x;
  view.materials = kept_.materials.data();
  view.strains = kept_.strains.data();
  view.densities = kept_.densities.data();
  view.histories = histories_in_use_ ? kept_.histories.data() : nullptr;
}

template <class Executor> bool Solver<Executor>::drop() {
  if (kept_.bytes() == 0) return false;
  kept_ = make_frame();
  return true;
}

template <class Executor> std::uint64_t Solver<Executor>::state_hash() {
  std::uint64_t hash = 0;
  executor_.session([&] {
    hash = executor_.reduce(count_, StateHash{particle_arrays()});
    shapes_.for_each_deforming([&](DeformingMesh<Executor> &mesh) { hash = mesh.hash(hash); });
  });
  return cloth_.hash(StateHash::mix(hash, particles()));
}

template <class Executor> std::vector<MemoryUse> Solver<Executor>::memory() const {
  std::vector<MemoryUse> uses;
  uses.push_back({"particles", now_.bytes() + other_.bytes()});
  if (stresses_.bytes() > 0) uses.push_back({"warm start", stresses_.bytes() + answered_drifts_.bytes()});
  uses.push_back({"sorting and visit order", keys_.bytes() + order_.bytes() + x_.bytes() + y_.bytes() + z_.bytes() +
                                                 cell_starts_.bytes() + neighbour_counts_.bytes() + close_counts_.bytes() +
                                                 counters_.bytes() + executor_.order_bytes()});
  uses.push_back({"neighbour pairs", executor_.list_bytes()});
  uses.push_back({"inelastic constraints", executor_.record_bytes()});
  if (settings_.jacobi) {
    std::uint64_t bytes = corrections_.bytes();
    for (const Array<Row> &column : jacobi_rows_) bytes += column.bytes();
    for (const Array<Row> &column : jacobi_drift_rows_) bytes += column.bytes();
    uses.push_back({"Jacobi solver", bytes});
  }
  const std::uint64_t colliders =
      collider_views_.bytes() + contacts_.bytes() + shapes_.bytes() + contact_laws_.bytes() + reactions_.bytes();
  if (colliders > 0) uses.push_back({"colliders", colliders});
  if (fluids_.bytes() > 0) uses.push_back({"fluids", fluids_.bytes()});
  if (cloth_.bytes() > 0) uses.push_back({"cloth", cloth_.bytes()});
  if (cloth_.self_contact_bytes() > 0) uses.push_back({"cloth self contact", cloth_.self_contact_bytes()});
  if (convergence_.bytes() > 0) uses.push_back({"convergence", convergence_.bytes()});
  if (fields_.bytes() > 0) uses.push_back({"fields", fields_.bytes()});
  if (killer_views_.bytes() > 0) uses.push_back({"killers", killer_views_.bytes()});
  if (settings_.sleep_speed > 0)
    uses.push_back({"sleep", awake_cells_.bytes() + near_cells_.bytes() + active_cells_.bytes()});
  if (kept_.bytes() > 0) uses.push_back({"kept frame", kept_.bytes()});
  if (densities_.bytes() > 0) uses.push_back({"mapped densities", densities_.bytes()});
  return uses;
}

} // namespace loam

#include "solver/edit.h"
#include "solver/fluid.h"
#include "solver/killing.h"
#include "solver/state.h"
#include "solver/step.h"
#include "solver/streams.h"
#include "solver/substep.h"

#include "solver/sleeping.h"
