#include "tune.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "accuracy.h"
#include "error.h"
#include "progress_bar.h"
#include "run.h"
#include "simulation.h"

namespace runner {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

// Seconds that may go into finding the moments; what is measured there takes about as long again.
constexpr double seconds_of_walk = 40;
// An average error of a frame, in kernel radii, that nobody sees.
constexpr double unseen = 0.02;

struct Moment {
  Simulation::State state;
  std::vector<Vector3> before,
      reference; // places of particles and of vertices of cloth: at its beginning, and a frame later
};

std::vector<Vector3> places(const Simulation &simulation) {
  std::vector<Vector3> result = simulation.read_particles().positions;
  for (const Mesh &cloth : simulation.read_cloths())
    result.insert(result.end(), cloth.vertices.begin(), cloth.vertices.end());
  return result;
}

// Root of the mean square of distances; infinity where particles came or went differently.
double difference(const std::vector<Vector3> &a, const std::vector<Vector3> &b) {
  if (a.size() != b.size() || a.empty()) return a.empty() && b.empty() ? 0 : std::numeric_limits<double>::infinity();
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Vector3 d = a[i] - b[i];
    sum += double(d.x) * double(d.x) + double(d.y) * double(d.y) + double(d.z) * double(d.z);
  }
  return std::sqrt(sum / double(a.size()));
}

struct Measured {
  loam_accuracy_def setting;
  double substeps = 0, iterations = 0; // of a frame, on average over the moments
  double seconds = 0;                  // of a frame
  double error = 0;                    // kernel radii, root of the mean square over the moments
};

class Tuning {
public:
  explicit Tuning(Scene &scene) : scene_(scene), simulation_(scene) {}

  // Goes through the scene as it is, and keeps four moments of it.
  void walk() {
    const std::uint64_t every = std::max<std::uint64_t>(1, scene_.frames / 16);
    std::vector<Simulation::State> states;
    const Clock::time_point start = Clock::now();
    ProgressBar progress(scene_.frames);
    for (std::uint64_t frame = 1; frame <= scene_.frames && seconds_since(start) < seconds_of_walk; ++frame) {
      simulation_.step();
      if (frame % every == 0 || states.empty()) states.push_back(simulation_.save());
      progress.show(frame, "going through the scene");
    }
    for (const double share : {0.1, 0.4, 0.75, 0.95})
      moments_.push_back(
          {states[std::min(states.size() - 1, static_cast<std::size_t>(share * double(states.size())))], {}, {}});
  }

  void find_references() {
    ProgressBar progress(moments_.size(), "references");
    for (std::size_t i = 0; i < moments_.size(); ++i) {
      progress.show(i, "");
      Moment &moment = moments_[i];
      simulation_.restore(moment.state);
      moment.before = places(simulation_);
      simulation_.use_accuracy(parse_accuracy("reference"));
      simulation_.step();
      moment.reference = places(simulation_);
      motion_ = std::max(motion_, difference(moment.before, moment.reference) / radius());
    }
  }

  // Over the moments from `first` to before `last`.
  Measured measure(const loam_accuracy_def &setting, std::size_t first, std::size_t last) {
    Measured row;
    row.setting = setting;
    double squares = 0;
    const double count = double(last - first);
    for (std::size_t i = first; i < last; ++i) {
      double fastest = std::numeric_limits<double>::infinity();
      for (int round = 0; round < 2; ++round) { // the faster one: a machine has other things to do too
        simulation_.restore(moments_[i].state);
        simulation_.use_accuracy(setting);
        simulation_.step();
        fastest = std::min(fastest, simulation_.statistics().step_seconds);
      }
      const loam_statistics statistics = simulation_.statistics();
      row.seconds += fastest / count;
      row.substeps += statistics.substeps / count;
      row.iterations += double(statistics.iterations_done) / std::max(1u, statistics.substeps) / count;
      squares += std::pow(difference(places(simulation_), moments_[i].reference) / radius(), 2) / count;
    }
    row.error = std::sqrt(squares);
    return row;
  }

  std::size_t moment_count() const { return moments_.size(); }
  double motion() const { return motion_; }

private:
  double radius() const { return double(scene_.world.kernel_radius); }

