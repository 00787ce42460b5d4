// The solver on the CPU executor.
#include "cpu/cpu_executor.h"
#include "solver/solver.h"

namespace loam {

std::unique_ptr<Backend> make_cpu_backend(const SolverSettings &solver, const ExecutionSettings &execution) {
  return std::make_unique<Solver<CpuExecutor>>(solver, execution);
}

} // namespace loam
