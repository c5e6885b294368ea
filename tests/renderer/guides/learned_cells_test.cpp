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

/// A vertex at the origin, of `cell`, at which `light` came from infinitely far.
TrainingSample found(std::uint32_t cell, const V3f& w, Pdf<SolidAngle> p, float light) {
  return {.cell = {1, cell},
          .x = {0, 0, 0},
          .n = {0, 0, 1},
          .w = w,
          .distance = HUGE_VALF,
          .cosine = 1,
          .pdf = p.value,
          .radiance = light};
}

float density(const DirectionTree& tree, const V3f& w) { return tree.pdf(w).value; }
float density(const AimedLobes& lobes, const V3f& w) { return lobes.pdf({0, 0, 0}, w).value; }

/// What is lost of a window's sharp borders.
template <class Directions>
constexpr double smears = std::is_same_v<Directions, DirectionTree> ? 0.02 : 0.04;

template <class Directions>
class LearnedCellsOf : public testing::Test {};
using AllDirections = testing::Types<DirectionTree, AimedLobes>;
TYPED_TEST_SUITE(LearnedCellsOf, AllDirections);

template <class Directions>
LearnedCells<Directions> learned(int rounds, int samples, std::uint64_t seed,
                                 const ThreadPool& pool) {
  using Cells = LearnedCells<Directions>;
  Cells cells(2);
  for (std::uint64_t i = 0; cells.rounds() < static_cast<std::uint64_t>(rounds); ++i) {
    Rng rng(seed, i, 0, Rng::Purpose::test);
    TrainingSamples::Part part;
    for (int k = 0; k < samples; ++k) {
      const auto [w, p] = from_above(rng);
      part.push_back(found(1, w, p, static_cast<float>(radiance(w))));
    }
    if (cells.update(TrainingSamples(std::span(&part, 1), 2, pool), pool)) cells.next_round(pool);
  }
  return cells;
}

/// Light from the window, from above and from below, far from their borders, which the tree's
/// filter and the lobes smear: shares of these three.
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

TYPED_TEST(LearnedCellsOf, LearnTheLightThatArrives) {
  const ThreadPool pool(2);
  const std::array<double, 3> expected = shares(radiance);
  std::array<statistics::Moments, 3> found;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const auto cells = learned<TypeParam>(4, 4000, seed, pool);
    EXPECT_TRUE(cells.directions(0).empty());
    const auto now = shares([&](const V3f& w) { return double(density(cells.directions(1), w)); });
    for (std::size_t i = 0; i < 3; ++i) found[i].add(now[i]);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(found[i].mean(), expected[i], smears<TypeParam> + 5 * found[i].standard_error())
        << i;
  }
}

TYPED_TEST(LearnedCellsOf, CountAndDivideVertices) {
  using Cells = LearnedCells<TypeParam>;
  const auto up = [](float light) { return found(0, {0, 0, 1}, Pdf<SolidAngle>(1.0F), light); };
  const ThreadPool pool(1);
  Cells cells(1);
  const std::vector<TrainingSamples::Part> parts{{up(1)}, {up(0), up(INFINITY)}};
  ASSERT_TRUE(cells.update(TrainingSamples(parts, 1, pool), pool));
  EXPECT_EQ(cells.vertices(0), 3);
  cells.divide(0);
  EXPECT_EQ(cells.vertices(1), 1.5);
  cells.next_round(pool);
  EXPECT_EQ(cells.vertices(0), 0);
  EXPECT_FALSE(cells.directions(0).empty());
  EXPECT_FALSE(cells.directions(1).empty());
  // The second round is as long as the first, the third as both.
  const TrainingSamples none({}, 2, pool);
  EXPECT_TRUE(cells.update(none, pool));
  cells.next_round(pool);
  EXPECT_FALSE(cells.update(none, pool));
  EXPECT_TRUE(cells.update(none, pool));
  cells.next_round(pool);
  EXPECT_FALSE(cells.directions(0).empty()) << "without samples the old tree stays";
}

}  // namespace
}  // namespace lacuna
