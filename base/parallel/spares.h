#pragma once

#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace lacuna {

/// Working memory that the steps of a parallel loop take in turn: as many objects are made as
/// threads run at once.
template <class T>
class Spares {
 public:
  /// Calls `use(object)` with an object that no other thread has; `make()`, a std::unique_ptr<T>,
  /// gives a new one. An object whose `use` throws is not used again.
  template <class Make, class Use>
  void with(Make&& make, Use&& use) {
    std::unique_ptr<T> object = take();
    if (object == nullptr) object = make();
    use(*object);
    const std::lock_guard lock(mutex_);
    spare_.push_back(std::move(object));
  }

 private:
  std::unique_ptr<T> take() {
    const std::lock_guard lock(mutex_);
    if (spare_.empty()) return nullptr;
    std::unique_ptr<T> object = std::move(spare_.back());
    spare_.pop_back();
    return object;
  }

  std::mutex mutex_;
  std::vector<std::unique_ptr<T>> spare_;
};

}  // namespace lacuna
