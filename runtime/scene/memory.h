// Host memory through the host's allocator, and arrays in it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>
#include <utility>

#include <loam/base.h>

namespace loam {

// The allocator hook with its default. allocate() throws Error(OUT_OF_MEMORY) with the size; it never returns null.
class HostAllocator {
public:
  HostAllocator() = default;
  explicit HostAllocator(const loam_allocator &hooks) : hooks_(hooks) {}
  void *allocate(std::size_t bytes) const;
  void release(void *memory, std::size_t bytes) const noexcept;
  static constexpr std::size_t alignment = 64;

private:
  loam_allocator hooks_{};
};

// A plain array of trivially copyable elements, aligned to a cache line. resize() keeps nothing and does not shrink.
template <class T> class HostArray {
  static_assert(std::is_trivially_copyable_v<T>);

public:
  HostArray() = default;
  explicit HostArray(const HostAllocator &allocator) : allocator_(&allocator) {}
  HostArray(const HostArray &) = delete;
  HostArray &operator=(const HostArray &) = delete;
  HostArray(HostArray &&other) noexcept { swap(other); }
  HostArray &operator=(HostArray &&other) noexcept {
    swap(other);
    return *this;
  }
  ~HostArray() { free(); }

  // Room for `count` elements, zeroed when new memory had to be taken. The old contents are lost then. If memory is refused, the
  // array is as it was.
  void reserve(std::size_t count) {
    if (count <= capacity_) return;
    HostArray fresh(*allocator_);
    fresh.data_ = static_cast<T *>(allocator_->allocate(count * sizeof(T)));
    fresh.capacity_ = count;
    std::memset(static_cast<void *>(fresh.data_), 0, count * sizeof(T));
    swap(fresh);
  }
  void free() noexcept {
    if (data_ != nullptr) allocator_->release(data_, capacity_ * sizeof(T));
    data_ = nullptr;
    capacity_ = 0;
  }
  void swap(HostArray &other) noexcept {
    std::swap(allocator_, other.allocator_);
    std::swap(data_, other.data_);
    std::swap(capacity_, other.capacity_);
  }

  T *data() { return data_; }
  const T *data() const { return data_; }
  T &operator[](std::size_t i) { return data_[i]; }
  const T &operator[](std::size_t i) const { return data_[i]; }
  std::size_t capacity() const { return capacity_; }
  std::size_t bytes() const { return capacity_ * sizeof(T); }

private:
  const HostAllocator *allocator_ = nullptr;
  T *data_ = nullptr;
  std::size_t capacity_ = 0;
};

} // namespace loam
