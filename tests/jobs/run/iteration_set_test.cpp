#include "jobs/run/iteration_set.h"

#include <gtest/gtest.h>

#include <set>

#include "base/storage/bytes.h"

namespace lacuna {
namespace {

IterationSet done(std::uint32_t shards, std::uint32_t k, int iterations) {
  IterationSet set(shards, k);
  for (int i = 0; i < iterations; ++i) set.add_next();
  return set;
}

TEST(IterationSet, ShardsShareOutEveryIterationOnce) {
  for (const std::uint32_t shards : {1U, 2U, 3U, 8U}) {
    for (const std::uint64_t n : {1U, 2U, 15U, 16U, 17U, 100U}) {
      std::set<std::uint64_t> all;
      std::uint64_t sum = 0;
      for (std::uint32_t k = 0; k < shards; ++k) {
        IterationSet set(shards, k);
        const std::uint64_t own = set.count_below(n);
        sum += own;
        for (std::uint64_t i = 0; i < own; ++i) {
          all.insert(set.next());
          set.add_next();
        }
        EXPECT_EQ(set.count(), own);
        EXPECT_GE(set.next(), n);
      }
      EXPECT_EQ(sum, n);
      EXPECT_EQ(all.size(), n);
      EXPECT_EQ(*all.rbegin(), n - 1);
    }
  }
}

TEST(IterationSet, AShardHasBothHalves) {
  const IterationSet set = done(3, 1, 7);
  EXPECT_EQ(set.count(), 7U);
  EXPECT_EQ(set.count_even(), 4U);
  EXPECT_EQ(set.next(), 2U * (3 * 3 + 1) + 1);
  EXPECT_FALSE(set.is_whole());
}

TEST(IterationSet, AllShardsMakeTheWholeJob) {
  IterationSet all(3, 0);
  for (const std::uint32_t k : {2U, 0U, 1U}) all.merge(done(3, k, k == 2 ? 4 : 6));
  all.simplify();
  EXPECT_TRUE(all.is_whole());
  EXPECT_EQ(all.next(), 16U);
  EXPECT_EQ(all.count_even(), 8U);
}

TEST(IterationSet, GapsAreFilledFirst) {
  // Of shard 1 of 2 there are 0, 1, 4, 5, 8; of shard 2: 2.
  IterationSet all(2, 0);
  all.merge(done(2, 1, 1));
  all.merge(done(2, 0, 5));
  all.simplify();
  EXPECT_FALSE(all.is_whole());
  EXPECT_TRUE(all.serves(IterationSet()));
  std::vector<std::uint64_t> next;
  for (int i = 0; i < 4; ++i) {
    next.push_back(all.next());
    all.add_next();
  }
  EXPECT_EQ(next, (std::vector<std::uint64_t>{3, 6, 7, 9}));
  EXPECT_TRUE(all.is_whole());
  EXPECT_EQ(all.next(), 10U);
}

TEST(IterationSet, RefusesAShardTwiceAndShardsOfOtherNumbers) {
  IterationSet all(3, 0);
  all.merge(done(3, 1, 2));
  EXPECT_THROW(all.merge(done(3, 1, 2)), std::invalid_argument);
  EXPECT_THROW(all.merge(done(4, 2, 2)), std::invalid_argument);
}

TEST(IterationSet, ServesOnlyItsOwnJob) {
  EXPECT_TRUE(done(3, 1, 2).serves(IterationSet(3, 1)));
  EXPECT_FALSE(done(3, 1, 2).serves(IterationSet(3, 2)));
  EXPECT_FALSE(done(3, 1, 2).serves(IterationSet(4, 1)));
  EXPECT_FALSE(done(3, 1, 2).serves(IterationSet()));
  EXPECT_FALSE(done(1, 0, 2).serves(IterationSet(3, 1)));
}

TEST(IterationSet, ComesBackFromBytesAndRefusesOthers) {
  IterationSet set = done(5, 3, 9);
  ByteWriter out;
  set.save(out);
  ByteReader in(out.bytes());
  IterationSet again;
  again.load(in);
  EXPECT_TRUE(in.at_end());
  EXPECT_EQ(again.next(), set.next());
  EXPECT_TRUE(again.serves(set));
  const auto refused = [](std::uint32_t shards, std::uint32_t first,
                          const std::vector<std::uint64_t>& counts) {
    ByteWriter bytes;
    bytes.put(shards);
    bytes.put(first);
    bytes.put(counts);
    ByteReader bad(bytes.bytes());
    EXPECT_THROW(IterationSet().load(bad), std::runtime_error);
  };
  refused(0, 0, {1});
  refused(3, 3, {1});
  refused(3, 0, {1, 2});
  refused(3, 1, {1, 2, 3});
  refused(1, 0, {});
  refused(1, 0, {std::uint64_t{1} << 32});
  refused(1U << 17, 0, {1});
}

}  // namespace
}  // namespace lacuna
