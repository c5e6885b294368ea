#include "server/http/connection_threads.h"

#include <gtest/gtest.h>

#include <atomic>
#include <latch>

namespace lacuna {
namespace {

TEST(ConnectionThreads, NoneWaitsForAnotherAndTheEndWaitsForAll) {
  constexpr int n = 100;
  std::atomic<int> ended{0};
  {
    ConnectionThreads threads(n);
    std::latch all(n);
    for (int i = 0; i < n; ++i) {
      threads.start([&] {
        all.arrive_and_wait();
        ++ended;
      });
    }
  }
  EXPECT_EQ(ended, n);
}

TEST(ConnectionThreads, AreNoMoreThanTheyMayBe) {
  std::atomic<int> running{0}, most{0}, ended{0};
  {
    ConnectionThreads threads(3);
    for (int i = 0; i < 300; ++i) {
      threads.start([&] {
        const int now = ++running;
        for (int seen = most; seen < now && !most.compare_exchange_weak(seen, now);) {
        }
        --running;
        ++ended;
      });
      EXPECT_LE(threads.count(), 3U);
    }
  }
  EXPECT_EQ(ended, 300);
  EXPECT_LE(most, 3);
}

TEST(ConnectionThreads, OutliveAnException) {
  ConnectionThreads threads(1);
  threads.start([] { throw std::runtime_error("as of a connection"); });
  std::latch next(1);
  threads.start([&] { next.count_down(); });
  next.wait();
}

}  // namespace
}  // namespace lacuna
