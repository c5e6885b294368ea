#include "base/parallel/thread_pool.h"

#include <gtest/gtest.h>
#include <pmmintrin.h>
#include <xmmintrin.h>

#include <atomic>
#include <limits>
#include <stdexcept>

namespace lacuna {
namespace {

constexpr float denormal = std::numeric_limits<float>::denorm_min();

// The caller works on the loop as well.
TEST(ThreadPool, LoopsFlushDenormalsAndLeaveTheCallerAsItWas) {
  _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_OFF);
  _MM_SET_DENORMALS_ZERO_MODE(_MM_DENORMALS_ZERO_OFF);
  volatile float small = denormal;
  std::atomic<int> kept = 0;
  const ThreadPool pool(1);
  pool.for_each(4, [&](int) { kept += small * 1 > 0 ? 1 : 0; });
  EXPECT_EQ(kept, 0);
  EXPECT_GT(small * 1, 0);
  EXPECT_THROW(pool.for_each(1, [](int) { throw std::runtime_error("stop"); }), std::runtime_error);
  EXPECT_GT(small * 1, 0);
}

}  // namespace
}  // namespace lacuna
