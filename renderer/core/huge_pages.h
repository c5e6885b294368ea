#pragma once

#include <sys/mman.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>
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

/// Reserves room for `n` elements of an empty vector, in 2 MiB pages where it spans whole ones.
template <class T>
void reserve_huge(std::vector<T>& empty, std::size_t n) {
  constexpr std::uintptr_t page = std::uintptr_t{2} << 20;
  empty.reserve(n);
  const auto begin = reinterpret_cast<std::uintptr_t>(empty.data());
  const std::uintptr_t first = (begin + page - 1) / page * page;
  const std::uintptr_t last = (begin + n * sizeof(T)) / page * page;
  if (first < last) madvise(reinterpret_cast<void*>(first), last - first, MADV_HUGEPAGE);  // a hint
}

template <class T>
using HugeVector = std::vector<T, HugePageAllocator<T>>;

/// Elements that are all written before they are read, by several threads: resize() touches no
/// memory, which a vector would clear with one thread.
template <class T>
class HugeArray {
  static_assert(std::is_trivially_destructible_v<T>);

 public:
  HugeArray() = default;
  ~HugeArray() { HugePageAllocator<T>().deallocate(data_, capacity_); }
  HugeArray(HugeArray&& o) noexcept
      : data_(std::exchange(o.data_, nullptr)),
        size_(std::exchange(o.size_, 0)),
        capacity_(std::exchange(o.capacity_, 0)) {}
  HugeArray& operator=(HugeArray&& o) noexcept {
    std::swap(data_, o.data_);
    std::swap(size_, o.size_);
    std::swap(capacity_, o.capacity_);
    return *this;
  }

  /// All elements become undefined: set() begins the life of each.
  void resize(std::size_t n) {
    size_ = n;
    if (n <= capacity_) return;
    HugePageAllocator<T>().deallocate(std::exchange(data_, nullptr), std::exchange(capacity_, 0));
    const std::size_t more = n + n / 16;  // iterations differ a little
    data_ = HugePageAllocator<T>().allocate(more);
    capacity_ = more;
  }
  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  T* begin() { return data_; }
  T* end() { return data_ + size_; }
  const T* begin() const { return data_; }
  const T* end() const { return data_ + size_; }
  void set(std::size_t i, const T& value) { std::construct_at(data_ + i, value); }
  const T& operator[](std::size_t i) const { return data_[i]; }

 private:
  T* data_ = nullptr;
  std::size_t size_ = 0, capacity_ = 0;
};

}  // namespace lacuna
