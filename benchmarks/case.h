/* What is measured: a block of particles in motion, on one machine configuration, by the library or by the scalar reference. */
#pragma once

#include "scenes.h"

#include <benchmark/benchmark.h>
#include <limits>

namespace loam::benchmarks {

struct Case {
  std::string name; // of the configuration; the particle count follows it
  std::size_t particles = 65536;
  loam_material_def material = scenes::sand();
  std::uint32_t backend = LOAM_BACKEND_CPU;
  std::uint32_t solver = LOAM_SOLVER_GAUSS_SEIDEL;
  std::uint32_t instruction_set = LOAM_INSTRUCTION_SET_AUTO;
  std::uint32_t threads = 1;
};

/* Everyone measures the same stretch of the same motion. */
inline constexpr float substep_seconds = 5e-4f;
inline constexpr int iterations = 5;
inline constexpr int substeps =
    4; /* of a step; a host's step has several too, and shares what is done once a step among them */
inline constexpr int warm_up_steps = 3;
inline int measured_steps(std::size_t particles) { return particles > 100000 ? 4 : particles > 20000 ? 8 : 20; }

/* A block that is sheared and collapses. Of the materials of main.cpp all but rubber yield everywhere, and rubber is strained everywhere. */
inline scenes::Scene scene_of(const Case &measured) { return scenes::jittered_block(measured.material, measured.particles); }

/* Names of counters, which the table at the end reads back. Rates are those of the fastest step: whatever else the machine does
 * only ever adds time. A pair visit is one neighbour pair in one iteration. */
inline constexpr const char *solve_rate_counter = "solve_visits/s";
inline constexpr const char *step_rate_counter = "step_visits/s";
inline constexpr const char *stage_counter_prefix = "ns/particle: "; // followed by the stage's name

/* Collects steps or substeps and writes the counters. */
class Tally {
public:
  void add(double step_seconds, double solve_seconds, double pair_visits) {
    if (pair_visits <= 0) return;
    step_ = std::min(step_, step_seconds / pair_visits);
    solve_ = std::min(solve_, solve_seconds / pair_visits);
    pair_visits_ = pair_visits;
  }

  /* Each sample was of so many substeps. */
  void write(benchmark::State &state, std::size_t particles, int substeps_of_sample) const {
    const double visits_per_particle = pair_visits_ / double(particles) / substeps_of_sample;
    state.counters[solve_rate_counter] = solve_ > 0 ? 1 / solve_ : 0;
    state.counters[step_rate_counter] = 1 / step_;
    state.counters["ns/particle/substep"] = 1e9 * step_ * visits_per_particle;
    state.counters["neighbours"] = visits_per_particle / iterations;
  }

private:
  double step_ = std::numeric_limits<double>::max(), solve_ = step_; // seconds a pair visit
  double pair_visits_ = 0;                                           // in the last sample
};

void run_library(benchmark::State &state, const Case &measured);
void run_reference(benchmark::State &state, const Case &measured);
void run_snapshot(benchmark::State &state, const Case &measured, std::uint32_t multiplier, bool restoring);

void run_cloth(benchmark::State &state, std::uint32_t vertices_a_side, std::uint32_t threads);

/* Whether the library has this backend and instruction set here. */
bool is_available(const Case &measured);

} // namespace loam::benchmarks
