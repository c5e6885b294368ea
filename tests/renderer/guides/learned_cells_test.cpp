// What a cell learns is the light that arrives in it, however the directions were sampled.

#include "renderer/guides/learned_cells.h"

#include <gtest/gtest.h>

#include "tests/statistics.h"

namespace lacuna {
namespace {

/// Radiance from unit `w`: a window on one side, a dim wall elsewhere.
double radiance(const V3f& w) { return w.x > 0.5F ? 5 : w.z > 0 ? 1 : 0.25; }

V3f uniform(Rng& rng) { return from_square(rng.next2()); }

/// A direction, most often from above, and its density.
std::pair<V3f, Pdf<SolidAngle>> from_above(Rng& rng) {
  V3f w = uniform(rng);
  if (rng.next() < 0.8F) w.z = std::abs(w.z);
  return {w, Pdf<SolidAngle>((w.z > 0 ? 0.9F : 0.1F) / (2 * pi))};
}

LearnedCells learned(int rounds, int samples, std::uint64_t seed, const ThreadPool& pool) {
  LearnedCells cells(2);
  for (std::uint64_t i = 0; cells.rounds() < static_cast<std::uint64_t>(rounds); ++i) {
    Rng rng(seed, i, 0, Rng::Purpose::test);
    LearnedCells::Accumulator part = cells.accumulator();
    for (int k = 0; k < samples; ++k) {
      const auto [w, p] = from_above(rng);
      LearnedCells::accumulate(1, w, static_cast<float>(radiance(w)), p, part);
    }
    const LearnedCells::Accumulator* parts[] = {&part};
    if (cells.update(parts, pool, 1)) cells.next_round(pool);
  }
  return cells;
}

/// Light from the window, from above and from below, far from their borders, which the filter of
/// the tree smears: shares of these three.
std::array<double, 3> shares(const std::function<double(const V3f&)>& light) {
  Rng rng(34, 0, 0, Rng::Purpose::test);
  std::array<double, 3> sums{};
  double all = 0;
  for (int i = 0; i < 400000; ++i) {
    const V3f w = uniform(rng);
    const bool window = w.x > 0.8F, wall = w.x < 0.1F && std::abs(w.z) > 0.4F;
    if (!window && !wall) continue;
    const double l = light(w);
    sums[window ? 0 : w.z > 0 ? 1 : 2] += l;
    all += l;
  }
  for (double& s : sums) s /= all;
  return sums;
}

TEST(LearnedCells, LearnTheLightThatArrives) {
  const ThreadPool pool(2);
  const std::array<double, 3> expected = shares(radiance);
  std::array<statistics::Moments, 3> found;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const LearnedCells cells = learned(4, 4000, seed, pool);
    EXPECT_TRUE(cells.tree(0).empty());
    const auto of_tree = shares([&](const V3f& w) { return double(cells.tree(1).pdf(w).value); });
    for (std::size_t i = 0; i < 3; ++i) found[i].add(of_tree[i]);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(found[i].mean(), expected[i], 0.02 + 5 * found[i].standard_error()) << i;
  }
}

TEST(LearnedCells, CountAndDivideVertices) {
  const ThreadPool pool(1);
  LearnedCells cells(1);
  LearnedCells::Accumulator a = cells.accumulator(), b = cells.accumulator();
  LearnedCells::accumulate(0, {0, 0, 1}, 1, Pdf<SolidAngle>(1.0F), a);
  LearnedCells::accumulate(0, {0, 0, 1}, 0, Pdf<SolidAngle>(1.0F), b);
  LearnedCells::accumulate(0, {0, 0, 1}, INFINITY, Pdf<SolidAngle>(1.0F), b);
  const LearnedCells::Accumulator* parts[] = {&a, &b};
  ASSERT_TRUE(cells.update(parts, pool, 1));
  EXPECT_EQ(cells.vertices(0), 3);
  cells.divide(0);
  EXPECT_EQ(cells.vertices(1), 1.5);
  cells.next_round(pool);
  EXPECT_EQ(cells.vertices(0), 0);
  EXPECT_FALSE(cells.tree(0).empty());
  EXPECT_FALSE(cells.tree(1).empty());
  // The second round has two iterations.
  const LearnedCells::Accumulator empty = cells.accumulator();
  const LearnedCells::Accumulator* none[] = {&empty};
  EXPECT_FALSE(cells.update(none, pool, 1));
  EXPECT_TRUE(cells.update(none, pool, 1));
  cells.next_round(pool);
  EXPECT_FALSE(cells.tree(0).empty()) << "without samples the old tree stays";
}

}  // namespace
}  // namespace lacuna
