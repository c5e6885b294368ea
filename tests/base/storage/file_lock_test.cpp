#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <system_error>
#include <thread>
#include <vector>

#include "base/storage/file_lock.h"
#include "tests/child_process.h"
#include "tests/temporary_folder.h"

namespace lacuna {
namespace {

TEST(FileLock, HasOneOwner) {
  const TemporaryFolder tmp;
  auto mine = FileLock::try_take(tmp / "lock");
  ASSERT_TRUE(mine);
  EXPECT_FALSE(FileLock::try_take(tmp / "lock")) << "not the same process again";
  const auto take = [&] { return FileLock::try_take(tmp / "lock") ? 1 : 0; };
  EXPECT_EQ(status_in_child(take), 0) << "nor another process";
  const FileLock moved = std::move(*mine);
  mine.reset();
  EXPECT_FALSE(FileLock::try_take(tmp / "lock")) << "it was only moved";
}

TEST(FileLock, EndsWithTheObjectAndWithTheProcess) {
  const TemporaryFolder tmp;
  { const auto mine = FileLock::try_take(tmp / "lock"); }
  status_in_child([&] {
    const auto taken = FileLock::try_take(tmp / "lock");
    ::_exit(0);
    return 0;
  });
  EXPECT_TRUE(FileLock::try_take(tmp / "lock"));
  EXPECT_TRUE(std::filesystem::exists(tmp / "lock"));
}

TEST(FileLock, SaysWhatItsOwnerNoted) {
  const TemporaryFolder tmp;
  const auto lock = FileLock::try_take(tmp / "lock");
  lock->note("a long text");
  lock->note("me");
  EXPECT_EQ(content_of(tmp / "lock"), "me");
}

TEST(FileLock, CanGoWithItsFileAndStillHasOneOwner) {
  const TemporaryFolder tmp;
  std::atomic<int> owners = 0, taken = 0;
  std::vector<std::thread> threads;
  threads.reserve(4);
  for (int i = 0; i < 4; ++i) {
    threads.emplace_back([&] {
      while (taken < 400) {
        auto lock = FileLock::try_take(tmp / "lock");
        if (!lock) continue;
        lock->remove_at_end();
        EXPECT_EQ(++owners, 1);
        ++taken;
        --owners;
      }
    });
  }
  for (std::thread& t : threads) t.join();
  EXPECT_TRUE(names_in(tmp.path()).empty());
}

TEST(FileLock, NamesTheFileThatCannotBeMade) {
  const TemporaryFolder tmp;
  const auto take = [&] { FileLock::try_take(tmp.path() / "nowhere" / "lock"); };
  EXPECT_TRUE(contains(message_of<std::system_error>(take), "nowhere/lock"));
}

}  // namespace
}  // namespace lacuna
