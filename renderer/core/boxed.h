#pragma once

#include <memory>

namespace lacuna {

/// A value or none, on the heap: for what is rare and large in objects that are many. Copies copy
/// the value.
template <class T>
class Boxed {
 public:
  Boxed() = default;
  Boxed(const Boxed& o) : value_(o ? std::make_unique<T>(*o) : nullptr) {}
  Boxed(Boxed&&) noexcept = default;
  Boxed& operator=(const Boxed& o) { return *this = Boxed(o); }
  Boxed& operator=(Boxed&&) noexcept = default;
  Boxed& operator=(const T& value) {
    value_ = std::make_unique<T>(value);
    return *this;
  }
  ~Boxed() = default;
  T& emplace() { return *(value_ = std::make_unique<T>()); }

  explicit operator bool() const { return value_ != nullptr; }
  T* operator->() { return value_.get(); }
  const T* operator->() const { return value_.get(); }
  T& operator*() { return *value_; }
  const T& operator*() const { return *value_; }

 private:
  std::unique_ptr<T> value_;
};

}  // namespace lacuna
