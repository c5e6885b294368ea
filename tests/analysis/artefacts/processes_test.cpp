// Several processes on one cache, some of which are killed at any moment.

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/mman.h>
#include <unistd.h>

#include <chrono>
#include <random>
#include <thread>

#include "tests/analysis/artefacts/store_fixture.h"
#include "tests/child_process.h"

namespace lacuna {
namespace {

/// Counts what several processes do.
class Shared {
 public:
  Shared() {
    void* place =
        ::mmap(nullptr, sizeof(Counts), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (place == MAP_FAILED) throw std::runtime_error("no shared memory");
    counts_ = new (place) Counts;
  }
  Shared(const Shared&) = delete;
  Shared& operator=(const Shared&) = delete;
  ~Shared() { ::munmap(counts_, sizeof(Counts)); }

  struct Counts {
    std::atomic<int> ready = 0, built = 0;
  };
  Counts* operator->() const { return counts_; }

 private:
  Counts* counts_;
};

/// A forked child that runs `action`, which is 0 for success, and is killed at the latest with the
/// object.
class Child {
 public:
  template <class Action>
  explicit Child(const Action& action) : pid_(::fork()) {
    if (pid_ != 0) return;
    int code = 99;
    try {
      code = action();
    } catch (const std::exception&) {
    }
    ::_exit(code);
  }
  Child(Child&& o) noexcept : pid_(std::exchange(o.pid_, 0)) {}
  ~Child() {
    if (pid_ > 0) kill();
  }
  int wait() {
    int status = -1;
    ::waitpid(std::exchange(pid_, 0), &status, 0);
    return status;
  }
  void kill() {
    ::kill(pid_, SIGKILL);
    wait();
  }

 private:
  pid_t pid_;
};

TEST(Processes, ThatAskAtOnceBuildOnce) {
  constexpr int processes = 4;
  for (int round = 0; round < 10; ++round) {
    const TemporaryFolder tmp;
    const Shared shared;
    std::vector<Child> children;
    children.reserve(processes);
    for (int i = 0; i < processes; ++i) {
      children.emplace_back([&] {
        TestStore mine(tmp / "cache");
        ++shared->ready;
        while (shared->ready < processes) ::usleep(10);
        const std::function<Numbers()> build = [&] {
          ++shared->built;
          ::usleep(2000);
          return noise(1);
        };
        return *mine.store.get(key_of(""), build) == noise(1) && mine.warnings.empty() ? 0 : 1;
      });
    }
    for (Child& child : children) EXPECT_EQ(child.wait(), 0);
    EXPECT_EQ(shared->built, 1);
    EXPECT_EQ(names_in(tmp / "cache").size(), 1u);
  }
}

TEST(Processes, KilledWhileTheyBuildKeepNobodyWaiting) {
  for (int round = 0; round < 10; ++round) {
    const TemporaryFolder tmp;
    const Shared shared;
    Child child([&] {
      TestStore store(tmp.path());
      store.store.get<Numbers>(key_of("seed=1"), [&]() -> Numbers {
        shared->ready = 1;
        for (;;) ::pause();
      });
      return 1;
    });
    while (shared->ready == 0) ::usleep(10);
    TestStore store(tmp.path());
    // One that came while it built, one that comes after.
    std::thread waits([&] { EXPECT_EQ(store.get(1), noise(1)); });
    if (round % 2 == 0) ::usleep(1000);
    child.kill();
    waits.join();
    EXPECT_EQ(store.built, 1);
    EXPECT_TRUE(store.warnings.empty());
    EXPECT_EQ(TestStore(tmp.path()).get(1), noise(1));
    EXPECT_EQ(names_in(tmp.path()), std::set{entry_name(key_of("seed=1"))});
  }
}

TEST(Processes, KilledAtAnyMomentLeaveWholeEntriesOnly) {
  const TemporaryFolder tmp;
  std::mt19937 random(4);
  std::uint32_t made = 0;
  for (int round = 0; round < 40; ++round) {
    const Shared shared;
    Child child([&] {
      TestStore store(tmp.path());
      for (std::uint32_t seed = made;; ++seed) {
        store.get(seed);
        ++shared->built;
      }
      return 0;
    });
    const int some = static_cast<int>(random() % 4);
    while (shared->built < some) ::usleep(10);
    ::usleep(random() % 3000);
    child.kill();
    for (const CacheEntry& entry : list_cache(tmp.path(), CacheCheck::checksums)) {
      EXPECT_FALSE(entry.refusal) << entry.refusal->text;
    }
    made += static_cast<std::uint32_t>(shared->built);
    TestStore store(tmp.path());
    for (std::uint32_t seed = made > 0 ? made - 1 : 0; seed < made + 2; ++seed) {
      EXPECT_EQ(store.get(seed), noise(seed));
    }
    EXPECT_TRUE(store.messages.empty() && store.warnings.empty()) << "nobody waits for the dead";
  }
  EXPECT_GT(made, 40u);
  // What is hidden and left of the dead is temporary; their locks were tidied up.
  for (const std::string& name : names_in(tmp.path())) {
    EXPECT_TRUE(is_entry_name(name) || name.ends_with(".tmp")) << name;
  }
}

TEST(Processes, OnACacheThatIsTooSmallGetRightArtefacts) {
  const TemporaryFolder tmp;
  constexpr int processes = 4;
  std::vector<Child> children;
  for (std::uint32_t i = 0; i < processes; ++i) {
    children.emplace_back([&, i] {
      std::mt19937 random(i);
      for (int k = 0; k < 60; ++k) {
        TestStore store(tmp.path(), 10'000);  // two entries of 4 KB
        const std::uint32_t seed = random() % 6;
        if (store.get(seed) != noise(seed) || !store.warnings.empty()) return 1;
      }
      return 0;
    });
  }
  for (Child& child : children) EXPECT_EQ(child.wait(), 0);
  TestStore(tmp.path(), 10'000).get(99);
  EXPECT_LE(list_cache(tmp.path(), CacheCheck::checksums).size(), 2u);
}

}  // namespace
}  // namespace lacuna
