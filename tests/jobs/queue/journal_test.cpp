#include "jobs/queue/journal.h"

#include <gtest/gtest.h>

#include <thread>

namespace lacuna {
namespace {

using namespace std::chrono_literals;

/// Events 1 to n of the jobs "0" to "n - 1".
void fill(Journal& journal, int n) {
  for (int i = 0; i < n; ++i) {
    journal.add({i + 1, JobEvent::Kind::changed, std::to_string(i), nullptr});
  }
}

TEST(Journal, GivesWhatCameAfter) {
  Journal journal;
  EXPECT_EQ(journal.last(), 0);
  fill(journal, 3);
  const auto events = journal.since(1, 0ms);
  ASSERT_TRUE(events);
  ASSERT_EQ(events->size(), 2U);
  EXPECT_EQ(events->front().number, 2);
  EXPECT_EQ(events->front().id, "1");
  EXPECT_TRUE(journal.since(3, 0ms)->empty());
}

TEST(Journal, SaysWhenItHasForgotten) {
  Journal journal;
  fill(journal, 9000);
  EXPECT_FALSE(journal.since(0, 0ms));
  const auto events = journal.since(8999, 0ms);
  ASSERT_TRUE(events);
  EXPECT_EQ(events->size(), 1U);
}

TEST(Journal, NumbersThatAreNotUsedAreNoGaps) {
  Journal journal;
  journal.start("db", 100);
  EXPECT_EQ(journal.last(), 100);
  EXPECT_FALSE(journal.since(99, 0ms)) << "nothing is known of what came before";
  journal.add({107, JobEvent::Kind::changed, "a", nullptr});
  journal.add({112, JobEvent::Kind::removed, "a", nullptr});
  EXPECT_EQ(journal.since(100, 0ms)->size(), 2U);
  EXPECT_EQ(journal.since(109, 0ms)->front().number, 112);
  EXPECT_EQ(journal.name(107), "db-107");
}

TEST(Journal, WaitsForNews) {
  Journal journal;
  std::thread other([&] { fill(journal, 1); });
  const auto events = journal.since(0, 1h);
  other.join();
  ASSERT_TRUE(events);
  EXPECT_EQ(events->size(), 1U);
}

TEST(Journal, KnowsItsOwnNamesOnly) {
  Journal journal;
  journal.start("db", 0);
  fill(journal, 2);
  EXPECT_EQ(journal.number(journal.name(2)), 2);
  EXPECT_EQ(journal.number(journal.name(0)), 0);
  EXPECT_FALSE(journal.number(journal.name(3))) << "of the future";
  for (const char* bad : {"", "2", "-2", "x-2"}) EXPECT_FALSE(journal.number(bad)) << bad;
  EXPECT_FALSE(journal.number(journal.name(2) + "0x"));
}

}  // namespace
}  // namespace lacuna
