/* The plain scalar reference in single precision on the same scenes, so that the library's speed is a ratio within one run. */
#include "case.h"
#include "from_scene.h"

namespace loam::benchmarks {

void run_reference(benchmark::State &state, const Case &measured) {
  try {
    const scenes::Scene scene = scene_of(measured);
    reference::Settings settings = reference::settings_for(scene);
    settings.iterations = iterations;
    auto solver = reference::solver_for<float>(scene, settings);
    for (int substep = 0; substep < warm_up_steps * substeps; ++substep) solver.substep(substep_seconds);

    Tally tally;
    for ([[maybe_unused]] auto _ : state) {
      const reference::StageSeconds before = solver.seconds();
      const std::uint64_t visits_before = solver.pair_visits();
      solver.substep(substep_seconds);
      const double seconds = solver.seconds().total() - before.total();
      tally.add(seconds, solver.seconds().solve - before.solve, double(solver.pair_visits() - visits_before));
      state.SetIterationTime(seconds);
    }
    tally.write(state, measured.particles, 1);

    const reference::StageSeconds total = solver.seconds();
    const double particle_substeps =
        double(measured.particles) * (warm_up_steps * substeps + measured_steps(measured.particles));
    const std::pair<const char *, double> stages[] = {{"sort", total.sort},
                                                      {"neighbour search", total.neighbour_search},
                                                      {"gradients", total.gradients},
                                                      {"solve", total.solve},
                                                      {"position correction", total.position_correction},
                                                      {"contacts", total.contacts},
                                                      {"velocity smoothing", total.velocity_smoothing},
                                                      {"strain", total.strain},
                                                      {"advance", total.advance}};
    for (const auto &[name, seconds] : stages)
      state.counters[std::string(stage_counter_prefix) + name] =
          1e9 * seconds / particle_substeps; // the mean, for orientation
  } catch (const std::exception &error) {
    state.SkipWithError(error.what());
  }
}

} // namespace loam::benchmarks
