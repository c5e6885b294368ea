// What view maps say of lights and points, against rays.

#include "renderer/visibility/view_map_visibility.h"

#include <map>

#include "tests/renderer/many_lights/lit_scene.h"
#include "tests/statistics.h"

namespace lacuna {
namespace {

using statistics::Moments;
using test::LitScene;

/// Calls `use(seen, expected, contribution)` for pairs of a light and a point: what the maps say,
/// what a ray says, and the luminance that the light adds where it is seen.
template <class Use>
void for_each_pair(LitScene& lit, const ViewMapsVisibilitySettings& settings, const Use& use) {
  ViewMapVisibility visibility(settings);
  lit.prepare(visibility);
  for (const std::uint32_t first : {0U, 600U}) {
    lit.with_points(first, [&](std::span<const ShadingPoint> points) {
      Terms terms;
      VisibilityEstimate d;
      for (const ShadingPoint& p : points) {
        const auto at = visibility.at(p, lit.context(1));
        for (std::size_t b = 0; b < lit.lights().blocks(p.edges); ++b) {
          lit.terms().evaluate(p, b, terms);
          if (lit.lights().group(b) == no_group || terms.lit == 0) continue;
          visibility.decide(at, b, terms, d);
          EXPECT_EQ(d.tests, 0U);
          for_each_bit(terms.lit, [&](int i) {
            const Rgb value(terms.r[i], terms.g[i], terms.b[i]);
            use(d.untested[i] > 0, !lit.scene().rays().occluded(lit.terms().ray(p, b, i)),
                double(luminance(value)));
          });
        }
      }
    });
  }
}

/// The share of pairs of a light and a point whose visibility is not that of a ray, and the share
/// of those that are not seen.
struct Shares {
  double wrong = 0, unseen = 0;
};

Shares against_rays(LitScene& lit, const ViewMapsVisibilitySettings& settings) {
  int seen = 0, unseen = 0, wrong = 0;
  for_each_pair(lit, settings, [&](bool found, bool expected, double) {
    (expected ? seen : unseen) += 1;
    wrong += found != expected;
  });
  EXPECT_GT(std::min(seen, unseen), 100);
  return {double(wrong) / (seen + unseen), double(unseen) / (seen + unseen)};
}

/// Level of each test. Each compares shares of the same lights and points, over seeds: pairs of one
/// seed have lights and points in common. The measured means are five standard errors or more
/// within their bounds; the largest are those of the atrium, 0.067 with rays and 0.29 with views
/// (0.20 where a receiver's plane was compared at its nearest point in the texel: nodes that need
/// not cover the middle of a texel, `cover` 0, lost by that; docs/notebook/view-maps.md).
constexpr double level = 0.01;
constexpr std::uint64_t seeds = 6;

void expect_below(const Moments& m, double bound, const char* what) {
  EXPECT_LT(statistics::t_test_at_least(m, bound), level)
      << what << ": " << m.mean() << " +- " << m.standard_error() << ", bound " << bound;
}

class ViewMapShadows : public testing::TestWithParam<const char*> {};

TEST_P(ViewMapShadows, AreNearlyThoseOfRays) {
  using M = ViewMapMethod;
  const ViewMapsVisibilitySettings megaviews{
      .method = M::megaviews, .map_size = 64, .levels = 8, .node_texels = 1, .cover = 0};
  const auto changed = [&](const auto& change) {
    ViewMapsVisibilitySettings s = megaviews;
    change(s);
    return s;
  };
  Moments fine, coarser, views, gain, lods, alone, larger, covering;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    LitScene lit({GetParam()}, 100, 2, true, seed);
    const auto wrong = [&](const ViewMapsVisibilitySettings& s) {
      return against_rays(lit, s).wrong;
    };
    const double fine_rays = wrong({M::per_view, 128, 8});
    const Shares plain = against_rays(lit, megaviews);
    fine.add(fine_rays);
    coarser.add(fine_rays - wrong({M::per_view, 16, 8}));
    views.add(plain.wrong);
    gain.add(plain.wrong / plain.unseen);
    lods.add(wrong(changed([](auto& s) { s.method = M::many_lods; })) - plain.wrong);
    alone.add(wrong(changed([](auto& s) {
                s.method = M::many_lods;
                s.share = ViewSharing::none;
              })) -
              plain.wrong);
    larger.add((wrong(changed([](auto& s) { s.node_texels = 1.75; })) - plain.wrong) /
               plain.unseen);
    covering.add((wrong(changed([](auto& s) { s.cover = 0.82; })) - plain.wrong) / plain.unseen);
  }
  expect_below(fine, 0.1, "rays of 128 texels");
  expect_below(coarser, 0, "rays of 128 texels beside those of 16");
  expect_below(views, 0.33, "views");
  expect_below(gain, 0.7, "views beside what calls everything seen");
  expect_below(lods, 0.02, "the two orders of traversal");
  EXPECT_GT(statistics::t_test_at_least(lods, -0.02), 1 - level);
  expect_below(alone, 0.02, "a map for each light");
  expect_below(larger, 0.1, "larger nodes, over what is not seen");
  expect_below(covering, 0.05, "covering nodes, over what is not seen");
}

INSTANTIATE_TEST_SUITE_P(All, ViewMapShadows, testing::Values("atrium"),
                         [](const auto& s) { return std::string(s.param); });
INSTANTIATE_TEST_SUITE_P(Long, ViewMapShadows, testing::Values("ajar", "bends"),
                         [](const auto& s) { return std::string(s.param); });

/// The light that the maps let through over the light that rays let through, less 1.
double bias(const char* scene, std::uint64_t seed) {
  LitScene lit({scene}, 100, 2, true, seed);
  double maps = 0, rays = 0;
  for_each_pair(lit, {}, [&](bool found, bool expected, double value) {
    maps += found ? value : 0;
    rays += expected ? value : 0;
  });
  return maps / rays - 1;
}

// By default walls do not hide themselves. Lights that nearly touch the point weigh most here; a
// picture of this box loses 5 %.
TEST(ViewMapBias, LosesLittleLightInAnEmptyBox) {
  Moments box;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) box.add(-bias("furnace", seed));
  expect_below(box, 0.25, "light lost in an empty box");
}

