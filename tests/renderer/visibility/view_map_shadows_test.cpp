// What view maps say of lights and points, against rays.

#include "renderer/visibility/view_map_visibility.h"
#include "tests/renderer/many_lights/lit_scene.h"

namespace lacuna {
namespace {

using test::LitScene;

struct Agreement {
  int seen = 0, unseen = 0, wrong = 0;
  double share() const { return double(wrong) / double(seen + unseen); }
};

Agreement against_rays(LitScene& lit, const ViewMapsVisibilitySettings& settings) {
  ViewMapVisibility visibility(settings);
  lit.prepare(visibility);
  Agreement a;
  for (const std::uint32_t first : {0U, 300U, 600U, 900U}) {
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
            const bool expected = !lit.scene().rays().occluded(lit.terms().ray(p, b, i));
            (expected ? a.seen : a.unseen) += 1;
            a.wrong += (d.untested[i] > 0) != expected;
          });
        }
      }
    });
  }
  EXPECT_GT(std::min(a.seen, a.unseen), 500);
  return a;
}

class ViewMapShadows : public testing::TestWithParam<const char*> {};

TEST_P(ViewMapShadows, AreNearlyThoseOfRays) {
  LitScene lit({GetParam()}, 200, 2);
  using M = ViewMapMethod;
  const Agreement fine_rays = against_rays(lit, {M::per_view, 128, 8});
  const Agreement coarse_rays = against_rays(lit, {M::per_view, 16, 8});
  const Agreement views = against_rays(
      lit, {.method = M::megaviews, .map_size = 64, .levels = 8, .node_texels = 1, .cover = 0});
  const Agreement lods = against_rays(
      lit, {.method = M::many_lods, .map_size = 64, .levels = 8, .node_texels = 1, .cover = 0});
  const Agreement larger = against_rays(
      lit, {.method = M::megaviews, .map_size = 64, .levels = 8, .node_texels = 1.75, .cover = 0});
  const Agreement covering = against_rays(
      lit, {.method = M::megaviews, .map_size = 64, .levels = 8, .node_texels = 1, .cover = 0.82});
  const double all_seen = double(views.unseen) / double(views.seen + views.unseen);
  EXPECT_LT(fine_rays.share(), 0.08);
  EXPECT_LT(views.share(), 0.2);
  EXPECT_LT(views.share(), 0.7 * all_seen);
  EXPECT_LT(fine_rays.share(), coarse_rays.share());
  EXPECT_NEAR(views.share(), lods.share(), 0.02);
  EXPECT_LT(larger.share(), views.share() + 0.1 * all_seen);
  EXPECT_LT(covering.share(), views.share() + 0.05 * all_seen);
}

INSTANTIATE_TEST_SUITE_P(All, ViewMapShadows, testing::Values("ajar", "atrium", "bends"),
                         [](const auto& s) { return std::string(s.param); });

}  // namespace
}  // namespace lacuna
