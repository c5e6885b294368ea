#include "server/queue/retention.h"

#include <gtest/gtest.h>

namespace lacuna {
namespace {

using Ids = std::vector<std::string>;
constexpr std::chrono::system_clock::time_point now{std::chrono::hours(24 * 20000)};

EntryPtr job(const std::string& id, int days_ago, bool over = true,
             const std::string& reference = {}) {
  auto entry = std::make_shared<JobEntry>();
  entry->id = id;
  entry->over = over;
  entry->reference = reference;
  entry->state.state = over ? State::done : State::running;
  entry->state.finished = over ? utc_text(now - std::chrono::hours(24 * days_ago)) : "";
  return entry;
}

CareSettings keep(std::size_t jobs, double days) {
  CareSettings settings;
  settings.keep_jobs = jobs;
  settings.keep_days = days;
  return settings;
}

TEST(Retention, KeepsEverythingUnlessAsked) {
  EXPECT_EQ(outdated({job("a", 9000), job("b", 1)}, {}, {}, now), Ids{});
}

TEST(Retention, TheOldestGoWhenThereAreMore) {
  const std::vector<EntryPtr> jobs{job("a", 4), job("b", 3), job("c", 0, false), job("d", 1)};
  EXPECT_EQ(outdated(jobs, {}, keep(2, 0), now), Ids{"a"}) << "what runs does not count";
  EXPECT_EQ(outdated(jobs, {}, keep(1, 0), now), (Ids{"a", "b"}));
  EXPECT_EQ(outdated(jobs, {}, keep(3, 0), now), Ids{});
}

TEST(Retention, ThoseThatEndedLongAgoGo) {
  const std::vector<EntryPtr> jobs{job("a", 4), job("b", 3), job("c", 1)};
  EXPECT_EQ(outdated(jobs, {}, keep(0, 2.5), now), (Ids{"a", "b"}));
  EXPECT_EQ(outdated(jobs, {}, keep(0, 5), now), Ids{});
}

TEST(Retention, NeverAReferenceNorADamagedOne) {
  auto damaged = std::make_shared<JobEntry>(*job("d", 100));
  damaged->damaged = true;
  const std::vector<EntryPtr> jobs{job("a", 100), job("b", 90, true, "a"), damaged};
  EXPECT_EQ(outdated(jobs, {}, keep(0, 1), now), Ids{"b"});
  EXPECT_EQ(outdated({jobs[0]}, {}, keep(0, 1), now), Ids{"a"}) << "once nothing names it";
}

TEST(Retention, NoRunOfASweepThatIsNotOver) {
  auto run = std::make_shared<JobEntry>(*job("a", 100));
  run->sweep = "s";
  const std::vector<EntryPtr> jobs{run, job("b", 90), job("c", 80)};
  EXPECT_EQ(outdated(jobs, {"s"}, keep(0, 1), now), (Ids{"b", "c"}));
  EXPECT_EQ(outdated(jobs, {"s"}, keep(1, 0), now), Ids{"b"}) << "it does not count";
  EXPECT_EQ(outdated(jobs, {"t"}, keep(1, 0), now), (Ids{"a", "b"}));
}

}  // namespace
}  // namespace lacuna
