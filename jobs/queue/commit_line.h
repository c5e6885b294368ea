#pragma once

#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <utility>
#include <vector>

namespace lacuna {

/// Group commit: while one thread commits, the changes of the others collect, and the next of them
/// commits all at once. So the number of changes in a second is not that of syncs of the disk.
template <class Change>
class CommitLine {
 public:
  struct Waiting {
    const std::function<void(Change&)>* make;
    std::exception_ptr error = nullptr;  ///< why it was not made
    bool done = false;
  };
  using Batch = std::vector<Waiting*>;

  /// Returns once `commit` has been called with `mine` in its batch, on this thread or another, by
  /// one thread at a time. `commit` does not throw.
  template <class Commit>
  void join(Waiting& mine, const Commit& commit) {
    std::unique_lock lock(mutex_);
    batch_.push_back(&mine);
    while (!mine.done) {
      if (committing_) {
        changed_.wait(lock);
        continue;
      }
      committing_ = true;
      const Batch batch = std::exchange(batch_, {});
      lock.unlock();
      commit(batch);
      lock.lock();
      committing_ = false;
      for (Waiting* w : batch) w->done = true;
      changed_.notify_all();
    }
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  Batch batch_;
  bool committing_ = false;
};

}  // namespace lacuna
