#include "bands.h"

#include <cmath>
#include <cstdio>

namespace loam::accuracy {

namespace {

constexpr Form tensor = {}, scalar = {LOAM_SOLVER_GAUSS_SEIDEL, LOAM_MULTIPLIER_SCALAR}, jacobi = {LOAM_SOLVER_JACOBI};

struct Band {
  const char *effect, *name, *error_name;
  Setting setting;
  double least, most; // of the error's size
};

constexpr char middle[] = "E 1e5 Pa", exact_drop[] = "drop over the exact one",
               inside[] = "plasticity within the iterations";
constexpr char shape[] = "shape over that of the finest setting", run_out[] = "run-out over the finest setting";
constexpr char front[] = "front over Martin and Moyce", stretch[] = "stretch over the closed form";

/* A setting that converges stands beside one that must not: the controls. */
constexpr Band bands[] = {
    {"beam", middle, exact_drop, {tensor, 1e-3, 5}, 0.002, 0.03},
    {"beam", middle, exact_drop, {tensor, 1e-3, 10}, 0, 0.008},
    {"beam", middle, exact_drop, {tensor, 2e-3, 10}, 0.008, 0.06},
    {"beam", middle, exact_drop, {tensor, 2e-3, 2}, 0.5, 10},
    {"beam", middle, exact_drop, {scalar, 1e-3, 5}, 0.003, 0.04},
    {"beam", middle, exact_drop, {jacobi, 1e-3, 10}, 0.1, 0.6},
    {"beam", middle, "drop over finite elements", {tensor, 1e-3, 10}, 0.2, 0.4},
    {"beam", middle, "drop over finite elements", {scalar, 1e-3, 10}, 0.6, 0.9},
    {"iterations", middle, "drop over that with 10 iterations", {tensor, 1e-3, 40}, 0, 0.03},
    {"one step", middle, "velocity", {tensor, 1e-3, 20}, 0, 0.01},
    {"one step", middle, "velocity", {tensor, 1e-3, 5}, 0.3, 2},
    {"one step", middle, "velocity", {scalar, 1e-3, 20}, 0.4, 1.2}, // no number of iterations mends it
    {"sand", "slab", run_out, {tensor, 1e-3, 5}, 0, 0.15},
    {"sand", "slab", "run-out over the experiment", {tensor, 1e-3, 5}, 0, 0.2},
    {"snow", inside, shape, {tensor, 2.5e-4, 5}, 0, 0.02},
    {"snow", inside, shape, {tensor, 1e-3, 5}, 0.005, 0.05},
    {"snow", inside, shape, {jacobi, 1e-3, 5}, 0.15, 0.8},
    {"snow", "plasticity after the substep", shape, {tensor, 1e-3, 5}, 0.05, 0.2},
    {"dam", "n^2 = 2", front, {tensor, 1e-3, 5}, 0, 0.06},
    {"dam", "n^2 = 2", front, {jacobi, 2e-3, 5}, 0, 0.06},
    {"cloth", "soft sheet", stretch, {tensor, 1 / 960.0, 20}, 0, 0.05},
    {"cloth", "soft sheet", stretch, {tensor, 1 / 240.0, 5}, 0.8, 4},
    {"cloth", "strip", "sag over the catenary", {tensor, 1 / 240.0, 5}, 0, 0.03},
    {"penetration", "into a groove", "depth over the radius of a grain", {tensor, 4e-3, 5}, 0, 0.02},
    {"penetration", "into a groove", "depth over the radius of a grain", {jacobi, 4e-3, 5}, 0, 0.05},
};

/* What one setting costs over another of the same experiment. */
struct Ratio {
  const char *effect, *name;
  Setting of, over;
  double least, most;
};
constexpr Ratio ratios[] = {
    {"beam", middle, {tensor, 1e-3, 10}, {tensor, 1e-3, 2}, 1.4, 4},
    {"beam", middle, {tensor, 1e-3, 5}, {tensor, 2e-3, 5}, 1.3, 3},
    {"beam", middle, {tensor, 1e-3, 5}, {scalar, 1e-3, 5}, 0.6, 1.7},
    {"beam", middle, {jacobi, 1e-3, 10}, {tensor, 1e-3, 10}, 0.8, 3},
    {"sand", "slab", {tensor, 1e-3, 5}, {tensor, 1e-3, 2}, 1.1, 2.6},
    {"dam", "n^2 = 2", {tensor, 1e-3, 5}, {tensor, 2e-3, 5}, 1.3, 3},
};

bool is_of(const Row &row, const char *effect, const char *name, const Setting &setting) {
  return row.effect == effect && row.name == name && row.preset.empty() && row.solver == setting.form.solver_name() &&
         row.multiplier == setting.form.multiplier_name() && std::fabs(row.substep / setting.substep - 1) < 1e-6 &&
         row.iterations == setting.iterations;
}

bool measured(const Study &study, const char *effect) {
  for (const Row &row : study.rows())
    if (row.effect == effect) return true;
  return false;
}

std::string text(const char *effect, const char *name, const Setting &setting) {
  return std::string(effect) + ", " + name + ", " + setting.form.solver_name() + " " + setting.form.multiplier_name() +
         ", " + std::to_string(1e3 * setting.substep) + " ms, " + std::to_string(setting.iterations) + " iterations";
}

bool within(double value, double least, double most, const std::string &what) {
  if (value >= least && value <= most) return true; // not so for what is no number
  std::fprintf(stderr, "outside of its band: %s: %g is not within %g and %g\n", what.c_str(), value, least, most);
  return false;
}

} // namespace

int count_outside_bands(const Study &study) {
  int outside = 0;
  for (const Band &band : bands) {
    if (!measured(study, band.effect)) continue;
    double error = std::nan("");
    for (const Row &row : study.rows())
      if (is_of(row, band.effect, band.name, band.setting) && row.error_name == band.error_name)
        error = std::fabs(row.error);
    outside +=
        within(error, band.least, band.most, text(band.effect, band.name, band.setting) + ", " + band.error_name) ? 0 : 1;
  }
  const auto seconds = [&](const Ratio &ratio, const Setting &setting) {
    for (const Row &row : study.rows())
      if (is_of(row, ratio.effect, ratio.name, setting)) return row.seconds_per_second;
    return std::nan("");
  };
  for (const Ratio &ratio : ratios)
    if (measured(study, ratio.effect))
      outside += within(seconds(ratio, ratio.of) / seconds(ratio, ratio.over), ratio.least, ratio.most,
                        "time of " + text(ratio.effect, ratio.name, ratio.of) + " over " +
                            text(ratio.effect, ratio.name, ratio.over))
                     ? 0
                     : 1;
  return outside;
}

} // namespace loam::accuracy
