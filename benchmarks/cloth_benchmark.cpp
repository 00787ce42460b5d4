/* A hanging cloth alone: nanoseconds a constraint and iteration.
 *
 * Others count a constraint for every edge, of the grid and of its diagonals, and one for every bent edge: 237 606 on 200 x 200 vertices. The library itself has three a
 * triangle, one a bent edge, and threads on top, which are counted nowhere: their time is in the figure. */
#include "case.h"

#include "support/cloths.h"

namespace loam::benchmarks {

namespace {

constexpr std::uint32_t cloth_iterations = 10;

} // namespace

void run_cloth(benchmark::State &state, std::uint32_t vertices_a_side, std::uint32_t threads) {
  try {
    const std::uint32_t n = vertices_a_side - 1;
    const cloths::Grid grid(n, n, 0.005f);
    const double grid_edges = 2.0 * n * (n + 1), diagonals = double(n) * n, bent = grid_edges + diagonals - 4.0 * n;
    const double constraints = grid_edges + diagonals + bent;
    loam_world_def def = cloths::world_def(cloth_iterations, 1);
    def.thread_count = threads;
    scenes::World world(def);
    const cloths::Cloth cloth(world.get(), cloths::definition(grid));
    cloth.attach({grid.at(0, 0), grid.at(n, 0)});
    for (int step = 0; step < 60; ++step) world.step(1.0f / 60);

    double solve = std::numeric_limits<double>::max(), whole = solve;
    for ([[maybe_unused]] auto _ : state) {
      world.step(1.0f / 60);
      for (const loam_stage &stage : world.stages())
        if (std::string(stage.name) == "solve cloth") solve = std::min(solve, stage.seconds);
      const double seconds = world.statistics().step_seconds;
      whole = std::min(whole, seconds);
      state.SetIterationTime(seconds);
    }
    state.counters["constraints"] = constraints;
    state.counters["ns/constraint/iteration"] = 1e9 * solve / (constraints * cloth_iterations);
    state.counters["with the whole step"] = 1e9 * whole / (constraints * cloth_iterations);
    if (!cloth.vertices().finite()) state.SkipWithError("the cloth is not finite");
  } catch (const std::exception &error) {
    state.SkipWithError(error.what());
  }
}

} // namespace loam::benchmarks
