#include "device.h"

#include <cstring>

#include "scene/error.h"

namespace loam {

namespace {

// Asked for in vain where the library has no machine code that the device could run.
__global__ void probe() {}

// Reading an error also clears it: a failure that has been dealt with must not be taken for one of the next call's.
std::string take_error(cudaError_t result) {
  cudaGetLastError();
  return cudaGetErrorString(result);
}

} // namespace

std::string cuda_problem() {
  int count = 0;
  cudaError_t result = cudaGetDeviceCount(&count);
  if (result != cudaSuccess) return "no CUDA device: " + take_error(result);
  if (count == 0) return "no CUDA device: the driver reports none";
  int device = 0;
  cudaFuncAttributes attributes = {};
  result = cudaGetDevice(&device);
  if (result == cudaSuccess) result = cudaFuncGetAttributes(&attributes, probe);
  if (result == cudaSuccess) return {};
  std::string text = "CUDA device " + std::to_string(device) + " cannot be used: " + take_error(result);
  cudaDeviceProp properties;
  if (cudaGetDeviceProperties(&properties, device) == cudaSuccess)
    text += format(" (%s, compute capability %d.%d)", properties.name, properties.major, properties.minor);
  return text;
}

void check_cuda(cudaError_t result, const char *what) {
  if (result == cudaSuccess) return;
  const loam_status status = result == cudaErrorMemoryAllocation ? LOAM_ERROR_OUT_OF_MEMORY : LOAM_ERROR_DEVICE;
  throw Error(status, std::string(what) + ": " + take_error(result));
}

CudaDevice::CudaDevice() {
  const std::string problem = cuda_problem();
  if (!problem.empty()) throw Error(LOAM_ERROR_BACKEND_UNAVAILABLE, problem);
  check_cuda(cudaGetDevice(&number_), "cudaGetDevice");
  check_cuda(cudaStreamCreateWithFlags(&stream_, cudaStreamNonBlocking), "cudaStreamCreate");
  const cudaError_t result = cudaMallocHost(reinterpret_cast<void **>(&staging_), upload_bytes + download_bytes);
  if (result == cudaSuccess) return;
  cudaStreamDestroy(stream_);
  check_cuda(result, "cudaMallocHost");
}

CudaDevice::~CudaDevice() {
  const CurrentDevice current(number_);
  cudaStreamSynchronize(stream_);
  cudaFreeHost(staging_);
  cudaStreamDestroy(stream_);
}

void *CudaDevice::allocate(std::size_t bytes) {
  const CurrentDevice current(number_);
  void *memory = nullptr;
  const cudaError_t result = cudaMalloc(&memory, bytes);
  if (result == cudaErrorMemoryAllocation) {
    cudaGetLastError();
    throw Error(LOAM_ERROR_OUT_OF_MEMORY, format("CUDA device %d refused %zu bytes", number_, bytes));
  }
  check_cuda(result, "cudaMalloc");
  const cudaError_t zeroed = cudaMemsetAsync(memory, 0, bytes, stream_);
  if (zeroed != cudaSuccess) {
    cudaFree(memory);
    check_cuda(zeroed, "cudaMemset");
  }
  return memory;
}

void CudaDevice::release(void *memory) noexcept {
  const CurrentDevice current(number_);
  cudaStreamSynchronize(stream_);
  cudaFree(memory);
}

void CudaDevice::upload(void *to, const void *from, std::size_t bytes) {
  if (bytes == 0) return;
  const CurrentDevice current(number_);
  const std::size_t room = (bytes + 15) / 16 * 16;
  if (room > upload_bytes) {
    check_cuda(cudaMemcpyAsync(to, from, bytes, cudaMemcpyHostToDevice, stream_), "copying to the device");
    synchronize();
    return;
  }
  if (staged_ + room > upload_bytes) synchronize();
  std::memcpy(staging_ + staged_, from, bytes);
  check_cuda(cudaMemcpyAsync(to, staging_ + staged_, bytes, cudaMemcpyHostToDevice, stream_), "copying to the device");
  staged_ += room;
}

void CudaDevice::download(void *to, const void *from, std::size_t bytes) {
  if (bytes == 0) return;
  const CurrentDevice current(number_);
  const bool small = bytes <= download_bytes;
  char *place = small ? staging_ + upload_bytes : static_cast<char *>(to);
  check_cuda(cudaMemcpyAsync(place, from, bytes, cudaMemcpyDeviceToHost, stream_), "copying from the device");
  synchronize();
  if (small) std::memcpy(to, place, bytes);
}

void CudaDevice::copy(void *to, const void *from, std::size_t bytes) {
  if (bytes == 0) return;
  const CurrentDevice current(number_);
  check_cuda(cudaMemcpyAsync(to, from, bytes, cudaMemcpyDeviceToDevice, stream_), "copying on the device");
}

void CudaDevice::synchronize() {
  check_cuda(cudaStreamSynchronize(stream_), "waiting for the device");
  staged_ = 0;
}

} // namespace loam
