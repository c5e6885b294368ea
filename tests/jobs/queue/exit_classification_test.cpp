#include "jobs/queue/exit_classification.h"

#include <gtest/gtest.h>

#include <cerrno>
#include <csignal>
#include <vector>

namespace lacuna {
namespace {

using Kind = Ending::Kind;

/// A renderer that began and ended so; nobody asked it to.
Attempt attempt(const Ending& ending, State left = State::running) {
  Attempt a;
  a.after.state = left;
  a.after.attempts = 1;
  a.ending = ending;
  return a;
}
ExitClassification classified(const Attempt& a, int max_attempts = 2) {
  return classify_exit(a, max_attempts, "now");
}

const Ending crash{Kind::killed, SIGSEGV, "renderer ended by signal 11 (Segmentation fault)"};
const Ending interruption{Kind::exited, 75, "renderer ended with exit code 75"};
const Ending no_memory{Kind::out_of_memory, 71, "renderer ran out of memory (limit 4.0 GiB)"};

TEST(ExitClassification, ACrashIsRetriedUntilThereWereEnough) {
  Attempt a = attempt(crash);
  ExitClassification v = classified(a);
  EXPECT_EQ(v.state.state, State::queued);
  EXPECT_TRUE(v.crashed);
  a.crashes = 1;
  v = classified(a);
  EXPECT_EQ(v.state.state, State::failed);
  EXPECT_EQ(v.state.error, crash.reason + ", 2 times");
  EXPECT_EQ(v.state.exit_code, 128 + SIGSEGV);
}

TEST(ExitClassification, WantOfMemoryCountsAsACrashAndNamesItself) {
  Attempt a = attempt(no_memory, State::interrupted);
  a.after.error = "out of memory";
  ExitClassification v = classified(a);
  EXPECT_EQ(v.state.state, State::queued);
  EXPECT_TRUE(v.crashed);
  EXPECT_EQ(v.state.error, "") << "it waits; nothing has failed";
  EXPECT_EQ(v.state.exit_code, 71);
  a.crashes = 1;
  v = classified(a);
  EXPECT_EQ(v.state.state, State::failed);
  EXPECT_EQ(v.state.error, "renderer ran out of memory (limit 4.0 GiB), 2 times");
}

TEST(ExitClassification, AnInterruptionThatNobodyAskedForIsACrashUnlessTheJobCameOn) {
  Attempt a = attempt(interruption, State::interrupted);
  a.iteration_before = a.iteration_after = 40;
  ExitClassification v = classified(a);
  EXPECT_EQ(v.state.state, State::queued);
  EXPECT_TRUE(v.crashed);
  a.crashes = 1;
  EXPECT_EQ(classified(a).state.error,
            interruption.reason + ", without a request or progress, 2 times");
  a.iteration_after = 41;
  v = classified(a);
  EXPECT_EQ(v.state.state, State::queued);
  EXPECT_FALSE(v.crashed);
}

TEST(ExitClassification, ACrashIsOneEvenIfTheJobCameOn) {
  Attempt a = attempt(crash);
  a.iteration_after = 41;
  EXPECT_TRUE(classified(a).crashed);
}

TEST(ExitClassification, NothingIsCountedWhileTheDiskIsLow) {
  for (const Ending& ending : {crash, interruption, no_memory}) {
    Attempt a = attempt(ending, State::interrupted);
    a.disk_low = true;
    a.crashes = 100;
    const ExitClassification v = classified(a);
    EXPECT_EQ(v.state.state, State::queued) << ending.reason;
    EXPECT_FALSE(v.crashed) << ending.reason;
  }
}

TEST(ExitClassification, ALowDiskDoesNotMakeABadJobGood) {
  Attempt a = attempt({Kind::exited, 2, "renderer ended with exit code 2"});
  a.disk_low = true;
  EXPECT_EQ(classified(a).state.state, State::failed);
}

TEST(ExitClassification, AskedToStopItIsCancelledHeldOrQueuedInThisOrder) {
  for (const Ending& ending : {crash, interruption, no_memory}) {
    Attempt a = attempt(ending, State::interrupted);
    a.after.error = "out of memory";
    a.stopped = true;
    EXPECT_EQ(classified(a, 1).state.state, State::queued);
    a.hold = true;
    const ExitClassification held = classified(a, 1);
    EXPECT_EQ(held.state.state, State::held);
    EXPECT_FALSE(held.crashed);
    EXPECT_EQ(held.state.error, "");
    EXPECT_EQ(held.state.finished, "");
    a.cancel = true;
    const ExitClassification cancelled = classified(a, 1);
    EXPECT_EQ(cancelled.state.state, State::cancelled);
    EXPECT_EQ(cancelled.state.error, "");
    EXPECT_EQ(cancelled.state.finished, "now");
  }
}

TEST(ExitClassification, WhatTheRendererFinishedStands) {
  Attempt a = attempt({Kind::exited, 0, "renderer ended with exit code 0"}, State::done);
  a.cancel = a.hold = a.stopped = a.disk_low = true;
  EXPECT_EQ(classified(a).state.state, State::done);
}

TEST(ExitClassification, ARendererThatNeverBeganIsNoFaultOfItsJob) {
  std::vector<Ending> endings;
  for (const int error :
       {ENOSPC, EMFILE, EIO, EACCES, ENOENT, ETXTBSY, ENOEXEC, ELIBACC, ENOTDIR}) {
    endings.push_back({Kind::not_started, error, "renderer could not be started"});
  }
  for (const int code : {126, 127}) endings.push_back({Kind::exited, code, "no such library"});
  for (const Ending& ending : endings) {
    Attempt a = attempt(ending, State::queued);
    a.after.attempts = 0;
    a.crashes = 100;
    const ExitClassification v = classified(a);
    EXPECT_EQ(v.state.state, State::queued) << ending.code;
    EXPECT_FALSE(v.crashed) << ending.code;
    EXPECT_EQ(v.obstacle, ending.reason) << ending.code;
    EXPECT_EQ(v.state.attempts, 0) << ending.code;
  }
  EXPECT_EQ(classified(attempt({Kind::refused, 0, "its log is a link"})).state.state,
            State::failed);
}

TEST(ExitClassification, WantOfRoomIsNoCrash) {
  Attempt said = attempt(interruption, State::interrupted);
  said.after.error = "cannot write x: No space left on device";
  const Attempt silent = attempt(interruption);  // not even its state could be written
  const Attempt too_large = attempt({Kind::killed, SIGXFSZ, "File size limit exceeded"});
  const Attempt cut_off = attempt({Kind::killed, SIGBUS, "Bus error"});  // a file in memory
  for (Attempt a : {said, silent, too_large, cut_off}) {
    a.crashes = 100;
    const ExitClassification v = classified(a);
    EXPECT_EQ(v.state.state, State::queued);
    EXPECT_FALSE(v.crashed);
    EXPECT_NE(v.obstacle, "");
  }
  EXPECT_EQ(classified(said).obstacle, said.after.error);
}

}  // namespace
}  // namespace lacuna
