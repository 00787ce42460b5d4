// The CUDA executor: launches stages over items, particles and colours on a GPU, in its memory. Sibling of cpu/cpu_executor.h.
#pragma once

#include "cuda_machine.h"
#include "tile_executor.h"

namespace loam {

using CudaExecutor = TileExecutor<CudaMachine>;

} // namespace loam
