#include "jobs/queue/child_process.h"

#include <gtest/gtest.h>

#include <csignal>
#include <fstream>

#include "tests/temporary_folder.h"

namespace lacuna {
namespace {

class BoundedRuns : public testing::Test {
 protected:
  BoundedRun run(const std::string& script, std::chrono::milliseconds time, int stop = -1) const {
    return run_bounded({.arguments = {"/bin/sh", "-c", script},
                        .environment = own_environment(),
                        .directory = temp.path(),
                        .limits = {}},
                       stop, time);
  }
  TemporaryFolder temp;
};

TEST_F(BoundedRuns, KeepBothOutputsApart) {
  const BoundedRun done = run("pwd; echo no >&2; exit 3", std::chrono::minutes(1));
  EXPECT_TRUE(done.in_time);
  EXPECT_EQ(done.end.kind, Ending::Kind::exited);
  EXPECT_EQ(done.end.code, 3);
  EXPECT_EQ(done.output, std::filesystem::canonical(temp.path()).string() + "\n");
  EXPECT_EQ(done.errors, "no\n");
}

TEST_F(BoundedRuns, AreKilledAtTheEndOfTheirTimeWithTheirChildren) {
  const BoundedRun done =
      run("echo $$; sleep 1000 & echo $!; wait", std::chrono::milliseconds(300));
  EXPECT_FALSE(done.in_time);
  EXPECT_EQ(done.end.kind, Ending::Kind::killed);
  EXPECT_EQ(done.end.code, SIGKILL);
}

TEST_F(BoundedRuns, EndAtAStop) {
  const StopSignal stop;
  stop.request();
  const BoundedRun done = run("sleep 1000", std::chrono::minutes(10), stop.fd());
  EXPECT_FALSE(done.in_time);
}

TEST_F(BoundedRuns, ThatCannotBeStartedThrow) {
  EXPECT_THROW(run_bounded({.arguments = {"/no/such/program"},
                            .environment = {},
                            .directory = temp.path(),
                            .limits = {}},
                           -1, std::chrono::minutes(1)),
               std::system_error);
}

}  // namespace
}  // namespace lacuna
