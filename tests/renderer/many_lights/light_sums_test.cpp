// Sums of very many lights, of lights of very different power, and of none.

#include <set>

#include "renderer/visibility/plain_visibility.h"
#include "tests/renderer/many_lights/lit_scene.h"

namespace lacuna {
namespace {

using test::gathered;
using test::LitScene;

/// The sums against those of the same terms in long double, one after another.
void expect_exact_sums(const LitScene& lit, std::span<const ShadingPoint> points) {
  const auto values = gathered(lit, lit.context(1), NoVisibility{{}}, points);
  Terms terms;
  for (std::size_t k = 0; k < points.size(); ++k) {
    long double sum = 0;
    for (std::size_t b = 0; b < lit.lights().blocks(points[k].edges); ++b) {
      lit.terms().evaluate(points[k], b, terms);
      for (int i = 0; i < Lanes::size; ++i) sum += static_cast<long double>(terms.r[i]);
    }
    EXPECT_TRUE(std::isfinite(values[k]));
    EXPECT_NEAR(values[k], double(sum), 1e-6 * double(sum));
  }
}

TEST(LightSums, OfAMillionLights) {
  const LitScene lit({"cornell"}, 700000, 2);
  ASSERT_GT(lit.lights().size(), 1000000U);
  lit.with_points(500, [&](std::span<const ShadingPoint> points) {
    ASSERT_GT(points.size(), 3U);
    expect_exact_sums(lit, points.first(3));
  });
}

TEST(LightSums, OfLightsOverTwentyFourDecades) {
  const LitScene lit({"black"}, 300, 2);
  float least = std::numeric_limits<float>::infinity(), most = 0;
  for (std::size_t b = 0; b < lit.lights().blocks(); ++b) {
    if (const DiffuseBlock* block = lit.lights().diffuse(b)) {
      least = std::min(least, block->g[0]);
      most = std::max(most, block->g[0]);
    }
  }
  EXPECT_GT(double(most) / double(least), 1e24);
  EXPECT_GT(least, 0);
  lit.with_points(500, [&](std::span<const ShadingPoint> points) {
    ASSERT_FALSE(points.empty());
    expect_exact_sums(lit, points);
  });
}

// As many light paths as there are lights of one power: each is a virtual light once.
TEST(LightSums, HaveEachOfAlikeEmittersOnce) {
  constexpr int n = 777;
  const LitScene lit({"particles"}, n, 2);
  std::set<float> met;
  std::size_t points = 0;
  for (std::size_t b = 0; b < lit.lights().blocks(0); ++b) {
    const DiffuseBlock* block = lit.lights().diffuse(b);
    ASSERT_NE(block, nullptr);
    ASSERT_TRUE(block->points);
    for (int i = 0; i < lit.lights().count(b); ++i, ++points) met.insert(block->x[i]);
  }
  EXPECT_EQ(points, n);
  EXPECT_GT(met.size(), n - 3U);  // two may share a coordinate
}

TEST(LightSums, AreNothingWhereAllLightsLieBehind) {
  const LitScene lit({"ajar"}, 200, 2);
  lit.with_points(500, [&](std::span<const ShadingPoint> points) {
    Vertex outside = *points[0].vertex;
    outside.surface.x = V3f(0, 1000, 0);
    outside.surface.ng = outside.surface.ns = outside.wp = V3f(0, 1, 0);
    const ShadingPoint turned(outside, 1, 3, 0);
    Counters counters;
    std::vector<LightSum> sums(1);
    LightGather<ExactVisibility>(lit.context(1), lit.terms(), ExactVisibility{{}}, {})
        .gather(std::span(&turned, 1), sums, counters);
    EXPECT_EQ(sums[0].value, V3d(0.0));
    EXPECT_EQ(sums[0].tests, 0U);
    EXPECT_EQ(counters.shadow_rays, 0U);
  });
}

}  // namespace
}  // namespace lacuna
