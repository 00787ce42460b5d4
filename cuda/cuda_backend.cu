// The solver on the CUDA executor.
#include "cuda_executor.h"
#include "solver/solver.h"

namespace loam {

template class Solver<CudaExecutor>;

bool cuda_available() { return cuda_problem().empty(); }

std::unique_ptr<Backend> make_cuda_backend(const SolverSettings &solver, const ExecutionSettings &execution) {
  return std::make_unique<Solver<CudaExecutor>>(solver, execution);
}

} // namespace loam
