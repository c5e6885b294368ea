// Sampling a few of all virtual lights: which, how often, and what their sums come to.

#include "renderer/many_lights/vpl_sampler.h"

#include <map>

#include "renderer/visibility/plain_visibility.h"
#include "tests/renderer/many_lights/sampled_means.h"
#include "tests/statistics.h"

namespace lacuna {
namespace {

using test::expect_means_of_all;
using test::gathered;
using test::LitScene;

using Lights = std::map<std::size_t, std::uint64_t>;  // by block

/// All that may be sampled for a point.
Lights candidates(const LitScene& lit, const ShadingPoint& point, bool cull,
                  std::size_t most_stretches = 1024) {
  VplSampler sampler(lit.terms(), {.lights = 1 << 20, .cull = cull}, nullptr, most_stretches);
  Lights all;
  for (const auto& d : sampler.sample(std::span(&point, 1), lit.context(1))) {
    EXPECT_EQ(d.weight, 1.0F);
    EXPECT_EQ(all.count(d.block), 0U);
    all[d.block] = d.lights;
  }
  return all;
}

std::size_t count(const Lights& lights) {
  std::size_t n = 0;
  for (const auto& [block, bits] : lights) n += static_cast<std::size_t>(std::popcount(bits));
  return n;
}

TEST(VplSampler, LeavesOutOnlyWhatIsDark) {
  for (const char* scene : {"ajar", "atrium", "cornell"}) {
    const LitScene lit({scene}, 3000, 2);
    std::size_t fine_left = 0, coarse_left = 0, all = 0;
    lit.with_points(500, [&](std::span<const ShadingPoint> points) {
      Terms terms;
      for (const ShadingPoint& p : points) {
        const Lights fine = candidates(lit, p, true), coarse = candidates(lit, p, true, 20),
                     whole = candidates(lit, p, false);
        std::size_t lights = 0;
        for (std::size_t b = 0; b < lit.lights().blocks(p.edges); ++b) {
          lights += static_cast<std::size_t>(lit.lights().count(b));
          lit.terms().evaluate(p, b, terms);
          for (const Lights* left : {&fine, &coarse}) {
            const auto found = left->find(b);
            EXPECT_EQ(terms.lit & ~(found == left->end() ? 0 : found->second), 0U);
          }
        }
        EXPECT_EQ(count(whole), lights);
        fine_left += count(fine);
        coarse_left += count(coarse);
        all += lights;
      }
    });
    EXPECT_LT(fine_left, coarse_left) << scene;
    EXPECT_LT(coarse_left, all) << scene;
  }
}

// Each candidate is sampled with one probability, never twice, and counts by its inverse.
TEST(VplSampler, SamplesAllAlike) {
  const LitScene lit({"ajar"}, 60, 2);
  constexpr int rounds = 4000;
  lit.with_points(500, [&](std::span<const ShadingPoint> points) {
    const ShadingPoint& point = points[0];
    const Lights all = candidates(lit, point, true);
    const auto n = static_cast<double>(count(all));
    ASSERT_GT(n, 40);
    VplSampler sampler(lit.terms(), {.lights = 16});
    std::map<std::pair<std::size_t, int>, int> times;
    for (int r = 0; r < rounds; ++r) {
      std::size_t sampled = 0;
      for (const auto& d :
           sampler.sample(std::span(&point, 1), lit.context(static_cast<std::uint64_t>(r)))) {
        sampled += static_cast<std::size_t>(std::popcount(d.lights));
        EXPECT_NEAR(d.weight, n / 16, 1e-5 * n);
        EXPECT_EQ(d.lights & ~all.at(d.block), 0U);
        for_each_bit(d.lights, [&](int i) { ++times[{d.block, i}]; });
      }
      ASSERT_EQ(sampled, 16U);
    }
    EXPECT_EQ(times.size(), count(all));
    const double p = 16 / n;
    const double sd = std::sqrt(rounds * p * (1 - p));
    for (const auto& [light, k] : times) EXPECT_NEAR(k, rounds * p, 5.5 * sd);
  });
}

TEST(VplSampler, SumsHaveTheMeanOfAll) {
  for (const char* scene : {"ajar", "atrium", "coated_points"}) {
    SCOPED_TRACE(scene);
    const LitScene lit({scene}, 200, 2);
    for (const bool cull : {true, false}) expect_means_of_all(lit, {.lights = 20, .cull = cull});
  }
}

// With a cutoff those remain that lie within it, and no others.
TEST(VplSampler, LeavesOutWhatIsBeyondTheCutoff) {
  const LitScene lit({"ajar"}, 2000, 2);
  std::size_t beyond = 0;
  lit.with_points(500, [&](std::span<const ShadingPoint> points) {
    for (const ShadingPoint& p : points) {
      const V3f x = p.vertex->surface.x;
      const float reach = 0.7F;
      VplSampler sampler(lit.terms(), {.lights = 1 << 20, .cull = false, .cutoff = reach});
      Lights sampled;
      for (const auto& d : sampler.sample(std::span(&p, 1), lit.context(1)))
        sampled[d.block] = d.lights;
      for (const auto& candidate : candidates(lit, p, false)) {
        const std::size_t block = candidate.first;
        for_each_bit(candidate.second, [&](int i) {
          const bool within = (lit.lights().geometry(block, i).x - x).length2() <= reach * reach;
          EXPECT_EQ((sampled[block] >> i & 1) != 0, within);
          beyond += !within;
        });
      }
    }
  });
  EXPECT_GT(beyond, 1000U);
}

TEST(VplSampler, OfMoreThanThereAreIsAll) {
  const LitScene lit({"ajar"}, 100, 2);
  lit.with_points(400, [&](std::span<const ShadingPoint> points) {
    const ExactVisibility exact{{}};
    VplSampler sampler(lit.terms(), {.lights = 1 << 20});
    const auto all = gathered(lit, lit.context(1), exact, points);
    const auto sampled = gathered(lit, lit.context(1), exact, points, nullptr, {&sampler});
    for (std::size_t i = 0; i < all.size(); ++i) EXPECT_NEAR(sampled[i], all[i], 1e-12 * all[i]);
    EXPECT_GT(sampler.culled(), 0);
    EXPECT_LT(sampler.culled(), 1);
  });
}

TEST(VplSampler, OfNoLightsIsNothing) {
  const LitScene lit({"ajar"}, 1, 2, false);
  lit.with_points(400, [&](std::span<const ShadingPoint> points) {
    const VplSet none(1, {1, false, 0.1F});
    const VplContributions terms(none, 2);
    VplSampler sampler(terms, {});
    EXPECT_TRUE(sampler.sample(points, lit.context(1)).empty());
    EXPECT_EQ(sampler.culled(), 0);
  });
}

}  // namespace
}  // namespace lacuna
