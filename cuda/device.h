// The device, stream and memory of one world, and how failures of CUDA calls become Errors.
#pragma once

#include <cstddef>
#include <string>

#include <cuda_runtime_api.h>

namespace loam {

// Why CUDA cannot be used on this machine; empty where it can.
std::string cuda_problem();

// Throws Error DEVICE "<what>: <CUDA's text>" unless the result is success.
void check_cuda(cudaError_t result, const char *what);

// Makes a device the thread's current one for a while: hosts that use CUDA themselves keep theirs. An error that the host has left behind on the
// thread is dropped, or the next launch would be blamed for it.
class CurrentDevice {
public:
  explicit CurrentDevice(int device) {
    cudaGetLastError();
    if (cudaGetDevice(&before_) == cudaSuccess && before_ != device) changed_ = cudaSetDevice(device) == cudaSuccess;
  }
  ~CurrentDevice() {
    if (changed_) cudaSetDevice(before_);
  }
  CurrentDevice(const CurrentDevice &) = delete;
  CurrentDevice &operator=(const CurrentDevice &) = delete;

private:
  int before_ = 0;
  bool changed_ = false;
};

// Everything of a world goes through its one stream, in the order of the calls. Copies between host and device leave the host's memory free to be
// reused when they return.
class CudaDevice {
public:
  // On the thread's current device. Throws Error BACKEND_UNAVAILABLE where there is none.
  CudaDevice();
  ~CudaDevice();
  CudaDevice(const CudaDevice &) = delete;
  CudaDevice &operator=(const CudaDevice &) = delete;

  int number() const { return number_; }
  cudaStream_t stream() const { return stream_; }

  // Zeroed device memory, never managed memory. Throws Error OUT_OF_MEMORY with the size.
  void *allocate(std::size_t bytes);
  // Waits for what may still use it. After a failure of the device this does nothing.
  void release(void *memory) noexcept;

  void upload(void *to, const void *from, std::size_t bytes);
  void download(void *to, const void *from, std::size_t bytes); // waits
  void copy(void *to, const void *from, std::size_t bytes);
  void synchronize();

private:
  // Small uploads are staged here, so that they need not wait; places are used again after the next wait.
  static constexpr std::size_t upload_bytes = 65536, download_bytes = 4096;
  int number_ = 0;
  cudaStream_t stream_ = nullptr;
  char *staging_ = nullptr;
  std::size_t staged_ = 0;
};

} // namespace loam
