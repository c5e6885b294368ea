#include "renderer/emitters/pointwise_selection.h"

#include <gtest/gtest.h>

#include <map>

#include "tests/statistics.h"

namespace lacuna {
namespace {

/// Lamps along a line, and lights at infinity; entries are numbered in this order.
struct Site {
  std::vector<double> powers;
  AliasTable by_power;
  std::optional<PointwiseSelection> selection;

  Site(int lamps, const std::vector<double>& infinite) {
    std::vector<TreeEmitter> finite;
    for (int i = 0; i < lamps; ++i) {
      TreeEmitter e;
      e.entry = static_cast<std::uint32_t>(i);
      e.bounds.box.add(V3f(static_cast<float>(i), 0, 0));
      e.bounds.axes = DirectionCone::everything();
      e.bounds.intensity = 1 + i % 3;
      powers.push_back(4 * std::numbers::pi * e.bounds.intensity);
      finite.push_back(e);
    }
    std::vector<PointwiseSelection::Infinite> far;
    for (const double power : infinite) {
      far.push_back({static_cast<std::uint32_t>(powers.size()), power});
      powers.push_back(power);
    }
    double all = 0;
    for (const double p : powers) all += p;
    by_power = AliasTable(powers);
    selection.emplace(std::move(finite), far, all, 0, by_power);
  }
  double probability(std::uint32_t entry, const Receiver& at) const {
    return double(selection->ratio(entry, at)) * double(by_power.pmf(entry).value);
  }
};

TEST(PointwiseSelection, DrawsFollowTheirProbabilities) {
  constexpr int draws = 100000;
  const Receiver at{V3f(3, 1, 0), V3f(0, -1, 0), false, 0.1F};
  for (const auto& [lamps, infinite] :
       {std::pair(20, std::vector<double>{}), {20, {1e6, 10}}, {20, {1e-6}}, {0, {1, 2}}}) {
    const Site site(lamps, infinite);
    Rng rng(1, 0, 0, Rng::Purpose::test);
    std::vector<double> observed(site.powers.size()), expected(site.powers.size());
    double sum = 0;
    for (std::uint32_t i = 0; i < expected.size(); ++i) {
      const double p = site.probability(i, at);
      EXPECT_GT(p, 0);
      sum += p;
      expected[i] = draws * p;
    }
    EXPECT_NEAR(sum, 1, 1e-5);
    for (int k = 0; k < draws; ++k) {
      const PointwiseSelection::Choice c = site.selection->choose(at, rng.next_fine_point(), rng);
      ASSERT_EQ(c.ratio, site.selection->ratio(c.entry, at));
      ++observed[c.entry];
    }
    const auto test = statistics::chi_square_test(observed, expected);
    EXPECT_GT(test.p, 1e-6) << test.message;
  }
}

// However strong the sun, lamps are selected, and the other way round.
TEST(PointwiseSelection, NeitherLampsNorTheSkyAreForgotten) {
  for (const double sun : {1e-20, 1e20}) {
    const Site site(5, {sun});
    EXPECT_GE(site.probability(5, {}), 0.124);
    EXPECT_LE(site.probability(5, {}), 0.876);
  }
}

TEST(PointwiseSelection, TogetherAsAlone) {
  const Site site(100, {50});
  std::vector<Rng> alone, together;
  std::vector<PointwiseSelection::Request> requests(50);
  for (std::size_t i = 0; i < requests.size(); ++i) {
    together.emplace_back(2, 0, i, Rng::Purpose::test);
    requests[i].receiver.x = V3f(static_cast<float>(2 * i), 1, 0);
  }
  alone = together;
  for (std::size_t i = 0; i < requests.size(); ++i) requests[i].rng = &together[i];
  site.selection->choose(requests);
  for (std::size_t i = 0; i < requests.size(); ++i) {
    const PointwiseSelection::Choice c =
        site.selection->choose(requests[i].receiver, alone[i].next_fine_point(), alone[i]);
    EXPECT_EQ(requests[i].result.entry, c.entry);
    EXPECT_EQ(requests[i].result.at.x, c.at.x);
    EXPECT_EQ(requests[i].result.ratio, c.ratio);
    EXPECT_EQ(together[i].next_u32(), alone[i].next_u32());
  }
}

}  // namespace
}  // namespace lacuna
