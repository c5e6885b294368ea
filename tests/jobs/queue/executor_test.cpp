#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cerrno>
#include <csignal>
#include <fstream>
#include <sstream>

#include "jobs/queue/executor_local.h"
#include "jobs/queue/process_identity.h"
#include "tests/temporary_folder.h"

namespace lacuna {
namespace {

/// Runs shell scripts in the renderer's place.
class LocalExecutorTest : public testing::Test {
 protected:
  Ending run(const std::string& script, const ChildLimits& limits = {},
             const std::function<void(pid_t)>& started = {}) {
    write_program("#!/bin/sh\n" + script);
    return make(limits).run({folder}, stop, {.started = started, .place = {}});
  }
  void write_program(const std::string& content) const {
    temp.write("renderer", content);
    std::filesystem::permissions(program, std::filesystem::perms::owner_all);
  }
  LocalExecutor make(const ChildLimits& limits = {}) const {
    std::filesystem::create_directories(folder.dir());
    return LocalExecutor({.renderer = program,
                          .directory = temp.path(),
                          .data = temp.path(),
                          .scenes = {},
                          .grace = std::chrono::milliseconds(200),
                          .limits = limits});
  }
  Ending run(LocalExecutor& executor) { return executor.run({folder}, stop, {}); }
  std::string log() const { return content_of(folder.file("log.txt")); }

  TemporaryFolder temp;
  std::filesystem::path program = temp / "renderer";
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
  const Ending end = run("[ $1 = --version ] || kill -9 $$");
  EXPECT_EQ(end.kind, Ending::Kind::killed);
  EXPECT_EQ(end.code, SIGKILL);
}

TEST_F(LocalExecutorTest, AProgramThatDoesNotBeginIsToldFromAJobThatCrashes) {
  const auto is_away = [&](const std::function<void()>& take_away) {
    write_program("#!/bin/sh\n");
    LocalExecutor executor = make();
    take_away();
    const Ending end = run(executor);
    EXPECT_TRUE(never_began(end)) << end.reason;
    return end;
  };
  EXPECT_EQ(is_away([&] { std::filesystem::remove(program); }).code, ENOENT);
  EXPECT_EQ(is_away([&] { write_program("half a line"); }).code, ENOEXEC);
  EXPECT_EQ(is_away([&] { write_program("#!/bin/sh\nkill -11 $$"); }).code, ENOEXEC);
  EXPECT_EQ(is_away([&] { write_program("#!/bin/sh\nexec /nowhere"); }).code, 127);
  const std::string whole = content_of("/bin/true");
  is_away([&] { write_program(whole.substr(0, whole.size() / 2)); });
  {
    write_program(whole);
    LocalExecutor executor = make();
    const std::ofstream writer(program, std::ios::app);
    EXPECT_EQ(run(executor).code, ETXTBSY);
  }
  EXPECT_EQ(run("[ $1 = --version ] || kill -11 $$").kind, Ending::Kind::killed);
}

TEST_F(LocalExecutorTest, AJobWhoseLogCannotBeOneIsRefused) {
  std::filesystem::create_directories(folder.file("log.txt"));
  EXPECT_EQ(run("exit 0").kind, Ending::Kind::refused);
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
