#include "base/parallel/staggered_rows.h"

#include <immintrin.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <vector>

namespace lacuna {
namespace {

/// The runnable tasks, and the progress of each column.
class Stagger {
 public:
  Stagger(int columns, const std::function<void(int, int)>& body,
          const std::function<bool(int)>& another)
      : done_(static_cast<std::size_t>(columns)),
        begun_(static_cast<std::size_t>(columns)),
        body_(body),
        another_(another) {
    offer(0, 0);
  }

  /// Runs tasks until none is left; for several threads. Waits only while another thread works.
  void work() {
    std::unique_lock lock(mutex_);
    for (;;) {
      if (ready_.empty()) {
        if (running_ == 0) break;
        wait(lock);
        continue;
      }
      const auto [row, column] = ready_.front();
      ready_.pop_front();
      ++running_;
      count_ready();
      lock.unlock();
      const bool more = run(row, column);
      lock.lock();
      --running_;
      if (more && !failure_) finish(row, column);
      if (failure_) ready_.clear();
      count_ready();
      if (!ready_.empty() || running_ == 0) changed_.notify_all();
    }
  }

  void rethrow() const {
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  struct Task {
    int row, column;
  };

  int last() const { return static_cast<int>(done_.size()) - 1; }
  int& of(std::vector<int>& rows, int column) { return rows[static_cast<std::size_t>(column)]; }

  /// Returns false if no task follows.
  bool run(int row, int column) {
    try {
      body_(row, column);
      return column < last() || another_(row);
    } catch (...) {
      const std::lock_guard lock(mutex_);
      if (!failure_) failure_ = std::current_exception();
      return false;
    }
  }

  void finish(int row, int column) {
    of(done_, column) = row + 1;
    if (column > 0) offer(row + 1, column - 1);
    if (column < last()) offer(row, column + 1);
    if (column == last()) offer(row + 1, column);
  }
  void offer(int row, int column) {
    if (of(begun_, column) != row) return;  // already offered, or not its turn
    if (column > 0 && of(done_, column - 1) <= row) return;
    if (of(done_, std::min(column + 1, last())) < row) return;
    of(begun_, column) = row + 1;
    ready_.push_back({row, column});
  }

  /// Spins first: most waits are shorter than it takes to go to sleep.
  void wait(std::unique_lock<std::mutex>& lock) {
    lock.unlock();
    for (int i = 0; i < 400 && ready_count_.load(std::memory_order_relaxed) == 0; ++i) _mm_pause();
    lock.lock();
    if (ready_.empty() && running_ > 0) changed_.wait(lock);
  }
  void count_ready() { ready_count_.store(ready_.size(), std::memory_order_relaxed); }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Task> ready_;
  std::atomic<std::size_t> ready_count_{0};
  std::vector<int> done_, begun_;  // rows, by column
  int running_ = 0;
  std::exception_ptr failure_;
  const std::function<void(int, int)>& body_;
  const std::function<bool(int)>& another_;
};

}  // namespace

void staggered_rows(const ThreadPool* pool, int columns,
                    const std::function<void(int row, int column)>& body,
                    const std::function<bool(int row)>& another) {
  const std::function<void(int, int)> checked = [&](int row, int column) {
    if (pool != nullptr) pool->check_stop();
    body(row, column);
  };
  if (pool == nullptr || pool->threads() == 1 || columns == 1) {
    for (int row = 0;; ++row) {
      for (int column = 0; column < columns; ++column) checked(row, column);
      if (!another(row)) return;
    }
  }
  Stagger stagger(columns, checked, another);
  pool->for_each(pool->threads(), [&](int) { stagger.work(); });
  stagger.rethrow();
}

}  // namespace lacuna
