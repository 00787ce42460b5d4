#include "run.h"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <thread>

#include <fmt/format.h>
#include <tbb/global_control.h>

#include "accuracy.h"
#include "containment.h"
#include "error.h"
#include "output_folder.h"
#include "picture/renderer.h"
#include "ply_writer.h"
#include "progress_bar.h"
#include "run_statistics.h"
#include "scene_reader.h"
#include "simulation.h"

namespace runner {
namespace {

volatile std::sig_atomic_t interrupted = 0;

void on_interrupt(int) { interrupted = 1; }

std::uint64_t count_watched(const Scene &scene, const Particles &particles) {
  if (!scene.watch) return 0;
  const SceneWatch &box = *scene.watch;
  return static_cast<std::uint64_t>(std::count_if(particles.positions.begin(), particles.positions.end(), [&](Vector3 x) {
    return x.x >= box.low.x && x.x <= box.high.x && x.y >= box.low.y && x.y <= box.high.y && x.z >= box.low.z &&
           x.z <= box.high.z;
  }));
}

bool due(std::uint64_t frame, std::uint64_t every) { return every != 0 && frame % every == 0; }

} // namespace

Scene prepare_scene(const Options &options) {
  Scene scene = read_scene(options.scene);
  if (options.scale != 1) scale_particle_count(scene, options.scale);
  scene.world.backend = options.backend;
  scene.world.instruction_set = options.instruction_set;
  scene.world.thread_count = options.threads;
  if (options.solver) scene.world.solver = *options.solver;
  if (options.accuracy) scene.accuracy = options.accuracy;
  if (options.until_still) {
    if (!scene.watch) throw Error(fmt::format("{}: --until-still needs a [watch] table in the scene", scene.path.string()));
    scene.frames *= 10; // a limit, should the region never empty
  }
  if (options.frames) scene.frames = *options.frames;
  return scene;
}

int run(const Options &options) {
  const auto previous_handler = std::signal(SIGINT, on_interrupt); // before the scene is filled, which may take long
  Scene scene = prepare_scene(options);
  const std::uint32_t threads = options.threads != 0 ? options.threads : std::max(1u, std::thread::hardware_concurrency());
  const tbb::global_control thread_limit(tbb::global_control::max_allowed_parallelism, threads);

  // Everything that can be wrong with the scene shows before anything is written.
  Simulation simulation(scene);
  std::optional<Renderer> renderer;
  const Particles start = simulation.read_particles();
  if (options.pictures && scene.camera) renderer.emplace(scene, start);
  const OutputFolder output(options.output);
  const Containment containment(scene, start);

  RunStatistics statistics;
  statistics.particles = simulation.particle_count();
  statistics.threads = threads;
  statistics.backend = simulation.backend();
  statistics.instruction_set = simulation.instruction_set();
  statistics.has_sides = containment.sides() != 0;
  fmt::print(stderr, "{}: {} particles, kernel radius {:.4g} m, accuracy {}, {} frames, {}{}{}, {} thread{}\n",
             scene.title.empty() ? scene.path.string() : scene.title, statistics.particles, scene.world.kernel_radius,
             accuracy_text(simulation.accuracy()), scene.frames, statistics.backend,
             statistics.instruction_set.empty() ? "" : " ", statistics.instruction_set, threads, threads == 1 ? "" : "s");

  double empty_frames = 0; // for how many frames the watched region has been empty
  {
    ProgressBar progress(scene.frames);
    for (std::uint64_t frame = 1; frame <= scene.frames && interrupted == 0; ++frame) {
      const auto start = std::chrono::steady_clock::now();
      simulation.step();
      statistics.step_seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
      statistics.add_stages(simulation.stages());

      FrameRecord record;
      record.frame = frame;
      record.time = static_cast<double>(frame) / scene.frame_rate;
      record.statistics = simulation.statistics();
      const Particles particles = simulation.read_particles();
      record.watched = count_watched(scene, particles);
      record.outside = containment.count_outside(particles, record.time);
      statistics.frames.push_back(record);

      if (due(frame, options.ply_every))
        output.write(fmt::format("frame_{:04}.ply", frame), make_ply(particles, fmt::format("time {:.6f} s", record.time)));
      if (renderer && due(frame, options.picture_every))
        output.write(fmt::format("frame_{:04}.png", frame),
                     make_png(renderer->render(particles, simulation.read_cloths(), record.time)));

      progress.show(frame, scene.watch ? fmt::format("{} left above", record.watched)
                                       : fmt::format("mean speed {:.3g} m/s", record.statistics.mean_speed));
      empty_frames = record.watched == 0 ? empty_frames + 1 : 0;
      if (options.until_still && empty_frames > *options.until_still * scene.frame_rate) break;
    }
  }
  std::signal(SIGINT, previous_handler);

  if (!statistics.frames.empty()) statistics.particles = statistics.frames.back().statistics.particles;
  statistics.interrupted = interrupted != 0;
  statistics.memory = simulation.memory();
  statistics.accuracy = accuracy_text(simulation.accuracy());
  statistics.over_budget = simulation.over_budget();
  statistics.state_hash = simulation.state_hash();
  output.write("series.csv", make_series_csv(statistics));
  output.write("stats.json", make_statistics_json(scene, statistics));
  fmt::print(stderr, "{} frames{}, {:.4g} s a frame for the simulation; results in {}\n", statistics.frames.size(),
             statistics.interrupted ? " (interrupted)" : "",
             statistics.frames.empty() ? 0.0 : statistics.step_seconds / static_cast<double>(statistics.frames.size()),
             output.path().string());
  return statistics.interrupted ? 130 : 0;
}

} // namespace runner