  Scene &scene_;
  Simulation simulation_;
  std::vector<Moment> moments_;
  double motion_ = 0;
};

std::vector<loam_accuracy_def> candidates(const Scene &scene) {
  std::vector<std::string> names = {"fast", "balanced", "accurate", "tolerance=0.1", "tolerance=0.01"};
  for (const int substeps : {4, 8, 16, 32, 64, 128})
    for (const int iterations : {2, 4}) names.push_back(fmt::format("{}x{}", substeps, iterations));
  std::vector<loam_accuracy_def> settings;
  if (!scene.accuracy) names.push_back(fmt::format("{}x{}", scene.world.substeps, scene.world.iterations));
  for (const std::string &name : names) settings.push_back(parse_accuracy(name));
  if (scene.accuracy && scene.accuracy->mode != LOAM_ACCURACY_BUDGET) settings.push_back(*scene.accuracy);
  return settings;
}

void print(const Measured &row, const char *note) {
  fmt::print("{:>16} {:>9.1f} {:>11.1f} {:>12.2f} {:>12.4f}  {}\n", accuracy_text(row.setting), row.substeps, row.iterations,
             1e3 * row.seconds, row.error, note);
}

} // namespace

int tune(const Options &options) {
  Scene scene = prepare_scene(options);
  Tuning tuning(scene);
  tuning.walk();
  tuning.find_references();

  // The last moment is kept for checking.
  const std::size_t last = tuning.moment_count() - 1;
  std::vector<Measured> rows;
  {
    const std::vector<loam_accuracy_def> settings = candidates(scene);
    ProgressBar progress(settings.size(), "settings");
    for (const loam_accuracy_def &setting : settings) {
      progress.show(rows.size(), accuracy_text(setting));
      rows.push_back(tuning.measure(setting, 0, last));
    }
  }
  std::sort(rows.begin(), rows.end(), [](const Measured &a, const Measured &b) { return a.seconds < b.seconds; });

  fmt::print(
      "\n{}, frames of {:.3g} ms. The error is how far particles and cloth are from where the setting \"reference\" takes "
      "them in a frame\n"
      "(root of the mean square over them and {} moments of the scene), in kernel radii; they move by {:.3g} at most.\n\n",
      scene.title.empty() ? scene.path.string() : scene.title, 1e3 / scene.frame_rate, last, tuning.motion());
  fmt::print("{:>16} {:>9} {:>11} {:>12} {:>12}\n", "setting", "substeps", "iterations", "ms a frame", "error");
  double least = std::numeric_limits<double>::infinity();
  const Measured *good_enough = nullptr, *twice_as_good = nullptr, *best = nullptr;
  for (const Measured &row : rows) {
    // Nothing cheaper is as accurate.
    const bool worthwhile = row.error < least;
    least = std::min(least, row.error);
    print(row, worthwhile ? "*" : "");
    if (!worthwhile) continue;
    best = &row;
    if (good_enough == nullptr && row.error <= unseen) good_enough = &row;
    if (good_enough != nullptr && twice_as_good == nullptr && row.error <= 0.5 * good_enough->error) twice_as_good = &row;
  }
  fmt::print("\n* nothing that costs less is as accurate\n");
  if (good_enough == nullptr) {
    fmt::print("None is within {:g} kernel radii; the most accurate of these is taken.\n", unseen);
    good_enough = best;
  }
  if (good_enough == nullptr)
    throw Error("no setting could be compared with the reference: particles came or went differently");
  const Measured checked = tuning.measure(good_enough->setting, last, last + 1);
  fmt::print("Recommended: --accuracy {} ({:.2f} ms a frame, error {:.4f}). At another moment of the scene it took {:.2f} "
             "ms, with an error of {:.4f}.\n",
             accuracy_text(good_enough->setting), 1e3 * good_enough->seconds, good_enough->error, 1e3 * checked.seconds,
             checked.error);
  if (twice_as_good != nullptr)
    fmt::print("Twice as accurate: --accuracy {}, for {:.2f} times the time.\n", accuracy_text(twice_as_good->setting),
               twice_as_good->seconds / good_enough->seconds);
  return 0;
}

} // namespace runner
