#include <gtest/gtest.h>

#include <csignal>

#include "jobs/queue/exit_classification.h"
#include "jobs/slurm/slurm_watch.h"

namespace lacuna {
namespace {

using How = Ending::Kind;

SlurmJob over(const std::string& state, const std::string& reason = "None") {
  return {17, "lacuna-x", state, reason, "node1", SlurmJob::Phase::over};
}

TEST(SlurmEnding, TheFolderIsBelievedBeforeSlurm) {
  EXPECT_EQ(slurm_ending(0, over("FAILED"), true).kind, How::exited);
  const Ending interrupted = slurm_ending(75, over("TIMEOUT"), true);
  EXPECT_EQ(interrupted.kind, How::exited);
  EXPECT_EQ(interrupted.code, 75);
  const Ending crash = slurm_ending(128 + SIGSEGV, over("FAILED"), true);
  EXPECT_EQ(crash.kind, How::killed);
  EXPECT_EQ(crash.code, SIGSEGV);
  EXPECT_EQ(slurm_ending(71, std::nullopt, true).kind, How::out_of_memory);
}

TEST(SlurmEnding, WhatCannotWriteIsLostWithSlurmsWord) {
  for (const char* state : {"TIMEOUT", "PREEMPTED", "NODE_FAIL", "BOOT_FAIL", "DEADLINE"}) {
    const Ending end = slurm_ending(std::nullopt, over(state), true);
    EXPECT_EQ(end.kind, How::lost);
    EXPECT_EQ(end.reason, std::string("Slurm job 17: ") + state);
  }
  EXPECT_EQ(slurm_ending(std::nullopt, over("FAILED", "JobLaunchFailure"), true).reason,
            "renderer left no exit code, or its node cannot access the data folder; Slurm job 17: "
            "FAILED (JobLaunchFailure)");
  EXPECT_EQ(slurm_ending(std::nullopt, over("RUNNING"), false).kind, How::lost);
  EXPECT_EQ(slurm_ending(std::nullopt, std::nullopt, false).kind, How::lost);
  EXPECT_EQ(slurm_ending(std::nullopt, over("OUT_OF_MEMORY"), true).kind, How::out_of_memory);
}

TEST(SlurmEnding, CancelledInSlurmIsFinalUnlessTheRendererWasDone) {
  EXPECT_EQ(slurm_ending(std::nullopt, over("CANCELLED"), true).kind, How::refused);
  EXPECT_EQ(slurm_ending(75, over("CANCELLED"), true).kind, How::refused);
  EXPECT_EQ(slurm_ending(0, over("CANCELLED"), true).kind, How::exited);
}

TEST(SlurmEnding, ALostRendererThatCameOnIsNoCrash) {
  Attempt attempt;
  attempt.after.state = State::running;
  attempt.ending = slurm_ending(std::nullopt, over("NODE_FAIL"), true);
  attempt.iteration_before = attempt.iteration_after = 40;
  EXPECT_TRUE(classify_exit(attempt, 3, "now").crashed);
  attempt.iteration_after = 41;
  EXPECT_FALSE(classify_exit(attempt, 3, "now").crashed);
  attempt.ending = slurm_ending(75, over("CANCELLED"), true);
  const ExitClassification final = classify_exit(attempt, 3, "now");
  EXPECT_EQ(final.state.state, State::failed);
  EXPECT_EQ(final.state.exit_code, 75);
}

TEST(SlurmEnding, AttemptsOfARendererThatWasFoundAreItsOwn) {
  Attempt attempt;
  attempt.before.attempts = attempt.after.attempts = 1;
  attempt.after.state = State::running;
  attempt.ending = slurm_ending(128 + SIGKILL, over("FAILED"), true);
  EXPECT_EQ(classify_exit(attempt, 3, "now").state.attempts, 2);
  attempt.found = true;
  EXPECT_EQ(classify_exit(attempt, 3, "now").state.attempts, 1);
}

}  // namespace
}  // namespace lacuna
