#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <sstream>

#include "server/queue/executor_local.h"
#include "server/queue/process_identity.h"
#include "tests/temporary_folder.h"

namespace lacuna {
namespace {

/// Runs shell scripts in the renderer's place.
class LocalExecutorTest : public testing::Test {
 protected:
  Ending run(const std::string& script, const ChildLimits& limits = {},
             const std::function<void(pid_t)>& started = {}) {
    const auto program = temp.write("renderer", "#!/bin/sh\n" + script);
    std::filesystem::permissions(program, std::filesystem::perms::owner_all);
    std::filesystem::create_directories(folder.dir());
    LocalExecutor executor({.renderer = program,
                            .data = temp.path(),
                            .scenes = {},
                            .grace = std::chrono::milliseconds(200),
                            .limits = limits});
    return executor.run(folder, stop, {.started = started, .place = {}});
  }
  std::string log() const { return content_of(folder.file("log.txt")); }

  TemporaryFolder temp;
  JobFolder folder{temp / "job"};
  StopSignal stop;
};

TEST_F(LocalExecutorTest, HoldsItsChildToTheLimits) {
  const int own_niceness = ::getpriority(PRIO_PROCESS, 0);
  int own_score = 0;
  std::istringstream(content_of("/proc/self/oom_score_adj")) >> own_score;
  run("ulimit -d; nice; cat /proc/self/oom_score_adj; ulimit -f",
      {.memory_bytes = 3 << 20, .niceness = 3, .oom_score_adj = 200, .file_bytes = 1 << 20});
  std::istringstream said(log());
  int kilobytes = 0, niceness = 0, score = 0, blocks = 0;
  said >> kilobytes >> niceness >> score >> blocks;
  EXPECT_EQ(kilobytes, 3 << 10);
  EXPECT_EQ(niceness, std::min(19, own_niceness + 3));
  EXPECT_EQ(score, std::min(1000, own_score + 200));
  EXPECT_EQ(blocks, (1 << 20) / 512);
}

TEST_F(LocalExecutorTest, WithoutLimitsItChangesNothing) {
  run("ulimit -d; nice; cat /proc/self/oom_score_adj");
  std::istringstream said(log());
  std::string data, niceness, score;
  said >> data >> niceness >> score;
  rlimit own{};
  ::getrlimit(RLIMIT_DATA, &own);
  const bool unlimited = own.rlim_cur == RLIM_INFINITY;
  EXPECT_EQ(data, unlimited ? "unlimited" : std::to_string(own.rlim_cur / 1024));
  EXPECT_EQ(niceness, std::to_string(::getpriority(PRIO_PROCESS, 0)));
  EXPECT_EQ(score + "\n", content_of("/proc/self/oom_score_adj"));
}

TEST_F(LocalExecutorTest, NamesTheLimitThatARendererRanInto) {
  const Ending end = run("exit 71", {.memory_bytes = std::uint64_t{4} << 30});
  EXPECT_EQ(end.kind, Ending::Kind::out_of_memory);
  EXPECT_EQ(end.code, 71);
  EXPECT_EQ(end.reason, "renderer ran out of memory (limit 4.0 GiB)");
  EXPECT_EQ(run("exit 71").reason, "renderer ran out of memory");
}

TEST_F(LocalExecutorTest, AKillIsNoWantOfMemoryUnlessTheKernelCountsOne) {
  const Ending end = run("kill -9 $$");
  EXPECT_EQ(end.kind, Ending::Kind::killed);
  EXPECT_EQ(end.code, SIGKILL);
}

TEST_F(LocalExecutorTest, TellsWhoRendersWhileItRuns) {
  ProcessIdentity child;
  bool leads = false;
  run("sleep 60", {}, [&](pid_t pid) {
    child = identity_of(pid).value();
    leads = ::getpgid(pid) == pid;
    EXPECT_TRUE(is_alive(child));
    stop.request();
  });
  EXPECT_GT(child.pid, 0);
  EXPECT_TRUE(leads);
  EXPECT_FALSE(is_alive(child));
}

}  // namespace
}  // namespace lacuna
