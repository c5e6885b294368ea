#include "base/parallel/work_log.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <stdexcept>

#include "base/parallel/thread_pool.h"

namespace lacuna {
namespace {

/// Work that a compiler cannot leave out.
void work(int n) {
  std::atomic<int> x = 0;
  for (int i = 0; i < n; ++i) ++x;
}

double total(const std::map<std::string, SectionTimes>& sections) {
  double sum = 0;
  for (const auto& [name, t] : sections) sum += t.serial + t.loops;
  return sum;
}

TEST(WorkLog, EveryMomentIsInOneSection) {
  using Clock = std::chrono::steady_clock;
  const auto outer_begin = Clock::now();
  const ThreadPool pool(2);
  const auto inner_begin = Clock::now();
  {
    const WorkSection outer(pool, "outer");
    work(20000);
    {
      const WorkSection inner(pool, "inner");
      pool.for_each(7, [](int) { work(2000); });
    }
    pool.for_each(3, [](int) { work(2000); });
  }
  work(20000);
  const auto inner_end = Clock::now();
  const auto sections = pool.log().sections();
  const auto outer_end = Clock::now();
  const auto seconds = [](auto d) { return std::chrono::duration<double>(d).count(); };
  EXPECT_GE(total(sections), seconds(inner_end - inner_begin));
  EXPECT_LE(total(sections), seconds(outer_end - outer_begin));

  EXPECT_EQ(sections.at("inner").bodies, 7U);
  EXPECT_EQ(sections.at("outer").bodies, 3U);
  EXPECT_EQ(sections.at("other").bodies, 0U);
  EXPECT_GT(sections.at("outer").serial, 0);
  EXPECT_GT(sections.at("other").serial, 0);
  for (const char* name : {"inner", "outer"}) {
    const SectionTimes& t = sections.at(name);
    EXPECT_GT(t.busy, 0) << name;
    EXPECT_GE(t.waiting(2), 0) << name;
  }
}

TEST(WorkLog, OnlyLoopsOfItsOwnThreadCount) {
  const ThreadPool pool(2);
  const WorkSection section(pool, "outer");
  pool.for_each(2, [&](int) {
    const WorkSection ignored(pool, "within");
    pool.for_each(5, [](int) { work(10); });
  });
  std::thread([&] {
    const WorkSection ignored(pool, "another thread");
    pool.for_each(5, [](int) { work(10); });
  }).join();
  EXPECT_THROW(pool.for_each(1, [](int) { throw std::runtime_error("stop"); }), std::runtime_error);
  pool.for_each(4, [](int) { work(10); });
  const auto sections = pool.log().sections();
  EXPECT_EQ(sections.size(), 2U);
  EXPECT_EQ(sections.at("outer").bodies, 2U + 1 + 4);
}

TEST(WorkLog, SpansOfAThreadFollowEachOther) {
  const ThreadPool pool(2);
  pool.for_each(3, [](int) { work(10); });  // before keep_spans()
  pool.log().keep_spans();
  const WorkSection section(pool, "loop");
  pool.for_each(50, [](int) { work(1000); });
  pool.for_each(50, [](int) { work(1000); });
  const auto sections = pool.log().sections();
  std::vector<int> found(100);
  double busy = 0;
  for (const auto& spans : pool.log().spans()) {
    double end = 0;
    for (const WorkLog::Span& s : spans) {
      EXPECT_LE(s.begin, s.end);
      EXPECT_GE(s.cpu, 0);
      EXPECT_GE(s.begin, end);
      end = s.end;
      if (s.body < 0) continue;
      EXPECT_EQ(pool.log().names()[s.section], "loop");
      busy += s.end - s.begin;
      ++found[static_cast<std::size_t>(s.body) + 50 * (s.loop - 1)];
    }
  }
  EXPECT_EQ(std::ranges::count(found, 1), 100);
  EXPECT_NEAR(busy, sections.at("loop").busy, 1e-9);
  EXPECT_EQ(pool.log().lost_spans(), 0U);
}

}  // namespace
}  // namespace lacuna
