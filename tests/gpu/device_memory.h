// Reading a mapped CUDA buffer with the driver alone, which is looked for at run time: tests need no CUDA to be built.
#pragma once

#include <cstddef>
#include <cstring>
#include <dlfcn.h>
#include <loam/particles.h>
#include <stdexcept>
#include <string>

namespace loam::test {

class DeviceMemory {
public:
  DeviceMemory() : library_(dlopen("libcuda.so.1", RTLD_NOW)) {
    if (library_ == nullptr) throw std::runtime_error("there is a CUDA world but no libcuda.so.1");
    copy_ = function<Copy>("cuMemcpyDtoH_v2");
    attribute_ = function<Attribute>("cuPointerGetAttribute");
  }
  ~DeviceMemory() { dlclose(library_); }
  DeviceMemory(const DeviceMemory &) = delete;
  DeviceMemory &operator=(const DeviceMemory &) = delete;

  // Of the device itself: neither host memory nor managed memory.
  bool owns(const void *pointer) const {
    constexpr int memory_type = 2, is_managed = 8, device = 2; // CU_POINTER_ATTRIBUTE_*, CU_MEMORYTYPE_DEVICE
    unsigned type = 0, managed = 0;
    const auto address = reinterpret_cast<unsigned long long>(pointer);
    return attribute_(&type, memory_type, address) == 0 && type == device &&
           attribute_(&managed, is_managed, address) == 0 && (managed & 1u) == 0;
  }
  void read(void *to, const void *from, std::size_t bytes) const {
    const int result = copy_(to, reinterpret_cast<unsigned long long>(from), bytes);
    if (result != 0) throw std::runtime_error("cuMemcpyDtoH gave " + std::to_string(result));
  }

private:
  using Copy = int (*)(void *, unsigned long long, std::size_t);
  using Attribute = int (*)(void *, int, unsigned long long);
  template <class F> F function(const char *name) {
    void *symbol = dlsym(library_, name);
    if (symbol == nullptr) throw std::runtime_error(std::string("libcuda.so.1 has no ") + name);
    return reinterpret_cast<F>(symbol);
  }
  void *library_;
  Copy copy_;
  Attribute attribute_;
};

// A copy from mapped buffers, in whichever memory they are.
inline void read_mapped(const loam_particle_view &view, void *to, const void *from, std::size_t bytes) {
  if (view.memory == LOAM_MEMORY_CUDA_DEVICE)
    DeviceMemory().read(to, from, bytes);
  else
    std::memcpy(to, from, bytes);
}

} // namespace loam::test