// Queries without fusion read more texels, and say the same.
TEST(ViewMapQueries, SayTheSameWithoutFusion) {
  LitScene lit({"ajar"}, 300, 2);
  ViewMapVisibility fused({.levels = 6}),
      descending({.levels = 6, .queries = ViewQueries::descend});
  lit.prepare(fused);
  lit.prepare(descending);
  lit.with_points(500, [&](std::span<const ShadingPoint> points) {
    EXPECT_EQ(test::gathered(lit, lit.context(1), fused, points),
              test::gathered(lit, lit.context(1), descending, points));
  });
  std::map<std::string, double> stats;
  for (const auto& [name, value] : descending.statistics()) stats[name] = value;
  EXPECT_GT(stats["view_queries"], 1000);
  EXPECT_GT(stats["view_texels_queried"], 2 * stats["view_queries"]);
}

// Rays of one origin in packets hit what they hit one by one.
TEST(ViewMapRays, InPacketsAreAsOneByOne) {
  const LitScene lit({"atrium"}, 100, 2);
  const RayCaster& rays = lit.scene().rays();
  const std::vector<MapTexel> texels = map_texels({16});
  Rng rng(3, 0, 0, Rng::Purpose::test);
  const Bounds& box = lit.scene().bounds();
  std::size_t met = 0, missed = 0, apart = 0;
  for (int k = 0; k < 40; ++k) {
    const V3d size = box.high - box.low;
    const V3f o(box.low + V3d(rng.next(), rng.next(), rng.next()) * size);
    std::vector<Ray> asked;
    for (const MapTexel& t : texels) asked.push_back({o, t.direction});
    asked.resize(asked.size() - 3);  // the last packet is not full
    asked[100].d = V3f(std::numeric_limits<float>::quiet_NaN());
    std::vector<Hit> hits(asked.size());
    std::vector<std::uint8_t> found(asked.size());
    rays.intersect(asked, hits, found);
    for (std::size_t i = 0; i < asked.size(); ++i) {
      Hit alone;
      const bool hit = rays.intersect(asked[i], alone);
      // Rays through the edge of two triangles may hit either.
      apart += found[i] != hit || (hit && std::abs(hits[i].t - alone.t) > 1e-4F * alone.t);
      (hit ? met : missed) += 1;
    }
    EXPECT_EQ(found[100], 0) << "not finite";
  }
  EXPECT_GT(met, 10000U);
  EXPECT_GT(missed, 10U);
  EXPECT_LE(apart, met / 1000);
}

}  // namespace
}  // namespace lacuna
