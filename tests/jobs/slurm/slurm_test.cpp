#include <gtest/gtest.h>
#include <sys/wait.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <memory>
#include <optional>
#include <stdexcept>
#include <thread>

#include "jobs/queue/submission.h"
#include "jobs/slurm/request.h"
#include "jobs/slurm/script.h"
#include "jobs/slurm/slurm_programs.h"
#include "tests/temporary_folder.h"

namespace lacuna {
namespace {

using Words = std::vector<std::string>;
using Phase = SlurmJob::Phase;

Budget budget(std::optional<double> seconds, std::optional<double> cpu_seconds = {},
              std::optional<std::int64_t> iterations = {}) {
  Budget result;
  result.seconds = seconds;
  result.cpu_seconds = cpu_seconds;
  result.iterations = iterations;
  return result;
}

JobSpec job(const Budget& budget) {
  JobSpec spec;
  spec.scene = "room.glb";
  spec.resolution = {100, 100};
  spec.budget = budget;
  return spec;
}

TEST(SlurmRequest, TimeFollowsFromTheShorterBudget) {
  EXPECT_EQ(slurm_request(job({}), {}).minutes, 17);  // 60 s, a quarter more, a quarter of an hour
  EXPECT_EQ(slurm_request(job(budget(3600)), {}).minutes, 90);
  EXPECT_EQ(slurm_request(job(budget(3600, 60)), {}).minutes, 17);
  EXPECT_EQ(slurm_request(job(budget({}, {}, 5)), {}).minutes, std::nullopt);
  JobSpec with_reference = job(budget(60));
  with_reference.reference = "auto";
  EXPECT_EQ(slurm_request(with_reference, {}).minutes, std::nullopt);
  JobSpec merged = job(budget(3600));
  merged.shards = 1000;  // 0.07 s each
  EXPECT_EQ(slurm_request(merged, {}).minutes, 92);
  merged.shard = 7;
  EXPECT_EQ(slurm_request(merged, {}).minutes, 90);
}

TEST(SlurmRequest, MemoryIsTheLimitOrAnEstimateThatDoublesWithEachShortage) {
  EXPECT_EQ(slurm_request(job({}), {.memory_limit = std::uint64_t{4} << 30}).megabytes, 4096 + 512);
  const auto once = slurm_request(job({}), {}).megabytes;
  EXPECT_NEAR(static_cast<double>(slurm_request(job({}), {.shortages = 2}).megabytes),
              4.0 * static_cast<double>(once), 4);
  EXPECT_GT(slurm_request(job({}), {.scene_bytes = 100 << 20}).megabytes, once + 2000);
}

TEST(SlurmRequest, CoresAreTheJobsOwnOrThoseOfTheSettingOrAllOfANode) {
  JobSpec spec = job({});
  EXPECT_TRUE(slurm_request(spec, {}).own_node);
  EXPECT_EQ(slurm_request(spec, {.cores = 4}).cores, 4);
  EXPECT_FALSE(slurm_request(spec, {.cores = 4}).own_node);
  spec.threads = 7;
  EXPECT_EQ(slurm_request(spec, {.cores = 4}).cores, 7);
  spec.exclusive = true;
  EXPECT_TRUE(slurm_request(spec, {.cores = 4}).own_node);
}

TEST(SlurmRequest, AHigherPriorityIsLessNiceAndNeverNegative) {
  EXPECT_EQ(slurm_nice(max_priority), 0);
  EXPECT_EQ(slurm_nice(0), max_priority);
  EXPECT_EQ(slurm_nice(-max_priority), 2 * max_priority);
}

TEST(SlurmArguments, AreWordsAndNeverThoseThatLacunaNeeds) {
  EXPECT_EQ(slurm_arguments("  --partition=long  -A me "), (Words{"--partition=long", "-A", "me"}));
  for (const char* bad : {"--job-name=x", "--job=x", "-J x", "--array=1-3", "-a1", "--wrap=ls",
                          "--output=/tmp/x", "--outp=/tmp/x", "long"}) {
    EXPECT_THROW(slurm_arguments(bad), std::invalid_argument) << bad;
  }
}

TEST(SlurmPath, PatternsAreQuoted) {
  EXPECT_EQ(slurm_path("/a/100%/b"), "/a/100%%/b");
  EXPECT_THROW(slurm_path("/a/b\\c"), std::invalid_argument);
  EXPECT_EQ(shell_word("it's"), "'it'\\''s'");
}

TEST(SlurmAnswers, LinesOfSqueueAreReadAndOthersLeftOut) {
  const auto jobs = parse_slurm_jobs(
      "slurm_load_jobs: a warning\n"
      "8|FAILED|JobLaunchFailure|vm|lacuna-x\n"
      "9|PENDING|Resources||a|b\n"
      "12_3|RUNNING|None|vm|an array's task\n"
      "12_[4-10%2]|PENDING|None||its others\n"
      "13|RUNNING|None|n[1-2]|mine\n");
  ASSERT_EQ(jobs.size(), 3U);
  EXPECT_EQ(jobs[0], (SlurmJob{8, "lacuna-x", "FAILED", "JobLaunchFailure", "vm", Phase::over}));
  EXPECT_EQ(jobs[1], (SlurmJob{9, "a|b", "PENDING", "Resources", "", Phase::waits}));
  EXPECT_EQ(jobs[2].nodes, "n[1-2]");
  EXPECT_EQ(parse_slurm_jobs("7|CANCELLED by 0|None|vm|x\n").at(0).state, "CANCELLED");
}

TEST(SlurmAnswers, AStateThatIsNotKnownIsNotOver) {
  EXPECT_EQ(slurm_phase("COMPLETING"), Phase::runs);
  EXPECT_EQ(slurm_phase("A_LATER_VERSION"), Phase::runs);
  EXPECT_EQ(slurm_phase("REQUEUED"), Phase::waits);
  EXPECT_EQ(slurm_phase("PREEMPTED"), Phase::over);
}

TEST(SlurmAnswers, SbatchGivesTheNumberOrItsOwnWords) {
  ProgramAnswer answer{0, "sbatch: advice\n23;cluster\n"};
  const SlurmPrograms programs([&](const Words&) { return answer; });
  EXPECT_EQ(programs.submit({}), 23);
  answer = {1, "sbatch: error: invalid partition specified: x\nsbatch: error: Batch\n"};
  try {
    programs.submit({});
    FAIL();
  } catch (const SlurmError& error) {
    EXPECT_STREQ(error.what(),
                 "sbatch: error: invalid partition specified: x; sbatch: error: Batch");
  }
  answer = {0, ""};
  EXPECT_THROW(programs.submit({}), SlurmError);
}

/// Runs a batch script with a shell script in the renderer's place.
class SlurmScriptTest : public testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(folder.dir()); }

