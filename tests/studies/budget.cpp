/* Sand that steps to a budget; half-way as much again falls onto it. Is the mean frame what was asked for, before and after, and is the sand where it should be?
 *
 * Prints a line for each twenty frames. The exit status is 0 if the mean of the frames of each half is within 10 % of the budget, and in the end no grain is faster
 * than 2 m/s, under the ground or not finite. */
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>

#include <CLI/CLI.hpp>

#include "support/scenes.h"

namespace loam {
namespace {

struct Options {
  double milliseconds = 8;
  int frames = 240;
  int particles = 2000; // twice as many in the end
  std::uint32_t threads = 1;
};

class BudgetedSand {
public:
  explicit BudgetedSand(const Options &options)
      : options_(options), scene_(scenes::jittered_block(scenes::sand(), std::size_t(options.particles), 0)),
        world_(definition(), scene_) {
    loam_accuracy_def accuracy;
    scenes::require(loam_accuracy_def_default(&accuracy, sizeof accuracy), "loam_accuracy_def_default");
    accuracy.mode = LOAM_ACCURACY_BUDGET;
    accuracy.substeps = 0;
    accuracy.budget = float(1e-3 * options.milliseconds);
    scenes::require(loam_world_use_accuracy(world_.get(), &accuracy), "loam_world_use_accuracy");
  }

  bool run() {
    std::printf("frame, particles, milliseconds on average, substeps, iterations, greatest speed in m/s\n");
    const int half = options_.frames / 2;
    bool good = true;
    double sum = 0, sum_of_half = 0;
    for (int frame = 1; frame <= options_.frames; ++frame) {
      if (frame == half + 1) drop_as_much_again();
      const auto start = std::chrono::steady_clock::now();
      const loam_status status = loam_world_step(world_.get(), 1.0f / 60);
      const double milliseconds = 1e3 * std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
      if (status != LOAM_ERROR_BUDGET) scenes::require(status, "loam_world_step");
      sum += milliseconds;
      sum_of_half += milliseconds;
      const loam_statistics now = world_.statistics();
      if (frame % 20 == 0) {
        std::printf("%d, %llu, %.2f, %u, %u, %.3g%s\n", frame, static_cast<unsigned long long>(now.particles), sum / 20,
                    now.substeps, now.iterations, now.max_speed,
                    status == LOAM_ERROR_BUDGET ? ", stability needs more" : "");
        std::fflush(stdout);
        sum = 0;
      }
      if (frame % half == 0) {
        const double mean = sum_of_half / half;
        const bool kept = std::abs(mean / options_.milliseconds - 1) <= 0.1;
        std::printf("mean of %d frames: %.2f ms of %g: %s\n", half, mean, options_.milliseconds, kept ? "good" : "NOT KEPT");
        good = good && kept;
        sum_of_half = 0;
      }
    }
    return good && at_rest_on_the_ground();
  }

private:
  loam_world_def definition() const {
    loam_world_def def = scenes::world_def(scene_);
    def.thread_count = options_.threads;
    def.particle_capacity = 2 * scene_.count();
    return def;
  }
  void drop_as_much_again() {
    scenes::Scene more = scene_;
    more.planes.clear();
    for (std::size_t i = 1; i < more.positions.size(); i += 3) more.positions[i] += 0.3f;
    world_.add(more);
  }
  bool at_rest_on_the_ground() const {
    const loam_statistics now = world_.statistics();
    const scenes::Snapshot matter = world_.snapshot();
    float lowest = 1;
    for (std::size_t i = 1; i < matter.positions.size(); i += 3) lowest = std::min(lowest, matter.positions[i]);
    const bool good = now.non_finite == 0 && now.max_speed < 2 && lowest > 0;
    std::printf("greatest speed %.3g m/s, lowest centre %.4f m above the ground: %s\n", now.max_speed, double(lowest),
                good ? "good" : "NOT STABLE");
    return good;
  }

  Options options_;
  scenes::Scene scene_;
  scenes::World world_;
};

} // namespace
} // namespace loam

int main(int argc, char **argv) {
  loam::Options options;
  CLI::App app("Sand that steps to a budget, while its amount doubles");
  app.add_option("--milliseconds", options.milliseconds, "Of a frame")->check(CLI::Range(0.1, 1e4));
  app.add_option("--frames", options.frames, "Of a sixtieth of a second")->check(CLI::Range(40, 100000));
  app.add_option("--particles", options.particles, "At the start")->check(CLI::Range(100, 1000000));
  app.add_option("--threads", options.threads, "Threads; 0: as many as the machine has")->check(CLI::Range(0, 256));
  CLI11_PARSE(app, argc, argv);
  try {
    return loam::BudgetedSand(options).run() ? 0 : 1;
  } catch (const std::exception &error) {
    std::fprintf(stderr, "budget: %s\n", error.what());
    return 2;
  }
}
