#include "base/parallel/spares.h"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>

#include "base/parallel/thread_pool.h"

namespace lacuna {
namespace {

struct Scratch {
  std::atomic<int> users = 0;
};

TEST(Spares, AreNoMoreThanThreadsAndHaveOneUser) {
  Spares<Scratch> spares;
  std::atomic<int> made = 0, shared = 0;
  const auto make = [&] { return ++made, std::make_unique<Scratch>(); };
  const ThreadPool pool(3);
  pool.for_each(1000, [&](int) {
    spares.with(make, [&](Scratch& s) {
      if (++s.users > 1) ++shared;
      --s.users;
    });
  });
  EXPECT_GE(made, 1);
  EXPECT_LE(made, 3);
  EXPECT_EQ(shared, 0);
}

TEST(Spares, AreGivenUpWhereTheirUseThrows) {
  Spares<Scratch> spares;
  int made = 0;
  const auto make = [&] { return ++made, std::make_unique<Scratch>(); };
  const auto fail = [](Scratch&) { throw std::runtime_error("stop"); };
  EXPECT_THROW(spares.with(make, fail), std::runtime_error);
  spares.with(make, [](Scratch&) {});
  EXPECT_EQ(made, 2);
  spares.with(make, [](Scratch&) {});
  EXPECT_EQ(made, 2);
}

}  // namespace
}  // namespace lacuna
