// What the filter mixes, and what it must not.

#include "renderer/many_lights/light_filter.h"

#include "tests/renderer/many_lights/lit_scene.h"

namespace lacuna {
namespace {

using test::LitScene;

V2i place(std::uint32_t pixel) {
  return {static_cast<int>(pixel) % 40, static_cast<int>(pixel) / 40};
}
V3d reflected(const ShadingPoint& p) {
  return V3d(p.vertex->throughput * p.vertex->bsdf->albedo());
}

// The same light everywhere stays what it is, whatever the surfaces reflect and however they lie.
TEST(LightFilter, KeepsEvenLight) {
  const LitScene lit({"atrium"}, 10, 2);
  for (const int radius : {1, 8, 32}) {
    lit.with_points(500, [&](std::span<const ShadingPoint> points) {
      LightFilter filter(Image(40, 30), {.filter_radius = radius});
      for (const ShadingPoint& p : points) filter.add(p, reflected(p) * V3d(1, 2, 3));
      for (const ShadingPoint& p : points) {
        const V3d light = filter.at(place(p.pixel)), expected = reflected(p) * V3d(1, 2, 3);
        EXPECT_LT((light - expected).length(), 1e-6 * expected.length());
      }
    });
  }
}

// Light of one pixel spreads over its plane and nowhere else; what no surface is at stays black.
TEST(LightFilter, MixesSurfacesThatAreAlike) {
  const LitScene lit({"cornell"}, 10, 2);
  lit.with_points(580, [&](std::span<const ShadingPoint> points) {
    ASSERT_GT(points.size(), 20U);
    const RandomLightsSettings settings{.filter_radius = 32};
    for (std::size_t from = 0; from < points.size(); from += 7) {
      LightFilter filter(Image(40, 30), settings);
      for (std::size_t i = 0; i < points.size(); ++i) {
        filter.add(points[i], i == from ? reflected(points[i]) : V3d(0.0));
      }
      const Vertex& source = *points[from].vertex;
      for (const ShadingPoint& p : points) {
        const V3f d = p.vertex->surface.x - source.surface.x;
        const bool same_plane = p.vertex->side().dot(source.side()) > 0.9999F &&
                                std::abs(d.dot(source.side())) < 1e-4F * d.length();
        const bool other_side = p.vertex->side().dot(source.side()) < 0.1F;
        const double light = filter.at(place(p.pixel)).length() / reflected(p).length();
        if (same_plane || p.vertex == &source) {
          EXPECT_GT(light, 0.005);
        }
        if (other_side) {
          EXPECT_LT(light, 1e-9);
        }
      }
      EXPECT_EQ(filter.at({0, 0}), V3d(0.0));  // pixels that were never set
    }
  });
}

TEST(LightFilter, GivesNothingBackWhereNothingIsReflected) {
  const LitScene lit({"cornell"}, 10, 2);
  lit.with_points(580, [&](std::span<const ShadingPoint> points) {
    Vertex black = *points[0].vertex;
    black.throughput = Rgb(0, 0, 0);
    const ShadingPoint point(black, 1, 3, points[0].pixel);
    LightFilter filter(Image(40, 30), {.filter_radius = 4});
    filter.add(point, V3d(0.0));
    EXPECT_EQ(filter.at(place(point.pixel)), V3d(0.0));
  });
}

}  // namespace
}  // namespace lacuna
