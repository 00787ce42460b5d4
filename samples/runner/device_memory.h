// Copies from device memory, for worlds that run on CUDA.
#pragma once

#include <cstddef>

namespace runner {

// Throws Error if the copy fails, or if the runner was built without CUDA.
void copy_from_device(void *to, const void *from, std::size_t bytes);

} // namespace runner
