#include "device_memory.h"

#include <cuda_runtime_api.h>
#include <fmt/format.h>

#include "error.h"

namespace runner {

void copy_from_device(void *to, const void *from, std::size_t bytes) {
  const cudaError_t result = cudaMemcpy(to, from, bytes, cudaMemcpyDeviceToHost);
  if (result != cudaSuccess) throw Error(fmt::format("copying particles from the GPU: {}", cudaGetErrorString(result)));
}

} // namespace runner
