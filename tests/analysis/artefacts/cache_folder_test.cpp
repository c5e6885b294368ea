#include <gtest/gtest.h>

#include <chrono>

#include "base/storage/file_lock.h"
#include "tests/analysis/artefacts/store_fixture.h"

namespace lacuna {
namespace {

using std::chrono::hours;

/// Entries of seeds 0 to n - 1, used one after the other in the past, the last an hour ago.
void fill(const std::filesystem::path& folder, std::uint32_t n) {
  const auto now = std::filesystem::file_time_type::clock::now();
  for (std::uint32_t seed = 0; seed < n; ++seed) {
    TestStore(folder).get(seed);
    std::filesystem::last_write_time(entry_file_of(folder, seed), now - hours(n - seed));
  }
}

/// Which of fill()'s entries are there.
std::set<std::uint32_t> seeds_in(const std::filesystem::path& folder) {
  std::set<std::uint32_t> seeds;
  for (std::uint32_t seed = 0; seed < 100; ++seed) {
    if (std::filesystem::exists(entry_file_of(folder, seed))) seeds.insert(seed);
  }
  return seeds;
}

using Seeds = std::set<std::uint32_t>;

class CacheFolder : public testing::Test {
 protected:
  CacheFolder() {
    fill(tmp.path(), 4);
    bytes = std::filesystem::file_size(entry_file_of(tmp.path(), 0));
  }
  const TemporaryFolder tmp;
  std::uint64_t bytes = 0;  // of an entry
};

TEST_F(CacheFolder, TheLeastRecentlyUsedGo) {
  TestStore store(tmp.path(), 3 * bytes + bytes / 2);
  store.get(0);  // it is used
  EXPECT_EQ(store.built, 0);
  EXPECT_EQ(seeds_in(tmp.path()), (Seeds{0, 1, 2, 3})) << "nothing goes where nothing came";
  store.get(50);
  EXPECT_EQ(seeds_in(tmp.path()), (Seeds{0, 3, 50}));
}

TEST_F(CacheFolder, WhatWasJustWrittenStaysAndWhatIsTooLargeIsNotWritten) {
  TestStore store(tmp.path(), bytes + bytes / 2);
  store.get(50);
  EXPECT_EQ(seeds_in(tmp.path()), (Seeds{50}));
  TestStore small(tmp.path(), bytes - 1);
  EXPECT_EQ(small.get(51), noise(51));
  EXPECT_EQ(seeds_in(tmp.path()), (Seeds{50}));
  EXPECT_TRUE(contains(small.last().remark, "exceed the cache's limit"));
  EXPECT_EQ(small.warnings.size(), 1u);
}

TEST_F(CacheFolder, WhatIsBeingMadeAnewStays) {
  const auto lock = FileLock::try_take(entry_lock_file(entry_file_of(tmp.path(), 0)));
  const CacheRemoval removed = trim_cache(tmp.path(), 2 * bytes, {});
  EXPECT_EQ(seeds_in(tmp.path()), (Seeds{0, 3}));
  EXPECT_EQ(removed.entries, 2u);
  EXPECT_EQ(removed.bytes, 2 * bytes);
}

TEST_F(CacheFolder, IsListedTheLastUsedFirst) {
  TestStore(tmp.path()).get(1);
  const auto list = list_cache(tmp.path(), CacheCheck::checksums);
  ASSERT_EQ(list.size(), 4u);
  const std::uint32_t order[]{1, 3, 2, 0};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(list[i].file, entry_file_of(tmp.path(), order[i])) << i;
    EXPECT_EQ(list[i].bytes, bytes);
    EXPECT_EQ(list[i].header.type, "numbers");
    EXPECT_EQ(list[i].header.label, "a scene");
    EXPECT_FALSE(list[i].refusal);
  }
  const auto age = std::chrono::system_clock::now() - list[3].used;
  EXPECT_GT(age, hours(3));
  EXPECT_LT(age, hours(5));
}

TEST_F(CacheFolder, DamageIsSeenOnlyWhereBytesAreLookedAt) {
  const auto file = entry_file_of(tmp.path(), 2);
  std::string content = content_of(file);
  content.back() ^= 1;
  put_file(file, content);
  const auto damaged = [&](CacheCheck check) {
    Seeds seeds;
    for (const CacheEntry& entry : list_cache(tmp.path(), check)) {
      if (entry.refusal) seeds.insert(entry.file == file ? 2 : 99);
    }
    return seeds;
  };
  EXPECT_EQ(damaged(CacheCheck::headers), Seeds{});
  EXPECT_EQ(damaged(CacheCheck::checksums), Seeds{2});
}

TEST_F(CacheFolder, IsClearedOfWhatIsItsOwn) {
  put_file(tmp / "notes.txt", "mine");
  put_file(tmp / "x.artefact", "mine, too");
  put_file(entry_lock_file(entry_file_of(tmp.path(), 9)), "of a process that was killed");
  EXPECT_EQ(list_cache(tmp.path(), CacheCheck::headers).size(), 4u);
  EXPECT_EQ(clear_cache(tmp.path(), hours(3) - std::chrono::minutes(1)).entries, 2u);
  EXPECT_EQ(seeds_in(tmp.path()), (Seeds{2, 3}));
  const CacheRemoval removed = clear_cache(tmp.path(), {});
  EXPECT_EQ(removed.entries, 2u);
  EXPECT_EQ(removed.bytes, 2 * bytes);
  EXPECT_EQ(names_in(tmp.path()), (std::set<std::string>{"notes.txt", "x.artefact"}));
}

TEST_F(CacheFolder, ThatIsNotThereIsEmpty) {
  EXPECT_TRUE(list_cache(tmp / "nowhere", CacheCheck::headers).empty());
  EXPECT_EQ(clear_cache(tmp / "nowhere", {}).entries, 0u);
  EXPECT_THROW(list_cache(entry_file_of(tmp.path(), 0), CacheCheck::headers), std::system_error);
}

}  // namespace
}  // namespace lacuna
