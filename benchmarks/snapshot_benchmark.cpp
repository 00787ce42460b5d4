/* Saving and restoring a world of moving particles: milliseconds, and bytes a particle. */
#include "case.h"

#include <chrono>
#include <cstddef>
#include <vector>

namespace loam::benchmarks {

namespace {

scenes::World moving_world(const Case &measured, std::uint32_t multiplier) {
  const scenes::Scene scene = scene_of(measured);
  loam_world_def def = scenes::world_def(scene);
  def.backend = measured.backend;
  def.thread_count = measured.threads;
  def.substeps = substeps;
  def.iterations = iterations;
  def.multiplier = multiplier;
  scenes::World world(def, scene);
  for (int step = 0; step < warm_up_steps; ++step) world.step(substeps * substep_seconds);
  return world;
}

} // namespace

void run_snapshot(benchmark::State &state, const Case &measured, std::uint32_t multiplier, bool restoring) {
  try {
    const scenes::World world = moving_world(measured, multiplier);
    std::uint64_t size = 0;
    scenes::require(loam_snapshot_size(world.get(), &size), "loam_snapshot_size");
    std::vector<std::byte> bytes(size);
    scenes::require(loam_snapshot_save(world.get(), bytes.data(), size, nullptr), "loam_snapshot_save");
    double least = std::numeric_limits<double>::max();
    for ([[maybe_unused]] auto _ : state) {
      const auto begin = std::chrono::steady_clock::now();
      if (restoring)
        scenes::require(loam_snapshot_restore(world.get(), bytes.data(), size), "loam_snapshot_restore");
      else
        scenes::require(loam_snapshot_save(world.get(), bytes.data(), size, nullptr), "loam_snapshot_save");
      const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
      least = std::min(least, seconds);
      state.SetIterationTime(seconds);
    }
    state.counters["least_ms"] = 1e3 * least;
    state.counters["bytes/particle"] = double(size) / double(measured.particles);
  } catch (const std::exception &error) {
    state.SkipWithError(error.what());
  }
}

} // namespace loam::benchmarks
