/* loam-reference: runs the column collapse and its variants on the reference solver and prints what was measured beside what a
 * prototype of the method gave (run-out: 99.5 % of the particles).
 *
 *   loam-reference            the cases of the column, a minute or so
 *   loam-reference speed      pair visits per second of the solve loop
 *   loam-reference slab       plane strain: two aspect ratios
 *   loam-reference all        everything */
#include "from_scene.h"
#include "measures.h"

#include <cstdio>
#include <functional>
#include <string_view>

namespace {

using namespace loam;
using reference::Plasticity;
using reference::ScalarSolver;
using reference::Settings;
using scenes::Scene;

struct Case {
  const char *name;
  const char *expected;
  Scene scene;
  std::function<void(Settings &)> change = [](Settings &) {};
  double step = 5e-4;
  double duration = 0.6;
  bool corrects_volume = true;
};

template <typename Real> void run(const Case &study) {
  Settings settings = reference::settings_for(study.scene);
  settings.gravity[1] = -9.8;
  study.change(settings);
  auto material = reference::Material<Real>::from(study.scene.material);
  material.corrects_volume = study.corrects_volume;
  ScalarSolver<Real> solver(settings, material);
  solver.add_particles(study.scene.positions.data(), nullptr, study.scene.count(), double(study.scene.volume()));
  for (const scenes::Plane &plane : study.scene.planes) solver.add_plane(plane.point, plane.normal, double(plane.friction));

  const int steps = int(std::lround(study.duration / study.step));
  for (int step = 0; step < steps; ++step) solver.substep(Real(study.step));

  const auto nearest = reference::nearest_neighbours(solver);
  const double spacing = double(study.scene.spacing);
  std::printf("%-34s %-8s %.3f   J %.3f  nearest %.3f +- %.3f, least %.2f  virial %.3f  residual %.1e\n", study.name,
              study.expected, reference::run_out(solver, double(study.scene.length), study.scene.planar),
              std::exp(reference::mean_log_volume_change(solver)), nearest.mean / spacing, nearest.deviation / spacing,
              nearest.least / spacing, reference::virial(solver), solver.residual());
  std::fflush(stdout);
}

void column_cases() {
  const auto column = [](float angle = 30, float modulus = 1e6f, float friction = 1) {
    return scenes::axisymmetric_column(scenes::sand(angle, modulus), 12, 1, friction);
  };
  std::printf("axisymmetric column                expected measured (float)\n");
  run<float>({"base case", ".705", column()});
  run<float>({"semi-implicit plasticity", ".236", column(), [](Settings &s) { s.plasticity = Plasticity::semi_implicit; }});
  run<float>({"1 iteration", ".718", column(), [](Settings &s) { s.iterations = 1; }});
  run<float>({"h = 2 ms", ".753", column(), [](Settings &s) { s.velocity_smoothing = 5; }, 2e-3});
  run<float>({"20 degrees", ".919", column(20)});
  run<float>({"40 degrees", ".527", column(40)});
  run<float>({"ground friction .3", "1.158", column(30, 1e6f, 0.3f)});
  run<float>({"position correction off", ".628", column(), [](Settings &s) { s.minimum_distance = 0; }});
  run<float>({"volume correction off", ".678", column(), [](Settings &) {}, 5e-4, 0.6, false});
  run<float>({"no velocity smoothing", ".756", column(), [](Settings &s) { s.velocity_smoothing = 0; }});
  std::printf("                                            measured (double)\n");
  run<double>({"base case", ".705", column()});
}

void slab_cases() {
  std::printf("slab, 22.2 degrees, unsmoothed     expected measured (float)\n");
  const auto smooth = [](Settings &s) { s.velocity_smoothing = 0; };
  run<float>({"aspect 1", "1.34", scenes::slab(scenes::sand(22.2f), 20, 1), smooth, 5e-4, 0.8});
  run<float>({"aspect 2", "2.85", scenes::slab(scenes::sand(22.2f), 20, 2), smooth, 5e-4, 1.2});
}

/* The best of many substeps: other programs on the machine only ever add time. */
template <typename Real> void measure_speed(const char *name, std::size_t count) {
  const Scene scene = scenes::jittered_block(scenes::sand(), count);
  ScalarSolver<Real> solver = reference::solver_for<Real>(scene, reference::settings_for(scene));
  for (int step = 0; step < 10; ++step) solver.substep(Real(5e-4));

  const auto build_seconds = [&] {
    return solver.seconds().sort + solver.seconds().neighbour_search + solver.seconds().gradients;
  };
  double solve = 1e9, substep = 1e9, build = 1e9; // seconds a pair visit, the same, seconds a particle
  const int steps = int(std::max<std::size_t>(5, 1000000 / count));
  for (int step = 0; step < steps; ++step) {
    const auto before = solver.seconds();
    const double build_before = build_seconds();
    const auto visits_before = solver.pair_visits();
    solver.substep(Real(5e-4));
    const double visits = double(solver.pair_visits() - visits_before);
    solve = std::min(solve, (solver.seconds().solve - before.solve) / visits);
    substep = std::min(substep, (solver.seconds().total() - before.total()) / visits);
    build = std::min(build, (build_seconds() - build_before) / double(count));
  }
  const double neighbours = double(solver.neighbourhoods().pair_count()) / double(count);
  std::printf(
      "%-7s %7zu particles, %.1f neighbours: solve %.1f M pair visits/s (%.0f ns a visit of a particle), substep %.1f M, "
      "build %.0f ns a particle\n",
      name, count, neighbours, 1e-6 / solve, 1e9 * solve * neighbours, 1e-6 / substep, 1e9 * build);
}

} // namespace

int main(int argument_count, char **arguments) {
  const std::string_view what = argument_count > 1 ? arguments[1] : "column";
  if (what == "speed" || what == "all") {
    measure_speed<float>("float", 8192);
    measure_speed<float>("float", 65536);
    measure_speed<double>("double", 8192);
  }
  if (what == "column" || what == "all") column_cases();
  if (what == "slab" || what == "all") slab_cases();
  return 0;
}
