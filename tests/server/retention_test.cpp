#include "server/queue/retention.h"

#include <gtest/gtest.h>

#include "server/queue/queue.h"
#include "tests/server/no_executor.h"
#include "tests/temporary_folder.h"

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

TEST(Retention, AMachineWhoseClockIsBehindEndsNoJobBeforeItWasPosted) {
  auto behind = std::make_shared<JobEntry>(*job("a", 9));
  behind->state.created = utc_text(now - std::chrono::hours(1));
  EXPECT_EQ(outdated({behind}, {}, keep(0, 2), now), Ids{});
  behind->state.created = utc_text(now - std::chrono::hours(24 * 3));
  EXPECT_EQ(outdated({behind}, {}, keep(0, 2), now), Ids{"a"});
}

TEST(Retention, NeverAReferenceNorADamagedOne) {
  auto damaged = std::make_shared<JobEntry>(*job("d", 100));
  damaged->damaged = true;
  const std::vector<EntryPtr> jobs{job("a", 100), job("b", 90, true, "a"), damaged};
  EXPECT_EQ(outdated(jobs, {}, keep(0, 1), now), Ids{"b"});
  EXPECT_EQ(outdated({jobs[0]}, {}, keep(0, 1), now), Ids{"a"}) << "once nothing names it";
}

TEST(Retention, NothingAsLongAsAJobCannotBeRead) {
  const auto unread = unread_entry("u", std::runtime_error("not now"));
  EXPECT_EQ(outdated({job("a", 100), unread}, {}, keep(0, 1), now), Ids{}) << "it may need a";
}

TEST(Retention, NoRunOfASweepThatIsNotOver) {
  auto run = std::make_shared<JobEntry>(*job("a", 100));
  run->sweep = "s";
  const std::vector<EntryPtr> jobs{run, job("b", 90), job("c", 80)};
  EXPECT_EQ(outdated(jobs, {"s"}, keep(0, 1), now), (Ids{"b", "c"}));
  EXPECT_EQ(outdated(jobs, {"s"}, keep(1, 0), now), Ids{"b"}) << "it does not count";
  EXPECT_EQ(outdated(jobs, {"t"}, keep(1, 0), now), (Ids{"a", "b"}));
}

/// A queue over the folders of a data root.
class RetentionOnDisk : public testing::Test {
 protected:
  JobFolder make_job(const std::string& id, State state) {
    JobSpec spec;
    spec.scene = "a.glb";
    std::filesystem::create_directories(data.jobs());
    JobFolder folder = JobFolder::create(data.jobs() / id, spec);
    set_on_disk(folder, state);
    table.rescan();
    return folder;
  }
  static void set_on_disk(const JobFolder& folder, State state) {
    JobState changed = folder.read_state();
    changed.state = state;
    changed.finished = is_terminal(state) ? utc_text(now) : "";
    folder.write_state(changed);
  }

  TemporaryFolder temp;
  DataRoot data{temp.path()};
  SweepTable sweeps{data};
  JobTable table{data, sweeps};
  NoExecutor executor;
  DiskWatch disk{temp.path(), 0};
  Queue queue{executor, table, disk, {}};
};

TEST_F(RetentionOnDisk, AJobThatItsFolderSaysIsOverGoes) {
  const std::string id = "20260101-000000-aaaaaa";
  const JobFolder folder = make_job(id, State::done);
  queue.remove_outdated(id);
  EXPECT_FALSE(std::filesystem::exists(folder.dir()));
  EXPECT_EQ(table.find(id), nullptr);
}

// Somebody at a shell lets a job go on that the service knows as done.
TEST_F(RetentionOnDisk, AJobThatOnlyTheTableSaysIsOverStays) {
  const std::string id = "20260101-000000-aaaaaa";
  const JobFolder folder = make_job(id, State::done);
  for (const State state : {State::interrupted, State::running, State::queued}) {
    set_on_disk(folder, state);
    const auto later = std::chrono::system_clock::now() + std::chrono::hours(48);
    ASSERT_EQ(outdated(table.all(), {}, keep(0, 1), later), Ids{id});
    EXPECT_THROW(queue.remove_outdated(id), Conflict) << enum_name(state);
    EXPECT_TRUE(std::filesystem::exists(folder.file("job.json")));
    EXPECT_NE(table.find(id), nullptr);
  }
  set_on_disk(folder, State::done);
  queue.remove_outdated(id);
  EXPECT_FALSE(std::filesystem::exists(folder.dir()));
}

TEST_F(RetentionOnDisk, AJobWhoseFolderSaysNothingStays) {
  const std::string id = "20260101-000000-aaaaaa";
  const JobFolder folder = make_job(id, State::done);
  temp.write("jobs/" + id + "/state.json", "{");
  EXPECT_ANY_THROW(queue.remove_outdated(id));
  EXPECT_TRUE(std::filesystem::exists(folder.file("job.json")));
}

}  // namespace
}  // namespace lacuna
