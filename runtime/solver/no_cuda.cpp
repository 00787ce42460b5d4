// Stands in for the CUDA backend in builds without it.
#include "scene/error.h"
#include "solver/backend.h"

namespace loam {

bool cuda_available() { return false; }

std::unique_ptr<Backend> make_cuda_backend(const SolverSettings &, const ExecutionSettings &) {
  throw Error(LOAM_ERROR_BACKEND_UNAVAILABLE, "this build of the library has no CUDA backend");
}

} // namespace loam
