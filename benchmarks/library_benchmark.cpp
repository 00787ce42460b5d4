/* The library, through its public C interface, as a host runs it. One iteration of the benchmark is a step; its time is what the
 * library's statistics say. */
#include "case.h"

namespace loam::benchmarks {

namespace {

loam_world_def world_def(const Case &measured, const scenes::Scene &scene) {
  loam_world_def def = scenes::world_def(scene);
  def.backend = measured.backend;
  def.solver = measured.solver;
  def.instruction_set = measured.instruction_set;
  def.thread_count = measured.threads;
  def.substeps = substeps;
  def.iterations = iterations;
  return def;
}

bool is_solve(const loam_stage &stage) { return std::string(stage.name).rfind("solve ", 0) == 0; }

} // namespace

bool is_available(const Case &measured) {
  Case small = measured;
  small.particles = 8;
  const scenes::Scene scene = scene_of(small);
  const loam_world_def def = world_def(small, scene);
  loam_world *world = nullptr;
  const bool available = loam_world_create(&def, &world) == LOAM_OK;
  loam_world_destroy(world);
  return available;
}

void run_library(benchmark::State &state, const Case &measured) {
  try {
    const scenes::Scene scene = scene_of(measured);
    scenes::World world(world_def(measured, scene), scene);
    for (int step = 0; step < warm_up_steps; ++step) world.step(substeps * substep_seconds);

    Tally tally;
    std::vector<double> stage_seconds;
    for ([[maybe_unused]] auto _ : state) {
      world.step(substeps * substep_seconds);
      const loam_statistics statistics = world.statistics();
      const std::vector<loam_stage> stages = world.stages();
      double solve_seconds = 0;
      stage_seconds.resize(stages.size(), std::numeric_limits<double>::max());
      for (std::size_t stage = 0; stage < stages.size(); ++stage) {
        stage_seconds[stage] = std::min(stage_seconds[stage], stages[stage].seconds);
        if (is_solve(stages[stage])) solve_seconds += stages[stage].seconds;
      }
      tally.add(statistics.step_seconds, solve_seconds, double(statistics.pair_visits));
      state.SetIterationTime(statistics.step_seconds);
    }

    tally.write(state, measured.particles, substeps);
    state.counters["bytes/particle"] = double(world.memory_bytes()) / double(measured.particles);
    const std::vector<loam_stage> stages = world.stages();
    for (std::size_t stage = 0; stage < stages.size(); ++stage)
      state.counters[stage_counter_prefix + std::string(stages[stage].name)] +=
          1e9 * stage_seconds[stage] / double(measured.particles) / substeps;
    if (world.statistics().non_finite > 0) state.SkipWithError("particles are not finite");
  } catch (const std::exception &error) {
    state.SkipWithError(error.what());
  }
}

} // namespace loam::benchmarks
