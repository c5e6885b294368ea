#include "server/tables/journal.h"

#include <gtest/gtest.h>

#include <thread>

namespace lacuna {
namespace {

using namespace std::chrono_literals;

void fill(Journal& journal, int n) {
  for (int i = 0; i < n; ++i) journal.add(JobEvent::Kind::state, std::to_string(i), nullptr);
}

TEST(Journal, GivesWhatCameAfter) {
  Journal journal;
  EXPECT_EQ(journal.last(), 0U);
  fill(journal, 3);
  const auto events = journal.since(1, 0ms);
  ASSERT_TRUE(events);
  ASSERT_EQ(events->size(), 2U);
  EXPECT_EQ(events->front().number, 2U);
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
  fill(journal, 2);
  EXPECT_EQ(journal.number(journal.name(2)), 2U);
  EXPECT_EQ(journal.number(journal.name(0)), 0U);
  EXPECT_FALSE(journal.number(journal.name(3))) << "of the future";
  for (const char* bad : {"", "2", "-2", "x-2"}) EXPECT_FALSE(journal.number(bad)) << bad;
  EXPECT_FALSE(journal.number(journal.name(2) + "0x"));
}

}  // namespace
}  // namespace lacuna
