// Arrays in device memory; twin of HostArray.
#pragma once

#include <type_traits>
#include <utility>

#include "device.h"

namespace loam {

// A plain array of trivially copyable elements that only kernels and copies touch. reserve() keeps nothing and does not shrink.
template <class T> class DeviceArray {
  static_assert(std::is_trivially_copyable_v<T>);

public:
  DeviceArray() = default;
  explicit DeviceArray(CudaDevice &device) : device_(&device) {}
  DeviceArray(const DeviceArray &) = delete;
  DeviceArray &operator=(const DeviceArray &) = delete;
  DeviceArray(DeviceArray &&other) noexcept { swap(other); }
  DeviceArray &operator=(DeviceArray &&other) noexcept {
    swap(other);
    return *this;
  }
  ~DeviceArray() { free(); }

  // Room for `count` elements, zeroed when new memory had to be taken. The old contents are lost then. If memory is refused, the
  // array is as it was.
  void reserve(std::size_t count) {
    if (count <= capacity_) return;
    DeviceArray fresh(*device_);
    fresh.data_ = static_cast<T *>(device_->allocate(count * sizeof(T)));
    fresh.capacity_ = count;
    swap(fresh);
  }
  void free() noexcept {
    if (data_ != nullptr) device_->release(data_);
    data_ = nullptr;
    capacity_ = 0;
  }
  void swap(DeviceArray &other) noexcept {
    std::swap(device_, other.device_);
    std::swap(data_, other.data_);
    std::swap(capacity_, other.capacity_);
  }

  T *data() { return data_; }
  const T *data() const { return data_; }
  std::size_t capacity() const { return capacity_; }
  std::size_t bytes() const { return capacity_ * sizeof(T); }

private:
  CudaDevice *device_ = nullptr;
  T *data_ = nullptr;
  std::size_t capacity_ = 0;
};

} // namespace loam
