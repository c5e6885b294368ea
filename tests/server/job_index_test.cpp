#include "server/tables/job_index.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <limits>

#include "analysis/storage/atomic_file.h"
#include "server/tables/job_table.h"
#include "tests/temporary_folder.h"

namespace lacuna {
namespace {

constexpr std::int64_t far_future = std::numeric_limits<std::int64_t>::max();

void write(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file) << text;
}

JobControl priority(int value) {
  JobControl control;
  control.priority = value;
  return control;
}

/// A data folder with jobs that are done.
class Data {
 public:
  explicit Data(int jobs) {
    for (int i = 0; i < jobs; ++i) add(i);
  }

  std::string id(int i) const { return fmt::format("20260101-000000-{:06}", i); }
  JobFolder job(int i) const { return JobFolder(root().jobs() / id(i)); }
  DataRoot root() const { return {tmp_.path() / "data"}; }
  std::filesystem::path index() const { return root().dir / "jobs.index"; }

  void add(int i) const {
    std::filesystem::create_directories(job(i).dir());
    write(job(i).file("job.json"), fmt::format(R"({{"scene": "a.glb", "label": "job {}"}})", i));
    set(i, State::done);
  }
  void set(int i, State state) const {
    JobState s;
    s.state = state;
    s.created = fmt::format("2026-01-01T00:00:{:02}.000Z", i % 60);
    s.attempts = 1;
    s.warnings = {"it is a test"};
    job(i).write_state(s);
  }

  /// What a start of the service finds, an entry of the list each. It has an index of any number
  /// of jobs, and no file is too new.
  std::map<std::string, std::string> start(bool save = false) const {
    SweepTable sweeps(root());
    sweeps.read();
    JobTable table(root(), sweeps,
                   {.least_jobs = 1, .least_missing = 1, .settled = std::chrono::hours(-1)});
    table.rescan();
    if (save) table.save_index();
    std::map<std::string, std::string> texts;
    for (const EntryPtr& entry : table.all()) {
      texts[entry->id] = fmt::format("{} {} {}", entry->text, entry->revision(), entry->words);
      EXPECT_EQ(table.find(entry->id), entry);
    }
    EXPECT_EQ(table.list({}).total, texts.size());
    return texts;
  }

