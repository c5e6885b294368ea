#include "analysis/parallel/thread_pool.h"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>
#include <pmmintrin.h>
#include <xmmintrin.h>

namespace lacuna {

struct ThreadPool::Impl {
  tbb::global_control limit;
  tbb::task_arena arena;
  explicit Impl(int threads)
      : limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads)),
        arena(threads) {}
};

ThreadPool::ThreadPool(int threads)
    : threads_(threads > 0 ? threads : tbb::this_task_arena::max_concurrency()) {
  impl_ = std::make_unique<Impl>(threads_);
}

ThreadPool::~ThreadPool() = default;

void ThreadPool::for_each(int n, const std::function<void(int)>& body) const {
  impl_->arena.execute([&] {
    tbb::parallel_for(
        0, n,
        [&](int i) {
          // Set where the work is done: pool threads may have served somebody else before.
          _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
          _MM_SET_DENORMALS_ZERO_MODE(_MM_DENORMALS_ZERO_ON);
          body(i);
        },
        tbb::simple_partitioner());
  });
}

}  // namespace lacuna
