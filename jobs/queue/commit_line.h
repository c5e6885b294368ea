#pragma once

#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <utility>
#include <vector>

namespace lacuna {

/// Group commit: while one thread commits, the changes of others collect, and one of them commits
/// all at once. So the disk's syncs per second do not limit the changes per second.
template <class Change>
class CommitLine {
 public:
  struct Waiting {
    const std::function<void(Change&)>* make;
    std::exception_ptr error = nullptr;  ///< why the change failed
    bool done = false;
  };
  using Batch = std::vector<Waiting*>;

  /// Returns once `commit` was called with `mine` in its batch, on this thread or another; calls do
  /// not overlap. `commit` does not throw.
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