 private:
  TemporaryFolder tmp_;
};

std::vector<std::shared_ptr<JobEntry>> read_all(const std::filesystem::path& file) {
  JobIndexReader reader(file);
  std::vector<std::shared_ptr<JobEntry>> all;
  for (auto some = reader.next(); !some.empty(); some = reader.next()) {
    all.insert(all.end(), some.begin(), some.end());
  }
  return all;
}

TEST(JobIndex, AFoldersStampChangesWithWhatTheTableReads) {
  const Data data(1);
  const JobFolder job = data.job(0);
  std::uint64_t last = folder_stamp(job, far_future);
  EXPECT_NE(last, 0u);
  EXPECT_EQ(folder_stamp(job, far_future), last);
  const auto changes = [&](const std::string& what, const auto& change) {
    change();
    const std::uint64_t now = folder_stamp(job, far_future);
    EXPECT_NE(now, last) << what;
    last = now;
  };
  changes("state.json is replaced", [&] { data.set(0, State::failed); });
  changes("queue.json appears", [&] { job.write_control(priority(3)); });
  changes("a result appears", [&] { write(job.file("image.png"), "x"); });
  changes("job.json grows in place",
          [&] { std::ofstream(job.file("job.json"), std::ios::app) << " "; });
  // A file system's clock has steps, within which a change of the same size is not seen: that is
  // what `settled_before` is for.
  const std::int64_t now = file_system_time(data.root().dir);
  EXPECT_EQ(folder_stamp(job, now - 3'000'000'000), 0u) << "it has just been written";
  EXPECT_EQ(folder_stamp(job, now + 3'000'000'000), last);
  std::filesystem::remove(job.file("state.json"));
  EXPECT_EQ(folder_stamp(job, far_future), 0u);
}

TEST(JobIndex, GivesWhatTheFoldersSay) {
  const Data data(150);  // several parts
  Progress progress;
  progress.iteration = 3;
  progress.seconds = 0.5;
  progress.error = 0.25;
  progress.error_metric = "mse";
  data.job(7).write_progress(progress);
  JobControl control = priority(5);
  control.idempotency_key = "mine";
  data.job(8).write_control(control);
  write(data.job(9).file("image.png"), "x");
  const auto from_folders = data.start(true);
  ASSERT_EQ(from_folders.size(), 150u);
  EXPECT_EQ(read_all(data.index()).size(), 150u);
  EXPECT_EQ(data.start(), from_folders);
}

/// That the second start really takes it from there.
TEST(JobIndex, IsBelievedWhileTheFolderIsUnchanged) {
  const Data data(3);
  const auto from_folders = data.start(true);
  std::vector<EntryPtr> told;
  for (const auto& entry : read_all(data.index())) {
    entry->label = "told by the index";
    complete(*entry);
    told.push_back(entry);
  }
  write_job_index(data.index(), told);
  auto texts = data.start();
  for (const auto& [id, text] : texts) EXPECT_NE(text.find("told by the index"), std::string::npos);
  data.set(1, State::failed);                      // by the service, or a renderer
  std::filesystem::remove_all(data.job(2).dir());  // by hand
  data.add(3);
  texts = data.start();
  EXPECT_NE(texts[data.id(0)].find("told by the index"), std::string::npos);
  EXPECT_EQ(texts[data.id(1)].find("told by the index"), std::string::npos);
  EXPECT_NE(texts[data.id(1)].find("failed"), std::string::npos);
  EXPECT_EQ(texts.count(data.id(2)), 0u);
  EXPECT_NE(texts[data.id(3)].find("job 3"), std::string::npos);
}

TEST(JobIndex, HoldsOnlyJobsThatAreOver) {
  const Data data(6);
  data.set(1, State::queued);
  data.set(2, State::running);
  write(data.job(3).file("state.json"), "no JSON");
  data.start(true);
  std::set<std::string> ids;
  for (const auto& entry : read_all(data.index())) ids.insert(entry->id);
  EXPECT_EQ(ids, (std::set{data.id(0), data.id(4), data.id(5)}));
}

/// A kill leaves the old index, or the new one, and a power cut anything.
TEST(JobIndex, DamageCostsOnlyTime) {
  const Data data(10);
  const auto from_folders = data.start(true);
  const std::string whole = read_file(data.index(), 1 << 20);
  for (std::size_t i = 0; i < whole.size(); i += 7) {
    std::string damaged = whole;
    damaged[i] = static_cast<char>(damaged[i] ^ 0x10);
    write(data.index(), damaged);
    EXPECT_LT(read_all(data.index()).size(), 10u) << i;
  }
  for (std::size_t size = 0; size < whole.size(); size += 61) {
    write(data.index(), whole.substr(0, size));
    EXPECT_LT(read_all(data.index()).size(), 10u) << size;
  }
  for (const std::size_t size : {std::size_t{0}, whole.size() / 2, whole.size() - 1}) {
    write(data.index(), whole.substr(0, size));
    EXPECT_EQ(data.start(), from_folders);
  }
  write(data.index(), "lacuna job index 0\n" + whole.substr(whole.find('\n') + 1));
  EXPECT_TRUE(read_all(data.index()).empty()) << "of another version";
  std::filesystem::remove(data.index());
  EXPECT_EQ(data.start(), from_folders);
}

/// In the table of a service that runs: jobs end, are removed, and begin anew.
TEST(JobIndex, FollowsTheTable) {
  const Data data(4);
  data.set(3, State::running);
  SweepTable sweeps(data.root());
  sweeps.read();
  JobTable table(data.root(), sweeps,
                 {.least_jobs = 1, .least_missing = 1, .settled = std::chrono::hours(-1)});
  table.rescan();
  table.save_index();
  EXPECT_EQ(read_all(data.index()).size(), 3u);
  data.set(3, State::done);
  table.set_state(data.id(3), data.job(3).read_state(), true);
  JobState again = data.job(0).read_state();
  again.state = State::queued;
  table.set_state(data.id(0), again, false);
  table.save_index();
  std::set<std::string> ids;
  for (const auto& entry : read_all(data.index())) ids.insert(entry->id);
  EXPECT_EQ(ids, (std::set{data.id(1), data.id(2), data.id(3)}));
  // What the table says, and the folder does not, is for the next start to find out.
  table.set_state(data.id(0), again, true);
  table.set_state(data.id(1), again, true);
  table.save_index();
  ids.clear();
  for (const auto& entry : read_all(data.index())) ids.insert(entry->id);
  EXPECT_EQ(ids, (std::set{data.id(2), data.id(3)}));
}

}  // namespace
}  // namespace lacuna
