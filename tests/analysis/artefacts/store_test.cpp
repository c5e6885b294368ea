#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "base/storage/atomic_file.h"
#include "base/storage/file_lock.h"
#include "tests/analysis/artefacts/store_fixture.h"
#include "tests/child_process.h"

namespace lacuna {
namespace {

using Origin = ArtefactRecord::Origin;
using std::chrono::milliseconds;

TEST(ArtefactStore, BuildsOnceAndLoadsFromThenOn) {
  const TemporaryFolder tmp;
  const auto folder = tmp / "deep" / "cache";
  TestStore first(folder), second(folder);
  EXPECT_EQ(first.get(1), noise(1));
  EXPECT_EQ(second.get(1), noise(1));
  EXPECT_EQ(first.built, 1);
  EXPECT_EQ(second.built, 0);
  const ArtefactRecord built = first.last(), loaded = second.last();
  EXPECT_EQ(built.type, "numbers");
  EXPECT_EQ(built.origin, Origin::built);
  EXPECT_EQ(loaded.origin, Origin::loaded);
  const auto bytes = std::filesystem::file_size(entry_file_of(folder, 1));
  for (const ArtefactRecord& r : {built, loaded}) {
    EXPECT_EQ(r.disk_bytes, bytes);
    EXPECT_EQ(r.content_bytes, 8 + 4 * noise(1).size());
    EXPECT_EQ(r.remark, "");
  }
  EXPECT_EQ(names_in(folder), std::set{entry_name(key_of("seed=1"))}) << "and no lock is left";
  EXPECT_TRUE(first.warnings.empty() && second.warnings.empty());
}

TEST(ArtefactStore, OtherSettingsAreAnotherArtefact) {
  const TemporaryFolder tmp;
  TestStore store(tmp.path());
  EXPECT_EQ(store.get(1), noise(1));
  EXPECT_EQ(store.get(2), noise(2));
  EXPECT_EQ(store.built, 2);
}

TEST(ArtefactStore, GivesWhatSomebodyStillHolds) {
  TestStore store({});
  const std::function<int()> build = [&] { return ++store.built; };
  auto held = store.store.get(key_of(""), build);
  EXPECT_EQ(store.store.get(key_of(""), build), held);
  EXPECT_EQ(store.store.records().size(), 1u) << "nothing was built or loaded for the second";
  held.reset();
  EXPECT_EQ(*store.store.get(key_of(""), build), 2) << "without a cache it is made anew";
}

TEST(ArtefactStore, OneKeyHasOneType) {
  TestStore store({});
  const auto held = store.store.get<int>(key_of(""), [] { return 1; });
  EXPECT_THROW(store.store.get<float>(key_of(""), [] { return 1.0F; }), std::logic_error);
}

TEST(ArtefactStore, ThreadsThatAskAtOnceBuildOnce) {
  const TemporaryFolder tmp;
  for (const auto& folder : {std::filesystem::path(), tmp.path()}) {
    TestStore store(folder);
    std::atomic<int> built = 0, asking = 0;
    constexpr int threads = 8;
    const std::function<Numbers()> build = [&] {
      // Once the others are about to ask.
      while (asking < threads) std::this_thread::yield();
      ++built;
      return noise(1);
    };
    std::vector<std::shared_ptr<const Numbers>> got(threads);
    std::vector<std::thread> all;
    all.reserve(got.size());
    for (auto& mine : got) {
      all.emplace_back([&] {
        ++asking;
        mine = store.store.get(key_of(""), build);
      });
    }
    for (std::thread& t : all) t.join();
    EXPECT_EQ(built, 1);
    for (const auto& mine : got) EXPECT_EQ(mine, got[0]);
  }
}

TEST(ArtefactStore, ABuilderThatFailsKeepsNobodyWaiting) {
  const TemporaryFolder tmp;
  TestStore store(tmp.path());
  const auto fail = [&] {
    store.store.get<Numbers>(key_of("seed=1"),
                             []() -> Numbers { throw std::runtime_error("no room"); });
  };
  EXPECT_EQ(message_of<std::runtime_error>(fail), "no room");
  EXPECT_TRUE(names_in(tmp.path()).empty());
  EXPECT_TRUE(store.store.records().empty());
  EXPECT_EQ(store.get(1), noise(1));
}

TEST(ArtefactStore, SecondsAreCountedOnce) {
  TestStore store({});
  const auto start = std::chrono::steady_clock::now();
  store.store.get<Numbers>(key_of("outer"), [&] {
    const auto wait = [] {
      std::this_thread::sleep_for(milliseconds(5));
      return Numbers{};
    };
    store.store.get<Numbers>(key_of("first"), wait);
    store.store.get<Numbers>(key_of("second"), wait);
    return wait();
  });
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  double sum = 0;
  for (const ArtefactRecord& r : store.store.records()) {
    EXPECT_GE(r.seconds, 0.005);
    sum += r.seconds;
  }
  EXPECT_EQ(store.store.records().size(), 3u);
  EXPECT_LE(sum, elapsed.count());
}

TEST(ArtefactStore, SaysWhatNobodyAskedFor) {
  TestStore store({});
  store.store.not_needed("portals");
  EXPECT_EQ(store.last().type, "portals");
  EXPECT_EQ(store.last().origin, Origin::not_needed);
}

TEST(ArtefactStore, AnEntryThatIsRefusedIsMadeAnewAndReported) {
  const TemporaryFolder tmp;
  TestStore(tmp.path()).get(1);
  const auto file = entry_file_of(tmp.path(), 1);
  const std::string whole = content_of(file);
  for (const std::string& bytes :
       {std::string(), std::string("not an entry"), whole.substr(0, whole.size() / 2), whole + "x",
        whole.substr(0, 99) + "?" + whole.substr(100)}) {
    put_file(file, bytes);
    TestStore store(tmp.path());
    EXPECT_EQ(store.get(1), noise(1));
    EXPECT_EQ(store.built, 1);
    EXPECT_TRUE(contains(store.last().remark, "its cache entry: ")) << store.last().remark;
    ASSERT_EQ(store.warnings.size(), 1u) << "said once";
    EXPECT_TRUE(contains(store.warnings[0], "\"numbers\""));
    EXPECT_EQ(content_of(file), whole);
  }
}

TEST(ArtefactStore, WaitsForWhoBuildsAndThenLoads) {
  const TemporaryFolder tmp;
  auto lock = FileLock::try_take(entry_lock_file(entry_file_of(tmp.path(), 1)));
  lock->note("somebody");
  TestStore store(tmp.path()), other(tmp / "elsewhere");
  std::thread asks([&] { EXPECT_EQ(store.get(1), noise(1)); });
  const auto told = [&] {
    const std::lock_guard guard(store.mutex);
    return !store.messages.empty();
  };
  while (!told()) std::this_thread::sleep_for(milliseconds(1));
  other.get(1);
  std::filesystem::rename(entry_file_of(tmp / "elsewhere", 1), entry_file_of(tmp.path(), 1));
  lock.reset();
  asks.join();
  EXPECT_EQ(store.built, 0);
  EXPECT_EQ(store.last().origin, Origin::loaded);
  EXPECT_GT(store.last().waited_seconds, 0);
  EXPECT_EQ(store.messages, std::vector<std::string>{"waiting for \"numbers\" by somebody"});
}

TEST(ArtefactStore, WhoWaitsTooLongBuildsWithoutTheCache) {
  const TemporaryFolder tmp;
  const auto lock = FileLock::try_take(entry_lock_file(entry_file_of(tmp.path(), 1)));
  TestStore store(tmp.path(), 1 << 30, 0.01);
  EXPECT_EQ(store.get(1), noise(1));
  EXPECT_EQ(store.last().origin, Origin::built);
  EXPECT_TRUE(contains(store.last().remark, "without the cache")) << store.last().remark;
  EXPECT_EQ(store.warnings.size(), 1u);
  EXPECT_FALSE(std::filesystem::exists(entry_file_of(tmp.path(), 1)));
}

TEST(ArtefactStore, AWaitCanBeInterrupted) {
  const TemporaryFolder tmp;
  const auto lock = FileLock::try_take(entry_lock_file(entry_file_of(tmp.path(), 1)));
  TestStore store(tmp.path());
  int asked = 0;
  store.interrupted = [&] { return ++asked > 3; };
  EXPECT_THROW(store.get(1), WaitInterrupted);
  EXPECT_EQ(store.built, 0);
}

TEST(ArtefactStore, ALockFileThatNobodyHoldsIsNoLock) {
  const TemporaryFolder tmp;
  put_file(entry_lock_file(entry_file_of(tmp.path(), 1)), "process 1 on another machine");
  TestStore store(tmp.path(), 1 << 30, 0);  // it would not be kept, if it waited
  EXPECT_EQ(store.get(1), noise(1));
  EXPECT_EQ(names_in(tmp.path()), std::set{entry_name(key_of("seed=1"))});
}

TEST(ArtefactStore, AFolderThatCannotBeMadeCostsNoArtefact) {
  const TemporaryFolder tmp;
  put_file(tmp / "plain", "a file");
  TestStore store(tmp / "plain" / "cache");
  EXPECT_EQ(store.get(1), noise(1));
  EXPECT_EQ(store.last().origin, Origin::built);
  EXPECT_EQ(store.last().disk_bytes, 0u);
  EXPECT_TRUE(contains(store.last().remark, "not cached")) << store.last().remark;
}

/// Loads from a folder that it must not write to, and builds what is not there.
int use_read_only(const std::filesystem::path& folder) {
  if (::geteuid() == 0 && ::seteuid(65534) != 0) return 2;
  TestStore store(folder);
  if (store.get(1) != noise(1) || store.built != 0 || !store.warnings.empty()) return 3;
  if (store.get(2) != noise(2) || store.built != 1 || store.warnings.size() != 1) return 4;
  return contains(store.last().remark, "not cached") ? 0 : 5;
}

TEST(ArtefactStore, AReadOnlyFolderIsRead) {
  const TemporaryFolder tmp;
  TestStore(tmp.path()).get(1);
  ::chmod(tmp.path().c_str(), 0555);
  EXPECT_EQ(status_in_child([&] { return use_read_only(tmp.path()); }), 0);
  ::chmod(tmp.path().c_str(), 0755);
  EXPECT_EQ(names_in(tmp.path()), std::set{entry_name(key_of("seed=1"))});
}

/// A disk that is full after 1000 bytes, as far as one process can have it.
int build_on_a_full_disk(const std::filesystem::path& folder) {
  ::signal(SIGXFSZ, SIG_IGN);
  const rlimit limit{1000, 1000};
  if (::setrlimit(RLIMIT_FSIZE, &limit) != 0) return 2;
  TestStore store(folder);
  if (store.get(1) != noise(1)) return 3;
  return store.warnings.size() == 1 && contains(store.last().remark, "not cached") ? 0 : 4;
}

TEST(ArtefactStore, AFullDiskCostsNoArtefactAndLeavesNothing) {
  const TemporaryFolder tmp;
  EXPECT_EQ(status_in_child([&] { return build_on_a_full_disk(tmp.path()); }), 0);
  EXPECT_TRUE(names_in(tmp.path()).empty());
  TestStore store(tmp.path());
  EXPECT_EQ(store.get(1), noise(1));
  EXPECT_GT(store.last().disk_bytes, 0u) << "and with room it is kept";
}

}  // namespace
}  // namespace lacuna
