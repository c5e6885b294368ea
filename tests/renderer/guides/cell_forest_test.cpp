// Cells of surfaces: regions divided by place and normal.

#include "renderer/guides/cell_forest.h"

#include <gtest/gtest.h>

#include "renderer/core/rng.h"

namespace lacuna {
namespace {

using Key = CellForest::Key;

/// A vertex of a room with floor and ceiling, at z = 0 and 1; a long one, along x.
Key in_room(float length, Rng& rng) {
  const float up = rng.next() < 0.5F ? 1.0F : -1.0F;
  return {length * rng.next(), rng.next(), up > 0 ? 0.0F : 1.0F, 0, 0, up};
}

struct Forest {
  CellForest forest{2};
  std::size_t divisions = 0;

  void divide(const std::vector<std::vector<Key>>& keys, double most, std::size_t limit = 1000) {
    std::vector<CellForest::Spread> spreads(forest.cells());
    for (std::uint32_t r = 0; r < keys.size(); ++r) {
      for (const Key& k : keys[r]) spreads[forest.cell(r, k)].add(k);
    }
    forest.divide(spreads, most, limit, [this](std::uint32_t) { ++divisions; });
  }
};

std::vector<Key> room(float length, int n) {
  std::vector<Key> keys;
  Rng rng(31, 0, 0, Rng::Purpose::test);
  for (int i = 0; i < n; ++i) keys.push_back(in_room(length, rng));
  return keys;
}

TEST(CellForest, FacesApartAreDividedFirst) {
  Forest f;
  f.divide({room(1, 1000), {}}, 600);
  EXPECT_EQ(f.forest.cells(), 3U);
  EXPECT_EQ(f.divisions, 1U);
  // Floor and ceiling, wherever on them; the other region is whole.
  const Key floor{0.2F, 0.3F, 0, 0, 0, 1}, there{0.9F, 0.1F, 0, 0, 0, 1};
  const Key ceiling{0.2F, 0.3F, 1, 0, 0, -1};
  EXPECT_EQ(f.forest.cell(0, floor), f.forest.cell(0, there));
  EXPECT_NE(f.forest.cell(0, floor), f.forest.cell(0, ceiling));
  EXPECT_EQ(f.forest.cell(1, floor), f.forest.cell(1, ceiling));
}

TEST(CellForest, LongRoomsAreDividedAlong) {
  Forest f;
  f.divide({{}, room(20, 1000)}, 600);
  EXPECT_NE(f.forest.cell(1, {1, 0, 0, 0, 0, 1}), f.forest.cell(1, {19, 0, 0, 0, 0, 1}));
  EXPECT_EQ(f.forest.cell(1, {1, 0, 0, 0, 0, 1}), f.forest.cell(1, {1, 0, 1, 0, 0, -1}));
}

TEST(CellForest, ReachesTheMostInAFewRounds) {
  Forest f;
  const std::vector<std::vector<Key>> keys{room(3, 20000), room(1, 100)};
  for (int round = 0; round < 8; ++round) f.divide(keys, 500);
  std::vector<int> met(f.forest.cells(), 0);
  for (std::uint32_t r = 0; r < 2; ++r) {
    for (const Key& k : keys[r]) ++met[f.forest.cell(r, k)];
  }
  for (const int n : met) {
    EXPECT_GE(n, 100);
    EXPECT_LE(n, 500);
  }
  EXPECT_EQ(f.forest.cells(), f.divisions + 2);
}

TEST(CellForest, StopsAtTheLimitAndAtOnePlace) {
  Forest f;
  for (int round = 0; round < 8; ++round) f.divide({room(3, 20000), {}}, 500, 7);
  EXPECT_EQ(f.forest.cells(), 7U);
  Forest point;
  point.divide({std::vector<Key>(5000, Key{100, 20, 3, 0, 0, 1}), {}}, 500);
  EXPECT_EQ(point.forest.cells(), 2U);
}

TEST(CellForest, IsSavedAndLoaded) {
  Forest f;
  f.divide({room(3, 5000), room(9, 4000)}, 200);
  ByteWriter saved;
  f.forest.save(saved);
  CellForest other(2);
  ByteReader in(saved.bytes());
  other.load(in, 2);
  EXPECT_EQ(other.cells(), f.forest.cells());
  for (const Key& k : room(9, 100)) EXPECT_EQ(other.cell(1, k), f.forest.cell(1, k));
  for (const std::size_t regions : {std::size_t{1}, saved.bytes().size()}) {
    ByteReader again(saved.bytes());
    EXPECT_THROW(CellForest(regions).load(again, regions), std::runtime_error);
  }
}

TEST(CellForest, OfCirclesIsRefused) {
  struct Node {
    std::uint32_t low, axis, cell;
    float at;
  };
  const auto load = [](const std::vector<Node>& nodes) {
    ByteWriter out;
    out.put(nodes);
    ByteReader in(out.bytes());
    CellForest(1).load(in, 1);
  };
  EXPECT_NO_THROW(load({{1, 2, 0, 0.5F}, {0, 0, 0, 0}, {0, 0, 1, 0}}));
  EXPECT_THROW(load({{1, 2, 0, 0.5F}, {1, 0, 0, 0}, {0, 0, 1, 0}}), std::runtime_error);
  EXPECT_THROW(load({{2, 2, 0, 0.5F}, {0, 0, 0, 0}, {0, 0, 1, 0}}), std::runtime_error);
  EXPECT_THROW(load({{1, 6, 0, 0.5F}, {0, 0, 0, 0}, {0, 0, 1, 0}}), std::runtime_error);
  EXPECT_THROW(load({{1, 2, 0, 0.5F}, {0, 0, 2, 0}, {0, 0, 1, 0}}), std::runtime_error);
}

}  // namespace
}  // namespace lacuna
