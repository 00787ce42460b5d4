#include "device_memory.h"

#include "error.h"

namespace runner {

void copy_from_device(void *, const void *, std::size_t) {
  throw Error("this loam-run was built without CUDA and cannot read particles from a GPU; use --backend cpu");
}

} // namespace runner
