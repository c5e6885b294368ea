#pragma once

#include <sys/mman.h>

#include <cstddef>
#include <new>
#include <vector>

namespace lacuna {

/// Allocates memory in 2 MiB pages: with small pages, the random reads of large tables by every ray
/// would spend their time on address translation.
template <class T>
struct HugePageAllocator {
  using value_type = T;
  static constexpr std::size_t page = std::size_t{2} << 20;

  HugePageAllocator() = default;
  template <class U>
  explicit HugePageAllocator(const HugePageAllocator<U>&) {}

  T* allocate(std::size_t n) {
    const std::size_t bytes = n * sizeof(T);
    if (bytes < page) return static_cast<T*>(::operator new (bytes, std::align_val_t{alignof(T)}));
    void* memory = ::operator new (bytes, std::align_val_t{page});
    madvise(memory, bytes, MADV_HUGEPAGE);  // a hint: if it fails, pages are small
    return static_cast<T*>(memory);
  }
  void deallocate(T* memory, std::size_t n) {
    ::operator delete (memory, std::align_val_t{n * sizeof(T) < page ? alignof(T) : page});
  }
  bool operator==(const HugePageAllocator&) const = default;
};

template <class T>
using HugeVector = std::vector<T, HugePageAllocator<T>>;

}  // namespace lacuna
