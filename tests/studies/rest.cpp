/* Ten minutes of a heap of sand that rests: how far its particles creep, and whether it gains energy. Step 1 ms, 2208 particles; about 1300 s on one core.
 *
 * Prints a line for each minute. The exit status is 0 if
 *   - no particle has moved by more than 1 % of a particle's radius (half a kernel radius) since the heap had settled, and
 *   - the greatest kinetic energy of the second half is not over that of the first; energies with which the whole heap would take the ten minutes to move so far
 *     count as none. */
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <map>
#include <string>
#include <unistd.h>

#include <CLI/CLI.hpp>

#include "scenes.h"

namespace loam {
namespace {

constexpr double frame = 0.02; // seconds
constexpr std::uint32_t substeps = 20;
constexpr double greatest_creep = 0.01; // of a particle's radius

struct Options {
  std::uint32_t solver = LOAM_SOLVER_GAUSS_SEIDEL;
  std::uint32_t threads = 1;
  double settling = 10, seconds = 600;
};

class Rest {
public:
  explicit Rest(const Options &options)
      : options_(options), scene_(scenes::resting_pile(scenes::sand(), 18, 20)),
        world_(definition(options, scene_), scene_) {}

  bool run() {
    std::printf("%zu particles, substeps of %g ms, %g s to settle\n", scene_.count(), 1000 * frame / substeps,
                options_.settling);
    const double settling = watch(options_.settling, "settling");
    settled_ = world_.snapshot();
    std::printf("settled: %.3g J, %.3g J at most on the way\n", world_.statistics().kinetic_energy, settling);
    std::printf("seconds, mean creep and greatest creep in particle radii, kinetic energy and its greatest in J, greatest "
                "speed in m/s\n");
    const int minutes = std::max(2, int(std::ceil(options_.seconds / 60 - 1e-9)));
    double halves[2] = {0, 0}, greatest = 0;
    for (int minute = 0; minute < minutes; ++minute) {
      const double peak = watch(options_.seconds / minutes, "resting");
      halves[2 * minute / minutes] = std::max(halves[2 * minute / minutes], peak);
      const auto [mean, most] = creep();
      greatest = std::max(greatest, most);
      const loam_statistics now = world_.statistics();
      if (now.non_finite > 0) throw std::runtime_error("particles are not finite");
      std::printf("%g, %.3g, %.3g, %.3g, %.3g, %.3g\n", options_.seconds * (minute + 1) / minutes, mean, most,
                  now.kinetic_energy, peak, now.max_speed);
      std::fflush(stdout);
    }
    const bool stays = greatest <= greatest_creep, calm = halves[1] <= std::max(halves[0], negligible());
    std::printf("greatest creep %.3g of a particle's radius (at most %g): %s\n", greatest, greatest_creep,
                stays ? "good" : "TOO FAR");
    std::printf("greatest kinetic energy %.3g J in the first half, %.3g J in the second (%.3g J count as none): %s\n",
                halves[0], halves[1], negligible(), calm ? "good" : "GROWING");
    return stays && calm;
  }

private:
  static loam_world_def definition(const Options &options, const scenes::Scene &scene) {
    loam_world_def def = scenes::world_def(scene);
    def.substeps = substeps;
    def.solver = options.solver;
    def.thread_count = options.threads;
    return def;
  }

  /* The greatest kinetic energy at the end of a frame. */
  double watch(double seconds, const char *what) {
    const int frames = std::max(1, int(std::lround(seconds / frame)));
    const bool terminal = isatty(STDERR_FILENO) != 0;
    double greatest = 0;
    for (int k = 0; k < frames; ++k) {
      world_.step(float(frame));
      greatest = std::max(greatest, world_.statistics().kinetic_energy);
      if (terminal && k % 10 == 0) std::fprintf(stderr, "\r%s: %.1f of %g s ", what, frame * k, seconds);
    }
    if (terminal) std::fprintf(stderr, "\r\033[K");
    return greatest;
  }

  double radius() const { return 0.5 * double(scene_.spacing); }

  double negligible() const {
    const double mass = double(scene_.count()) * double(scene_.material.density) * double(scene_.volume());
    const double speed = greatest_creep * radius() / 600;
    return 0.5 * mass * speed * speed;
  }

  struct Creep {
    double mean, greatest; // in particle radii
  };
  Creep creep() const {
    const scenes::Snapshot now = world_.snapshot();
    Creep creep = {0, 0};
    for (std::size_t i = 0; i < now.positions.size(); i += 3) {
      const auto moved = [&](std::size_t k) { return double(now.positions[i + k]) - double(settled_.positions[i + k]); };
      const double distance = std::hypot(moved(0), moved(1), moved(2)) / radius();
      creep.mean += distance / double(now.count());
      creep.greatest = std::max(creep.greatest, distance);
    }
    return creep;
  }

  Options options_;
  scenes::Scene scene_;
  scenes::World world_;
  scenes::Snapshot settled_;
};

} // namespace
} // namespace loam

int main(int argc, char **argv) {
  loam::Options options;
  CLI::App app("Watches a heap of sand rest: does it creep, does it gain energy?");
  app.add_option("--solver", options.solver)
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, std::uint32_t>{{"gauss_seidel", LOAM_SOLVER_GAUSS_SEIDEL}, {"jacobi", LOAM_SOLVER_JACOBI}}));
  app.add_option("--seconds", options.seconds, "to watch, 600 unless said otherwise")->check(CLI::Range(1.0, 1e5));
  app.add_option("--settling", options.settling, "seconds before, 10 unless said otherwise")->check(CLI::Range(0.1, 1e5));
  app.add_option("--threads", options.threads, "1 unless said otherwise")->check(CLI::Range(1u, 256u));
  CLI11_PARSE(app, argc, argv);
  try {
    return loam::Rest(options).run() ? 0 : 1;
  } catch (const std::exception &error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
}
