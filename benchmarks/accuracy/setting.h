/* What a game chooses between accuracy and time. */
#pragma once

#include <cstdint>
#include <string>

#include <loam/loam.h>

namespace loam::accuracy {

/* How constraints are visited, and the form of their multipliers. */
struct Form {
  std::uint32_t solver = LOAM_SOLVER_GAUSS_SEIDEL, multiplier = LOAM_MULTIPLIER_PROJECTED_TENSOR;

  std::string solver_name() const { return solver == LOAM_SOLVER_JACOBI ? "jacobi" : "gauss_seidel"; }
  std::string multiplier_name() const { return multiplier == LOAM_MULTIPLIER_SCALAR ? "scalar" : "tensor"; }
};

inline constexpr Form all_forms[] = {{LOAM_SOLVER_GAUSS_SEIDEL, LOAM_MULTIPLIER_PROJECTED_TENSOR},
                                     {LOAM_SOLVER_GAUSS_SEIDEL, LOAM_MULTIPLIER_SCALAR},
                                     {LOAM_SOLVER_JACOBI, LOAM_MULTIPLIER_PROJECTED_TENSOR},
                                     {LOAM_SOLVER_JACOBI, LOAM_MULTIPLIER_SCALAR}};

inline constexpr const char *preset_names[] = {"fast", "balanced", "accurate", "reference"}; // LOAM_ACCURACY_PRESET_FAST ...

struct Setting {
  Form form;
  double substep = 1e-3; // seconds; of a preset the whole frame, for the library cuts it
  std::uint32_t iterations = 5;
  int preset = -1; // of the library, or none

  /* On one thread, so that times are steady. The substep is the experiment's to set. */
  void apply(loam_world_def &def) const {
    def.backend = LOAM_BACKEND_CPU;
    def.thread_count = 1;
    def.solver = form.solver;
    def.multiplier = form.multiplier;
    def.iterations = iterations;
  }
};

} // namespace loam::accuracy
