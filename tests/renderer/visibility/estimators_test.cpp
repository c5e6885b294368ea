// Visibilities that test by chance have the mean of exact visibility with the same lights, whatever
// they take the visibility to be before they test.

#include "renderer/visibility/probabilistic_visibility.h"
#include "renderer/visibility/roulette_visibility.h"
#include "tests/renderer/visibility/mean_of_exact.h"

namespace lacuna {
namespace {

using test::expect_mean_of_exact;
using test::LitScene;

/// Cache points of other points than those asked for, or none: q is wrong, or unknown.
template <class Settings, class Change>
Settings changed(const Change& change) {
  Settings s;
  s.cache_points = 40;
  change(s);
  return s;
}

class Estimators : public testing::TestWithParam<test::PathScene> {};

TEST_P(Estimators, HaveTheMeanOfExact) {
  const LitScene lit(GetParam(), 120, 2);
  using Probabilistic = ProbabilisticVisibilitySettings;
  const auto same = [](auto&) {};
  const std::vector<Probabilistic> choices{
      changed<Probabilistic>(same),
      changed<Probabilistic>([](auto& s) { s.cache_points = 1; }),
      changed<Probabilistic>([](auto& s) { s.neighbours = 8, s.epsilon_variance = 0.25; }),
      changed<Probabilistic>([](auto& s) { s.term_cost = 0, s.epsilon_probability = 0.3; }),
      changed<Probabilistic>([](auto& s) { s.epsilon_probability = 1; }),
      changed<Probabilistic>([](auto& s) {  // as published
        s.variance = VarianceOf::cache_points, s.term_cost = 0;
        s.draws = TestDraws::bernoulli, s.cache_lights = CacheLights::all;
      }),
  };
  lit.with_points(400, [&](std::span<const ShadingPoint> points) {
    ASSERT_GT(points.size(), 5U);
    for (const Probabilistic& s : choices) {
      SCOPED_TRACE(testing::Message() << "points " << s.cache_points << ", neighbours "
                                      << s.neighbours << ", epsilon " << s.epsilon_probability);
      ProbabilisticVisibility visibility(s);
      const IterationContext context = lit.context(1);
      visibility.begin(lit.pass(context));
      expect_mean_of_exact(lit, visibility, points,
                           s == choices[0] && GetParam().name == "cornell");
    }
    for (const RouletteRule rule : {RouletteRule::veach, RouletteRule::derived}) {
      RouletteVisibilitySettings s = changed<RouletteVisibilitySettings>(same);
      s.rule = rule;
      s.draws = rule == RouletteRule::veach ? TestDraws::bernoulli : TestDraws::systematic;
      s.epsilon_probability = 0.05;
      RouletteVisibility visibility(s);
      const IterationContext context = lit.context(1);
      visibility.begin(lit.pass(context));
      expect_mean_of_exact(lit, visibility, points, GetParam().name == "cornell");
    }
  });
}

INSTANTIATE_TEST_SUITE_P(All, Estimators,
                         testing::Values(test::PathScene{"cornell"}, test::PathScene{"ajar"},
                                         test::PathScene{"open", true}),
                         [](const auto& s) { return s.param.name; });
INSTANTIATE_TEST_SUITE_P(Long, Estimators, testing::Values(test::PathScene{"coated"}),
                         [](const auto& s) { return s.param.name; });

// All cache points in another room, where none of the lights is seen as from here.
TEST(Estimators, WithCachePointsInAnotherRoom) {
  const LitScene lit({"ajar"}, 200, 2);
  lit.with_points(0, [&](std::span<const ShadingPoint> points) {
    ProbabilisticVisibility visibility(changed<ProbabilisticVisibilitySettings>(
        [](auto& s) { s.cache_points = 3, s.neighbours = 1; }));
    // Shading points are moved to where the lights are: the cache is not.
    const IterationContext context = lit.context(1);
    visibility.begin(lit.pass(context));
    std::vector<Vertex> moved;
    for (const ShadingPoint& p : points) moved.push_back(*p.vertex);
    const DiffuseBlock* block = lit.lights().diffuse(0);
    ASSERT_NE(block, nullptr);
    for (std::size_t i = 0; i < moved.size(); ++i) {
      const int k = static_cast<int>(i % Lanes::size);
      moved[i].surface.x = V3f(block->x[k], block->y[k], block->z[k]) +
                           0.05F * V3f(block->gx[k], block->gy[k], block->gz[k]);
    }
    std::vector<ShadingPoint> elsewhere;
    for (std::size_t i = 0; i < moved.size(); ++i) {
      elsewhere.emplace_back(moved[i], 1, 3, points[i].pixel);
    }
    expect_mean_of_exact(lit, visibility, elsewhere, false);
  });
}

TEST(Estimators, OfOneLight) {
  const LitScene lit({"ajar"}, 1, 2, true);
  ASSERT_LE(lit.lights().size(), 4U);
  lit.with_points(400, [&](std::span<const ShadingPoint> points) {
    ProbabilisticVisibility visibility(
        changed<ProbabilisticVisibilitySettings>([](auto& s) { s.cache_points = 3; }));
    const IterationContext context = lit.context(1);
    visibility.begin(lit.pass(context));
    expect_mean_of_exact(lit, visibility, points, false);
  });
}

/// The lights that `visibility` tests at `at`, of the contributions times `weight`.
template <class Visibility>
std::vector<std::uint64_t> tested(const LitScene& lit, const Visibility& visibility,
                                  const ShadingPoint& at, float weight) {
  const IterationContext context = lit.context(1);
  auto state = visibility.at(at, context);
  visibility.share(std::span(&at, 1), std::span(&state, 1), context);
  Terms terms;
  VisibilityEstimate estimate;
  std::vector<std::uint64_t> tests;
  for (std::size_t b = 0; b < lit.lights().blocks(); ++b) {
    lit.terms().evaluate(at, b, terms, VplContributions::all_lights, weight);
    visibility.decide(state, b, terms, estimate);
    tests.push_back(estimate.tests);
  }
  return tests;
}

// The factor of sampled lights is in their contributions and in the deviation alike.
TEST(Estimators, TestSampledLightsAsOftenAsTheOthers) {
  const LitScene lit({"ajar"}, 200, 2);
  const IterationContext context = lit.context(1);
  ProbabilisticVisibility probabilistic(changed<ProbabilisticVisibilitySettings>([](auto&) {}));
  RouletteVisibility roulette(changed<RouletteVisibilitySettings>([](auto&) {}));
  probabilistic.begin(lit.pass(context));
  roulette.begin(lit.pass(context));
  lit.with_points(400, [&](std::span<const ShadingPoint> points) {
    for (const ShadingPoint& p : points) {
      // A power of two, which rounds nothing.
      EXPECT_EQ(tested(lit, probabilistic, p, 64), tested(lit, probabilistic, p, 1));
      EXPECT_EQ(tested(lit, roulette, p, 64), tested(lit, roulette, p, 1));
    }
  });
}

TEST(CachePoints, TakeAQuarterOfTheTestsOfSampledLights) {
  const LitScene lit({"ajar"}, 200, 2);
  const IterationContext context = lit.context(1);
  LightPass pass = lit.pass(context);
  CachePoints cache(1 << 20, 3, CachePoints::Keep::variances);
  cache.build(pass);
  const double all = static_cast<double>(cache.size()), lights = double(lit.lights().size());
  pass.sampled = 8;
  cache.build(pass);
  EXPECT_LE(double(cache.size()), 0.25 * 1200 * 8 / lights);
  EXPECT_GE(double(cache.size()), 0.8 * 0.25 * all * 8 / lights - 1);
  pass.sampled = lit.lights().size();
  cache.build(pass);
  EXPECT_EQ(double(cache.size()), all);
}

// Behind the horizon of all cache points nothing is known of a light, whatever it is later.
TEST(Estimators, TestLightsThatNoCachePointKnows) {
  const LitScene lit({"ajar"}, 200, 2);
  const IterationContext context = lit.context(1);
  const auto settings = changed<ProbabilisticVisibilitySettings>(
      [](auto& s) { s.cache_points = 3, s.neighbours = 1; });
  ProbabilisticVisibility visibility(settings);
  visibility.begin(lit.pass(context));
  CachePoints cache(3, 1, CachePoints::Keep::visibilities);
  cache.build(lit.pass(context));
  std::uint64_t unknown_lights = 0;
  lit.with_points(400, [&](std::span<const ShadingPoint> points) {
    for (const ShadingPoint& p : points) {
      const auto tests = tested(lit, visibility, p, 1);
      Terms terms;
      Lanes q;
      for (std::size_t b = 0; b < lit.lights().blocks(); ++b) {
        lit.terms().evaluate(p, b, terms);
        const std::uint64_t unknown = terms.lit & ~cache.expected(cache.nearest(p), b, q);
        EXPECT_EQ(tests[b] & unknown, unknown);
        unknown_lights += static_cast<std::uint64_t>(__builtin_popcountll(unknown));
      }
    }
  });
  EXPECT_GT(unknown_lights, 100U) << "the test has no power";
}

// A cache point's own visibility is that of exact tests.
TEST(CachePoints, KnowWhatTheySee) {
  const LitScene lit({"ajar"}, 200, 2);
  CachePoints cache(1 << 20, 1, CachePoints::Keep::visibilities);  // one for each pixel
  const IterationContext context = lit.context(1);
  cache.build(lit.pass(context));
  lit.with_points(200, [&](std::span<const ShadingPoint> points) {
    for (const ShadingPoint& p : points) {
      const CachePoints::Neighbours neighbours = cache.nearest(p);
      ASSERT_EQ(neighbours.n, 1);
      EXPECT_EQ(neighbours.weight[0], 1);
      Terms terms;
      Lanes q;
      double sum = 0, sum2 = 0;
      for (std::size_t b = 0; b < lit.lights().blocks(); ++b) {
        lit.terms().evaluate(p, b, terms);
        EXPECT_EQ(cache.expected(neighbours, b, q), terms.lit);
        for (int i = 0; i < Lanes::size; ++i) {
          const bool seen =
              (terms.lit >> i & 1) != 0 && !lit.scene().rays().occluded(lit.terms().ray(p, b, i));
          EXPECT_EQ(q[i], seen ? 1 : 0);
          const double t = seen ? double(terms.luminance[i]) : 0.0;
          sum += t, sum2 += t * t;
        }
      }
      const auto n = static_cast<double>(lit.lights().size());
      const double deviation = std::sqrt(std::max(0.0, sum2 / n - sum / n * (sum / n)));
      EXPECT_NEAR(double(cache.deviation(VarianceOf::point, p, neighbours)), deviation,
                  1e-4 * deviation + 1e-12);
    }
  });
}

// Eq. 8 interpolates what cache points have stored, whatever the albedo of the shading point.
TEST(CachePoints, DeviationIsStoredOrScaledByTheReceiver) {
  const LitScene lit({"cornell"}, 200, 2);
  CachePoints cache(1 << 20, 1, CachePoints::Keep::variances);  // one for each pixel
  const IterationContext context = lit.context(1);
  cache.build(lit.pass(context));
  int scaled = 0;
  lit.with_points(200, [&](std::span<const ShadingPoint> points) {
    for (const ShadingPoint& p : points) {
      const CachePoints::Neighbours own = cache.nearest(p);
      const float stored = cache.deviation(VarianceOf::cache_points, p, own);
      EXPECT_NEAR(stored, cache.deviation(VarianceOf::point, p, own), 1e-5F * stored);
      EXPECT_EQ(stored, cache.deviation(VarianceOf::cache_points, points[0], own));
      const float other = cache.deviation(VarianceOf::point, points[0], own);
      EXPECT_NEAR(other, stored * points[0].scale / p.scale, 1e-5F * other);
      if (std::abs(points[0].scale - p.scale) > 0.01F * p.scale) ++scaled;
    }
  });
  EXPECT_GT(scaled, 5) << "all have one albedo";
}

// A light that shines along the cache point's own wall gives it nothing and is seen all the same.
TEST(CachePoints, KnowAllLightsIfTheyTestThem) {
  const LitScene lit({"ajar"}, 200, 2);
  CachePoints cache(1 << 20, 1, CachePoints::Keep::visibilities, CacheLights::all);
  CachePoints only_lit(1 << 20, 1, CachePoints::Keep::visibilities);
  const IterationContext context = lit.context(1);
  cache.build(lit.pass(context));
  only_lit.build(lit.pass(context));
  int along = 0, visible = 0;
  lit.with_points(200, [&](std::span<const ShadingPoint> points) {
    for (const ShadingPoint& p : points) {
      const CachePoints::Neighbours neighbours = cache.nearest(p);
      EXPECT_EQ(cache.deviation(VarianceOf::point, p, neighbours),
                only_lit.deviation(VarianceOf::point, p, only_lit.nearest(p)));
      const V3f n = p.vertex->side(), x = p.vertex->surface.x;
      Terms terms;
      Lanes q, q_lit;
      for (std::size_t b = 0; b < lit.lights().blocks(); ++b) {
        lit.terms().evaluate(p, b, terms);
        EXPECT_EQ(cache.expected(neighbours, b, q), lit.lights().mask(b));
        only_lit.expected(neighbours, b, q_lit);
        for (int i = 0; i < lit.lights().count(b); ++i) {
          if ((terms.lit >> i & 1) != 0) {
            EXPECT_EQ(q[i], q_lit[i]);
            continue;
          }
          const VplGeometry light = lit.lights().geometry(b, i);
          const V3f edge = light.x - x;
          if (std::abs(dot(edge, n)) > 1e-6F || dot(light.n, n) < 0.999F) {
            const bool behind = dot(edge, n) < -1e-3F;
            EXPECT_FALSE(behind && q[i] > 0) << "its own wall hides what is behind it";
            continue;
          }
          ++along;
          visible += q[i] > 0;
          const Ray above{x + 1e-4F * n, edge, 1.0F};
          EXPECT_EQ(q[i], lit.scene().rays().occluded(above) ? 0 : 1);
        }
      }
    }
  });
  EXPECT_GT(along, 100) << "the test has no power";
  EXPECT_GT(visible, 10);
}

}  // namespace
}  // namespace lacuna
