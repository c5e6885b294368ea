#include <gtest/gtest.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

#include "jobs/queue/oom_kills.h"
#include "jobs/queue/process_identity.h"

namespace lacuna {
namespace {

/// A child process that does nothing, the leader of its own group, with a name.
class Sleeper {
 public:
  explicit Sleeper(const char* name, bool leads = true) {
    int ends[2];
    EXPECT_EQ(::pipe(ends), 0);
    pid_ = ::fork();
    if (pid_ == 0) {
      if (leads) ::setpgid(0, 0);
      ::prctl(PR_SET_PDEATHSIG, SIGKILL);
      ::prctl(PR_SET_NAME, name);
      ::close(ends[0]);
      ::close(ends[1]);
      for (;;) ::pause();
    }
    ::close(ends[1]);
    char nothing = 0;
    EXPECT_EQ(::read(ends[0], &nothing, 1), 0);  // it has its name
    ::close(ends[0]);
  }
  ~Sleeper() {
    ::kill(pid_, SIGKILL);
    ::waitpid(pid_, nullptr, 0);
  }
  pid_t pid() const { return pid_; }
  /// Ended, but its status not taken.
  void end() const {
    ::kill(pid_, SIGKILL);
    siginfo_t info{};
    ::waitid(P_PID, static_cast<id_t>(pid_), &info, WEXITED | WNOWAIT);
  }

 private:
  pid_t pid_ = 0;
};

TEST(ProcessIdentity, IsFoundWhateverTheName) {
  for (const char* name : {"plain", "a b) R 1 1 (c", ")", "((", "two\nlines"}) {
    const Sleeper sleeper(name);
    const auto identity = identity_of(sleeper.pid());
    ASSERT_TRUE(identity) << name;
    EXPECT_EQ(identity->pid, sleeper.pid());
    EXPECT_GT(identity->start_ticks, identity_of(1)->start_ticks) << name;
    EXPECT_TRUE(is_alive(*identity)) << name;
  }
}

TEST(ProcessIdentity, AnotherProcessOfTheSameNumberIsAnother) {
  const Sleeper sleeper("mine");
  ProcessIdentity earlier = *identity_of(sleeper.pid());
  earlier.start_ticks -= 1;
  ProcessIdentity before_boot = *identity_of(sleeper.pid());
  before_boot.boot = "another boot";
  for (const ProcessIdentity& other : {earlier, before_boot}) {
    EXPECT_FALSE(is_alive(other));
    EXPECT_FALSE(kill_group(other, SIGKILL));
  }
  EXPECT_TRUE(is_alive(*identity_of(sleeper.pid()))) << "it got no signal";
}

TEST(ProcessIdentity, AnEndedProcessIsNotAliveBeforeItsStatusIsTakenEither) {
  const Sleeper sleeper("zombie");
  const ProcessIdentity identity = *identity_of(sleeper.pid());
  sleeper.end();
  EXPECT_FALSE(is_alive(identity));
  EXPECT_FALSE(kill_group(identity, SIGKILL));
}

TEST(ProcessIdentity, NobodyHasANumberThatIsNotGiven) {
  EXPECT_FALSE(identity_of(0));
  EXPECT_FALSE(identity_of(-1));
  EXPECT_FALSE(identity_of(1 << 30));
}

TEST(ProcessIdentity, TheWholeGroupGetsTheSignal) {
  const Sleeper leader("leader");
  const Sleeper member("member", false);
  ASSERT_EQ(::setpgid(member.pid(), leader.pid()), 0);
  EXPECT_FALSE(kill_group(*identity_of(member.pid()), SIGKILL)) << "it leads no group";
  EXPECT_TRUE(kill_group(*identity_of(leader.pid()), SIGKILL));
  for (const pid_t pid : {leader.pid(), member.pid()}) {
    siginfo_t info{};
    ASSERT_EQ(::waitid(P_PID, static_cast<id_t>(pid), &info, WEXITED | WNOWAIT), 0);
    EXPECT_EQ(info.si_status, SIGKILL);
  }
}

TEST(ProcessIdentity, TextThatIsNoStatIsRefused) {
  for (const char* text : {"", "1 (a", "1 (a) S", "1 (a) S 1 1 1 1", "1 (a) S x 1 1 1 1 1"}) {
    EXPECT_FALSE(parse_process_stat(text)) << text;
  }
}

TEST(OomKills, AreReadFromEitherFileOfTheKernel) {
  EXPECT_EQ(parse_oom_kills("low 0\nhigh 1\nmax 2\noom 3\noom_kill 4\noom_group_kill 5\n"), 4u);
  EXPECT_EQ(parse_oom_kills("nr_free_pages 7\noom_kill 0\n"), 0u);
  EXPECT_FALSE(parse_oom_kills("oom_killer 4\n"));
  EXPECT_FALSE(parse_oom_kills(""));
}

}  // namespace
}  // namespace lacuna
