// The executor for machines that give a particle a tile of lanes. It offers the same names as the CPU's (cpu/cpu_executor.h) and puts them
// on a Machine, which holds the memory and runs loops: the CUDA device, or in tests an emulation of it, so that all of this is also executed
// where there is no GPU.
//
// A Machine offers
//   Array<T>, array<T>(), memory_kind
//   session, for_each, reduce, set, read, upload, download, copy, lap     as an executor does
//   reserve(particles)                                                    room for what follows
//   sort(keys, values, count, bits)                                       stable; for keys of 32 and of 64 bits
//   exclusive_sum(VisitSums *, count)                                     in place
//   search(stage, candidates, count)                                      a tile for each particle (counting) or visit (filling)
//   visit_all(stage, pairs, first, count)                                 a tile for each visit
//   visit_blocks(stage, pairs, blocks)                                    a tile for each block, its visits in turn
//   work_bytes()                                                          memory that it holds for itself
#pragma once

#include "kernels/integration/measures.h"
#include "schedule/schedule.h"
#include "solver/cell_table.h"
#include "solver/execution_settings.h"
#include "team_over_constraints.h"
#include "tile_width.h"
#include "visit_order.h"

namespace loam {

template <class Machine> class TileExecutor {
public:
  template <class T> using Array = typename Machine::template Array<T>;
  static constexpr std::uint32_t memory_kind = Machine::memory_kind;

  explicit TileExecutor(const ExecutionSettings &settings) : machine_(settings), order_(machine_) {}
  TileExecutor(const TileExecutor &) = delete;
  TileExecutor &operator=(const TileExecutor &) = delete;

  template <class T> Array<T> array() { return machine_.template array<T>(); }
  void reserve(std::size_t particle_capacity, int material_count, int record_size) {
    machine_.reserve(particle_capacity);
    order_.reserve(particle_capacity, material_count, record_size);
  }
  // None: lanes without a particle do nothing.
  static std::size_t spare_rows() { return 0; }

  template <class Body> void session(Body &&body) { machine_.session(body); }

  // ------------------------------------------------------------------------------------------------ per item ---

  template <class Stage> void for_each(int count, const Stage &stage) { machine_.for_each(count, stage); }
  template <class Reduction> typename Reduction::Value reduce(int count, const Reduction &reduction) {
    return machine_.reduce(count, reduction);
  }
  void reserve_sort(std::size_t count) { machine_.reserve(count); }
  void sort(std::uint32_t *keys, std::uint32_t *values, int count, int key_bits) {
    machine_.sort(keys, values, count, key_bits);
  }
  template <class T> void set(T *values, int count, T value) { machine_.set(values, count, value); }
  template <class T> T read(const T *value) {
    T result;
    machine_.download(&result, value, 1);
    return result;
  }
  template <class T> void upload(T *to, const T *from, std::size_t count) { machine_.upload(to, from, count); }
  template <class T> void copy(T *to, const T *from, std::size_t count) { machine_.copy(to, from, count); }
  template <class T> void download(T *to, const T *from, std::size_t count) { machine_.download(to, from, count); }

  // ---------------------------------------------------------------------------------------------- neighbours ---

  // Finds the lists and orders the visits. `check` is told the number of pairs before memory is taken for them, and may throw.
  template <class Check>
  void find_neighbours(const CellTable &table, const CandidateTest &test, int *neighbour_counts, int *close_counts,
                       Check &&check, Schedule &schedule) {
    const auto particles = static_cast<std::uint64_t>(table.particle_count);
    machine_.search(CountNeighbours{test, neighbour_counts, close_counts, table.keys, table.active_cells}, candidates(table),
                    table.particle_count);
    const auto pairs = static_cast<std::uint64_t>(reduce(table.particle_count, SumCounts{neighbour_counts}));
    check(pairs);
    lap(schedule, schedule.search, pairs);
    order_.arrange(table);
    lap(schedule, schedule.order, particles);
    machine_.search(FillNeighbours{test, neighbour_counts, close_counts}, candidates(table), order_.visit_count());
    lap(schedule, schedule.search, 0);
  }
  std::size_t list_bytes() const { return order_.list_bytes(); }
  std::size_t record_bytes() const { return order_.record_bytes(); }
  std::size_t order_bytes() const { return order_.order_bytes() + machine_.work_bytes(); }

  // --------------------------------------------------------------------------------------- over neighbours ---

  template <class Stage> void for_each_particle(Row *velocities, const Stage &stage) {
    static_assert(!InTurn<Stage>::value);
    machine_.visit_all(stage, order_.pairs(velocities), 0, order_.visit_count());
  }
  template <class Stage> void for_each_particle_of(int material, Row *velocities, const Stage &stage) {
    static_assert(!InTurn<Stage>::value);
    const auto [first, last] = order_.visits_of(material);
    machine_.visit_all(stage, order_.pairs(velocities), first, last - first);
  }
  int pass_count() const { return static_cast<int>(order_.passes().size()); }
  int pass_material(int pass) const { return at(pass).material; }
  std::int64_t pass_particles(int pass) const { return at(pass).last_visit - at(pass).first_visit; }
  template <class Stage> void for_each_block(int pass, Row *velocities, const Stage &stage) {
    static_assert(InTurn<Stage>::value);
    machine_.visit_blocks(stage, order_.pairs(velocities), order_.blocks(at(pass)));
  }

  // ----------------------------------------------------------------------------------------- over constraints ---

  static int constraint_width() { return TeamOverConstraints::W; }
  template <class Stage> void for_each_constraint(int first_batch, int last_batch, const Stage &stage) {
    constexpr int W = TeamOverConstraints::W;
    machine_.for_each((last_batch - first_batch) * W, OverConstraints<Stage>{stage, first_batch * W});
  }

  // ---------------------------------------------------------------------------------------------------- time ---

  // Begins to take the time.
  double lap() { return machine_.lap(); }
  // Tells a schedule what passed since the previous call; the machine may do so as late as the end of the session.
  void lap(Schedule &schedule, int stage, std::uint64_t items) { machine_.lap(schedule, stage, items); }

private:
  const typename TileVisitOrder<Machine>::Pass &at(int pass) const {
    return order_.passes()[static_cast<std::size_t>(pass)];
  }
  TileCandidates candidates(const CellTable &table) {
    const TilePairs pairs = order_.pairs(nullptr);
    return {table.x,      table.y,      table.z,
            table.keys,   table.starts, {table.grid.size[0], table.grid.size[1], table.grid.size[2]},
            pairs.visits, pairs.indices};
  }

  Machine machine_;
  TileVisitOrder<Machine> order_;
};

} // namespace loam
