#include "server/keeper/retention.h"

#include <gtest/gtest.h>

#include "jobs/queue/store.h"
#include "tests/temporary_folder.h"

namespace lacuna {
namespace {

using Ids = std::vector<std::string>;
constexpr std::chrono::system_clock::time_point now{std::chrono::hours(24 * 20000)};

JobEntry job(const std::string& id, int days_ago, bool over = true,
             const std::string& reference = {}) {
  JobEntry entry;
  entry.id = id;
  entry.reference = reference;
  entry.state.state = over ? State::done : State::running;
  entry.state.finished = over ? utc_text(now - std::chrono::hours(24 * days_ago)) : "";
  return entry;
}

CareSettings keep(std::size_t jobs, double days) {
  CareSettings settings;
  settings.keep_jobs = jobs;
  settings.keep_days = days;
  return settings;
}

/// What goes of these jobs, where these sweeps are not over.
Ids gone(const std::vector<JobEntry>& jobs, const CareSettings& settings,
         const Ids& unfinished_sweeps = {}) {
  const TemporaryFolder temp;
  Store store(temp / "lacuna.db");
  store.change([&](StoreChange& c) {
    for (JobEntry entry : jobs) c.add(entry);
    for (const std::string& id : unfinished_sweeps) {
      SweepEntry sweep;
      sweep.id = id;
      c.add(sweep);
    }
  });
  return outdated(store.removable(), settings, now);
}

TEST(Retention, KeepsEverythingUnlessAsked) {
  EXPECT_EQ(gone({job("a", 9000), job("b", 1)}, {}), Ids{});
}

TEST(Retention, TheOldestGoWhenThereAreMore) {
  const std::vector<JobEntry> jobs{job("a", 4), job("b", 3), job("c", 0, false), job("d", 1)};
  EXPECT_EQ(gone(jobs, keep(2, 0)), Ids{"a"}) << "what runs does not count";
  EXPECT_EQ(gone(jobs, keep(1, 0)), (Ids{"a", "b"}));
  EXPECT_EQ(gone(jobs, keep(3, 0)), Ids{});
}

TEST(Retention, ThoseThatEndedLongAgoGo) {
  const std::vector<JobEntry> jobs{job("a", 4), job("b", 3), job("c", 1)};
  EXPECT_EQ(gone(jobs, keep(0, 2.5)), (Ids{"a", "b"}));
  EXPECT_EQ(gone(jobs, keep(0, 5)), Ids{});
}

TEST(Retention, AMachineWhoseClockIsBehindEndsNoJobBeforeItWasPosted) {
  JobEntry behind = job("a", 9);
  behind.state.created = utc_text(now - std::chrono::hours(1));
  EXPECT_EQ(gone({behind}, keep(0, 2)), Ids{});
  behind.state.created = utc_text(now - std::chrono::hours(24 * 3));
  EXPECT_EQ(gone({behind}, keep(0, 2)), Ids{"a"});
}

TEST(Retention, NeverAReference) {
  const std::vector<JobEntry> jobs{job("a", 100), job("b", 90, true, "a")};
  EXPECT_EQ(gone(jobs, keep(0, 1)), Ids{"b"});
  EXPECT_EQ(gone({jobs[0]}, keep(0, 1)), Ids{"a"}) << "once nothing names it";
}

TEST(Retention, NoRunOfASweepThatIsNotOver) {
  JobEntry run = job("a", 100);
  run.sweep = "s";
  const std::vector<JobEntry> jobs{run, job("b", 90), job("c", 80)};
  EXPECT_EQ(gone(jobs, keep(0, 1), {"s"}), (Ids{"b", "c"}));
  EXPECT_EQ(gone(jobs, keep(1, 0), {"s"}), Ids{"b"}) << "it does not count";
  EXPECT_EQ(gone(jobs, keep(1, 0), {"t"}), (Ids{"a", "b"}));
}

}  // namespace
}  // namespace lacuna