  /// The shell's exit code.
  int run(const std::string& renderer, const std::function<void()>& meanwhile = {}) {
    const auto program = temp.write("renderer", "#!/bin/sh\n" + renderer);
    std::filesystem::permissions(program, std::filesystem::perms::owner_all);
    const auto script = temp.write("slurm.sh", script_text({.name = name,
                                                            .folder = folder.dir(),
                                                            .renderer = program,
                                                            .directory = temp.path(),
                                                            .environment = {"LACUNA_DATA=it's"},
                                                            .all_cores = true}));
    std::jthread beside;
    if (meanwhile) beside = std::jthread(meanwhile);
    const std::string command = "PATH='" + temp.path().string() +
                                "':$PATH SLURM_CPUS_ON_NODE=5 sh '" + script.string() + "' >'" +
                                (temp / "out").string() + "' 2>&1";
    const int status = std::system(command.c_str());  // NOLINT(cert-env33-c)
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }
  /// The script runs `text` in place of a program.
  void replace(const std::string& program, const std::string& text) const {
    const auto file = temp.write(program, "#!/bin/sh\n" + text);
    std::filesystem::permissions(file, std::filesystem::perms::owner_all);
  }
  /// The script's pauses take so many seconds; each adds a line to the file sleep.times.
  void replace_sleep(const std::string& seconds) const {
    replace("sleep", "echo >>\"$0.times\"\nexec /bin/sleep " + seconds + "\n");
  }
  /// Waits until a file contains `text`; the limit ends a test that would hang.
  void await_text(const std::string& file, const std::string& text) const {
    for (int i = 0; i < 10'000 && content_of(temp / file).find(text) == std::string::npos; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }
  void record(const std::string& of) const { write_submission(folder, {of, 0, "now"}); }

  TemporaryFolder temp;
  JobFolder folder{temp / "it's 20260101-000000-abcdef"};
  const std::string name = "lacuna-20260101-000000-abcdef-01234567";
};

TEST_F(SlurmScriptTest, RendersAndLeavesTheExitCode) {
  record(name);
  EXPECT_EQ(run(R"(echo "$LACUNA_DATA $*" >"$2/seen"; exit 3)"), 3);
  EXPECT_EQ(read_submission_exit(folder, name), 3);
  EXPECT_EQ(read_submission_exit(folder, name + "x"), std::nullopt);
  EXPECT_EQ(content_of(folder.file("seen")),
            "it's render " + folder.dir().string() + " --threads 5\n");
}

TEST_F(SlurmScriptTest, AKilledRendererLeavesItsSignal) {
  record(name);
  EXPECT_EQ(run("kill -9 $$"), 128 + SIGKILL);
  EXPECT_EQ(read_submission_exit(folder, name), 128 + SIGKILL);
}

TEST_F(SlurmScriptTest, HandsSigtermOnAndWaitsForTheCheckpoint) {
  record(name);
  EXPECT_EQ(run(R"(trap 'sleep 0.2; echo >"$2/checkpoint"; exit 75' TERM
kill -TERM $PPID
while :; do sleep 0.05; done)"),
            75);
  EXPECT_EQ(read_submission_exit(folder, name), 75);
  EXPECT_TRUE(std::filesystem::exists(folder.file("checkpoint")));
}

TEST_F(SlurmScriptTest, ASubmissionThatWasGivenUpRendersNothing) {
  replace_sleep("0");
  record(name + "x");
  EXPECT_EQ(run("exit 3"), 0);
  EXPECT_EQ(read_submission_exit(folder, name), std::nullopt);
  EXPECT_EQ(content_of(temp / "sleep.times").size(), 60U);
  EXPECT_NE(content_of(temp / "out").find("does not name " + name), std::string::npos);
}

TEST_F(SlurmScriptTest, WaitsForAFolderThatLags) {
  replace_sleep("0.01");
  EXPECT_EQ(run("exit 0",
                [this] {
                  // Until the script has looked for the folder twice in vain.
                  await_text("sleep.times", "\n\n");
                  record(name);
                }),
            0);
  EXPECT_EQ(read_submission_exit(folder, name), 0);
}

TEST_F(SlurmScriptTest, WaitsForARendererThatIsStillAtWork) {
  record(name);
  auto lock = std::make_unique<JobFolder::Lock>(*folder.try_lock());
  replace("flock", "echo \"$@\" >>\"$0.calls\"\nexec /usr/bin/flock \"$@\"\n");
  EXPECT_EQ(run(R"(/usr/bin/flock --nonblock "$2/.lock" true || exit 9)",
                [&] {
                  await_text("flock.calls", "--wait");
                  lock.reset();
                }),
            0);
}

TEST_F(SlurmScriptTest, RecordsAreKeptAndForgotten) {
  EXPECT_EQ(read_submission(folder), std::nullopt);
  write_submission(folder, {name, 12, "now"});
  EXPECT_EQ(read_submission(folder), (Submission{name, 12, "now"}));
  EXPECT_TRUE(has_submission(folder));
  put_file(folder.file("slurm.exit"), name + " 0\n");
  forget_submission(folder);
  EXPECT_FALSE(has_submission(folder));
  EXPECT_EQ(read_submission_exit(folder, name), std::nullopt);
  EXPECT_NE(new_submission_name(folder), new_submission_name(folder));
  EXPECT_TRUE(new_submission_name(JobFolder(temp / "it's \"mine\"|x.sweep"))
                  .starts_with("lacuna-it-s--mine--x.sweep-"));
}

}  // namespace
}  // namespace lacuna
