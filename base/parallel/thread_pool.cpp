#include "base/parallel/thread_pool.h"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>
#include <pmmintrin.h>
#include <xmmintrin.h>

#include <atomic>
#include <utility>

namespace lacuna {
namespace {

/// Gives ThreadSanitizer the order that it cannot see in TBB, which is not instrumented: all calls
/// of a loop happen after what precedes the loop, and before what follows it.
class LoopOrder {
#ifdef __SANITIZE_THREAD__
 public:
  void enter() { (void)calls_.load(std::memory_order_acquire); }
  void leave() { calls_.fetch_add(1, std::memory_order_release); }

 private:
  std::atomic<int> calls_{0};
#else
 public:
  void enter() {}
  void leave() {}
#endif
};

}  // namespace

struct ThreadPool::Impl {
  tbb::global_control limit;
  tbb::task_arena arena;
  explicit Impl(int threads)
      : limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads)),
        arena(threads) {}
};

ThreadPool::ThreadPool(int threads, std::function<bool()> stop)
    : threads_(threads > 0 ? threads : tbb::this_task_arena::max_concurrency()),
      stop_(std::move(stop)) {
  impl_ = std::make_unique<Impl>(threads_);
  log_ = std::make_unique<WorkLog>(threads_);
}

ThreadPool::~ThreadPool() = default;

namespace {

/// Restores the caller's rounding and denormal modes, which its share of a loop changes.
class KeptControl {
 public:
  ~KeptControl() { _mm_setcsr(control_); }

 private:
  const unsigned control_ = _mm_getcsr();
};

/// Records a loop, also one that throws.
class LoggedLoop {
 public:
  explicit LoggedLoop(WorkLog& log) : recorded(log.begin_loop()), log_(log) {}
  ~LoggedLoop() {
    if (recorded) log_.end_loop();
  }
  const bool recorded;

 private:
  WorkLog& log_;
};

}  // namespace

void ThreadPool::for_each(int n, const std::function<void(int)>& body) const {
  const KeptControl kept;
  LoopOrder order;
  order.leave();
  const LoggedLoop loop(*log_);
  impl_->arena.execute([&] {
    tbb::parallel_for(
        0, n,
        [&](int i) {
          // Set in each body: pool threads may have run other work before.
          _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
          _MM_SET_DENORMALS_ZERO_MODE(_MM_DENORMALS_ZERO_ON);
          order.enter();
          check_stop();
          if (loop.recorded) {
            log_->run(tbb::this_task_arena::current_thread_index(), i, body);
          } else {
            body(i);
          }
          order.leave();
        },
        tbb::simple_partitioner());
  });
  order.enter();
}

}  // namespace lacuna
