#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <optional>
#include <stdexcept>

#include "base/storage/atomic_file.h"
#include "base/storage/file_handle.h"
#include "jobs/spec/problems.h"
#include "jobs/store/job_folder.h"
#include "jobs/store/new_folder.h"
#include "tests/child_process.h"
#include "tests/failing_files.h"
#include "tests/temporary_folder.h"

namespace lacuna {
namespace {

using Names = std::set<std::string>;

JobSpec some_job() {
  JobSpec spec;
  spec.scene = "cornell.glb";
  spec.budget.iterations = 5;
  return spec;
}

TEST(JobFolder, IsCreatedWithItsJobAndWaits) {
  const TemporaryFolder tmp;
  const JobFolder folder = JobFolder::create(tmp.path() / "jobs" / "one", some_job());
  EXPECT_EQ(folder.id(), "one");
  EXPECT_EQ(names_in(folder.dir()), Names{"job.json"});
  EXPECT_EQ(names_in(tmp / "jobs"), Names{"one"});
  EXPECT_EQ(folder.read_job(), some_job());
  EXPECT_EQ(folder.read_state(), JobState{});
  EXPECT_EQ(folder.read_progress(), std::nullopt);
}

TEST(JobFolder, OfVersion01TellsItsState) {
  const TemporaryFolder tmp;
  const JobFolder folder = JobFolder::create(tmp / "one", some_job());
  put_file(folder.file("state.json"), R"({"state": "interrupted", "attempts": 2, "created": "c"})");
  EXPECT_EQ(folder.read_state().state, State::interrupted);
  folder.reopen();
  EXPECT_EQ(folder.read_state().state, State::queued);
  EXPECT_EQ(folder.read_state().attempts, 2);
}

TEST(JobFolder, ASlashAtTheEndChangesNothing) {
  const TemporaryFolder tmp;
  EXPECT_EQ(JobFolder::create(tmp / "one/", some_job()).id(), "one");
}

TEST(JobFolder, WhatCannotBeSyncedAtTheLastHasNotHappened) {
  const TemporaryFolder tmp;
  const std::filesystem::path one = JobFolder::create(tmp / "one", some_job()).dir();
  {
    const FailingFiles failing(FileCall::fsync, tmp.path().filename().string());
    EXPECT_THROW(JobFolder::create(tmp / "two", some_job()), std::system_error);
    EXPECT_THROW(take_folders_away({one}), std::system_error);
  }
  EXPECT_EQ(names_in(tmp.path()), Names{"one"});
  EXPECT_EQ(JobFolder(one).read_job(), some_job());
}

TEST(JobFolder, NeverReplacesWhatIsThere) {
  const TemporaryFolder tmp;
  JobFolder::create(tmp / "one", some_job());
  std::filesystem::create_directory(tmp / "empty");
  put_file(tmp / "file", "x");
  std::filesystem::create_symlink("nowhere", tmp / "link");
  for (const char* name : {"one", "empty", "file", "link"}) {
    const auto create = [&] { JobFolder::create(tmp / name, JobSpec{}); };
    EXPECT_TRUE(contains(message_of<std::invalid_argument>(create), (tmp / name).string())) << name;
  }
  EXPECT_EQ(JobFolder(tmp / "one").read_job(), some_job());
  EXPECT_EQ(names_in(tmp.path()), (Names{"one", "empty", "file", "link"}));
}

TEST(JobFolder, IsCreatedWholeOrNotAtAll) {
  const TemporaryFolder tmp;
  put_file(tmp / "file", "x");
  EXPECT_THROW(JobFolder::create(tmp.path() / "file" / "one", some_job()), std::system_error);
  EXPECT_EQ(names_in(tmp.path()), Names{"file"});
}

TEST(JobFolder, StateReadsBackAsWritten) {
  const TemporaryFolder tmp;
  const JobFolder folder = JobFolder::create(tmp / "one", some_job());
  JobState s;
  s.state = State::failed;
  s.attempts = 3;
  s.exit_code = -9;
  s.created = "2026-01-31T23:59:59.123Z";
  s.started = "2026-02-01T00:00:00.000Z";
  s.finished = "2026-02-01T00:00:01.000Z";
  s.phase = "loading";
  s.error = "scene \"a\" has ünicode";
  s.warnings = {"one", "two"};
  folder.write_state(s);
  EXPECT_EQ(folder.read_state(), s);
}

TEST(JobFolder, AnErrorOfAnyBytesStillMakesAReadableState) {
  const TemporaryFolder tmp;
  const JobFolder folder = JobFolder::create(tmp / "one", some_job());
  JobState s;
  s.error = std::string("a\0b\nc\x1b\xff", 7);
  s.warnings = {std::string(100000, 'w'), std::string("\0", 1)};
  folder.write_state(s);
  const JobState back = folder.read_state();
  EXPECT_EQ(back.error, "a b c \xef\xbf\xbd");
  EXPECT_EQ(back.warnings[0].size(), 4003u);
  EXPECT_EQ(back.warnings[1], " ");
}

TEST(JobFolder, ACorruptStateIsToldWithItsFile) {
  const TemporaryFolder tmp;
  const JobFolder folder(tmp.path());
  const auto read = [&] { folder.read_state(); };
  for (const std::string& content :
       {std::string(), std::string("{}"), std::string("{\"state\": \"running\""),
        std::string(R"({"state": "lost", "attempts": 0, "created": ""})"),
        std::string(R"({"state": "done", "attempts": 0, "created": "", "more": 1})"),
        std::string(2 << 20, ' ')}) {
    put_file(folder.file("outcome.json"), content);
    const std::string message = message_of<std::runtime_error>(read);
    EXPECT_TRUE(contains(message, folder.file("outcome.json").string())) << content.substr(0, 100);
    EXPECT_TRUE(contains(message, "corrupt")) << message;
  }
}

TEST(JobFolder, ABadJobFileIsTold) {
  const TemporaryFolder tmp;
  const JobFolder folder(tmp.path());
  EXPECT_THROW(folder.read_job(), std::system_error);
  put_file(folder.file("job.json"), "{}");
  EXPECT_THROW(folder.read_job(), BadJob);
  put_file(folder.file("job.json"), std::string(3 << 20, ' '));
  EXPECT_THROW(folder.read_job(), BadJob);
}

TEST(JobFolder, ProgressReadsBackAsWrittenAndIsNothingWhereItIsDamaged) {
  const TemporaryFolder tmp;
  const JobFolder folder(tmp.path());
  Progress p;
  p.iteration = 12;
  p.seconds = 1.0 / 3;
  p.cpu_seconds = 0.1;
  p.share = 1;
  folder.write_progress(p);
  EXPECT_EQ(folder.read_progress(), p);
  p.remaining_seconds = 5;
  p.error = 1e-300;
  p.error_metric = "est_rmse";
  folder.write_progress(p);
  EXPECT_EQ(folder.read_progress(), p);
  p.error = std::numeric_limits<double>::infinity();
  folder.write_progress(p);
  EXPECT_EQ(folder.read_progress()->error, std::nullopt);
  for (const char* damaged : {"", "{\"iteration\": 1", "{}", "[]"}) {
    put_file(folder.file("progress.json"), damaged);
    EXPECT_EQ(folder.read_progress(), std::nullopt) << damaged;
  }
}

/// 0: this process got the lock, 1: it did not.
int try_to_lock(const JobFolder& folder) { return folder.try_lock() ? 0 : 1; }

TEST(JobFolder, OneProcessAtATimeHasTheLock) {
  const TemporaryFolder tmp;
  const JobFolder folder(tmp.path());
  const auto taken = [&] {
    return WEXITSTATUS(status_in_child([&] { return try_to_lock(folder); }));
  };
  EXPECT_EQ(taken(), 0);
  {
    auto lock = folder.try_lock();
    ASSERT_TRUE(lock);
    EXPECT_EQ(taken(), 1);
    EXPECT_FALSE(folder.try_lock());
    const JobFolder::Lock moved = std::move(*lock);
    lock.reset();
    EXPECT_EQ(taken(), 1);
  }
  EXPECT_EQ(taken(), 0);
}

TEST(JobFolder, TheLockGoesWithTheProcessHoweverItDies) {
  const TemporaryFolder tmp;
  const JobFolder folder(tmp.path());
  const int status = status_in_child([&] {
    const auto lock = folder.try_lock();
    return lock ? ::raise(SIGKILL) : 1;
  });
  EXPECT_TRUE(WIFSIGNALED(status));
  EXPECT_TRUE(folder.try_lock());
}

TEST(JobFolder, WhoGetsTheLockTidiesUpAfterTheKilled) {
  const TemporaryFolder tmp;
  const JobFolder folder(tmp.path());
  status_in_child([&] {
    put_file(temporary_name(folder.file("checkpoint.bin")), "half a checkpoint");
    return ::raise(SIGKILL);
  });
  ASSERT_EQ(names_in(tmp.path()).size(), 1u);
  const auto left = tmp / *names_in(tmp.path()).begin();
  std::filesystem::last_write_time(
      left, std::filesystem::file_time_type::clock::now() - std::chrono::hours(1));
  ASSERT_TRUE(folder.try_lock());
  EXPECT_EQ(names_in(tmp.path()), Names{".lock"});
}

TEST(JobFolder, ALockThatCannotBeMadeIsAnError) {
  const TemporaryFolder tmp;
  const JobFolder folder(tmp / "missing");
  EXPECT_THROW(folder.try_lock(), std::system_error);
}

TEST(JobFolder, TheManifestServesResultsAndNothingOfTheWorks) {
  Names names;
  for (const FileInfo& f : job_files()) {
    EXPECT_TRUE(names.emplace(f.name).second) << f.name;
    const bool works =
        f.name == "checkpoint.bin" || f.name == "accepted.json" || f.name.starts_with("slurm.");
    EXPECT_EQ(f.served, !works) << f.name;
    EXPECT_NE(f.media_type.find('/'), std::string_view::npos);
    EXPECT_EQ(f.name.find_first_not_of("abcdefghijklmnopqrstuvwxyz."), std::string_view::npos);
  }
  EXPECT_EQ(names, (Names{"job.json", "outcome.json", "progress.json", "image.exr", "image.png",
                          "layers.half", "layers.json", "curve.csv", "report.json",
                          "checkpoint.bin", "accepted.json", "slurm.json", "slurm.sh", "slurm.exit",
                          "choice.json", "inputs.json", "log.txt", "program.log"}));
}

TEST(JobFolder, WhatAServiceTookItForIsKept) {
  const TemporaryFolder temporary;
  const JobFolder f = JobFolder::create(temporary.path() / "one", some_job());
  EXPECT_EQ(f.read_acceptance(), Acceptance{});
  const Acceptance accepted{.number = 7, .created = "c", .sweep = "s", .idempotency_key = "k"};
  f.write_acceptance(accepted);
  EXPECT_EQ(f.read_acceptance(), accepted);
  write_file_atomically(f.file("accepted.json"), R"({"number": "seven"})");
  EXPECT_THROW(f.read_acceptance(), std::runtime_error);
}

TEST(JobFolder, RemovedAsAWholeAndWhatACrashLeftIsTidiedUp) {
  const TemporaryFolder temporary;
  const JobFolder f = JobFolder::create(temporary.path() / "a", some_job());
  remove_folder_whole(f.dir());
  EXPECT_TRUE(std::filesystem::is_empty(temporary.path()));
  EXPECT_THROW(remove_folder_whole(f.dir()), std::system_error);
  // No process has this number; the second is our own, still at work.
  const auto dead = temporary.path() / ".b.4194305-0123456789abcdef.tmp";
  const auto ours = temporary_name(temporary.path() / "c");
  for (const auto& dir : {dead, ours}) std::filesystem::create_directories(dir / "deep");
  remove_stale_folders(temporary.path());
  EXPECT_FALSE(std::filesystem::exists(dead));
  EXPECT_TRUE(std::filesystem::exists(ours));
}

}  // namespace
}  // namespace lacuna
