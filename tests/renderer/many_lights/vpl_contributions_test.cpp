// What virtual lights give, sixty-four at a time, against one connection after another.

#include "tests/renderer/many_lights/lit_scene.h"

namespace lacuna {
namespace {

using test::LitScene;

/// A light of a block of diffuse ones as a vertex of its own: the surface's definition, not that of
/// the block.
Rgb by_hand(const ShadingPoint& at, const DiffuseBlock& from, int i, double bound) {
  const V3d x(from.x[i], from.y[i], from.z[i]);
  const V3d to = x - V3d(at.vertex->surface.x);
  const double d2 = to.length2();
  const V3d w = to / std::sqrt(d2);
  const double cos_y = from.points ? 1 : -w.dot(V3d(from.gx[i], from.gy[i], from.gz[i]));
  if (cos_y <= 0) return Rgb(0, 0, 0);
  const bool front = w.dot(V3d(from.sx[i], from.sy[i], from.sz[i])) < 0;
  const Rgb f =
      at.vertex->throughput * at.vertex->bsdf->eval(at.vertex->wp, V3f(w), Transport::radiance);
  if (from.points) bound = std::numeric_limits<double>::infinity();
  const double g = std::abs(w.dot(V3d(at.vertex->surface.ng))) * cos_y / d2;
  const double scale =
      cos_y / d2 * (front ? double(from.shading_cosine_ratio[i]) : 1.0) * std::min(1.0, bound / g);
  return f * Rgb(from.r[i], from.g[i], from.b[i]) * static_cast<float>(scale);
}

class Terms64 : public testing::TestWithParam<test::PathScene> {};

TEST_P(Terms64, AreThoseOfSingleConnections) {
  for (const float bound : {std::numeric_limits<float>::infinity(), 0.5F}) {
    const LitScene lit(GetParam(), 300, bound);
    ASSERT_GT(lit.lights().size(), 100U);
    std::size_t compared = 0;
    for (const std::uint32_t first : {0U, 333U, 700U}) {
      lit.with_points(first, [&](std::span<const ShadingPoint> points) {
        Terms terms;
        for (const ShadingPoint& p : points) {
          for (std::size_t b = 0; b < lit.lights().blocks(); ++b) {
            const DiffuseBlock* block = lit.lights().diffuse(b);
            if (block == nullptr) continue;
            terms = {};
            lit.terms().evaluate(p, b, terms);
            for (int i = 0; i < Lanes::size; ++i) {
              const Rgb expected = by_hand(p, *block, i, double(bound));
              const float largest = max_component(expected);
              // Where a cosine is next to nothing, rounding decides whether it is.
              const float tolerance = 2e-3F * largest + 1e-6F * luminance(Rgb(block->r[i]));
              EXPECT_NEAR(terms.r[i], expected.x, tolerance);
              EXPECT_NEAR(terms.b[i], expected.z, tolerance);
              compared += largest > 0 ? 1 : 0;
            }
          }
        }
      });
    }
    EXPECT_GT(compared, 1000U);
  }
}

INSTANTIATE_TEST_SUITE_P(All, Terms64,
                         testing::Values(test::PathScene{"cornell"}, test::PathScene{"leaning"},
                                         test::PathScene{"sides"}, test::PathScene{"ajar"},
                                         test::PathScene{"coated_points"}),
                         [](const auto& s) { return s.param.name; });

// Every vertex of the light paths is a light, whatever block it is in, but for black ones.
TEST(VplSet, AreTheVerticesOfTheLightPaths) {
  for (const test::PathScene& scene :
       {test::PathScene{"cornell"}, {"glass"}, {"coated"}, {"open", true}, {"spot"}}) {
    for (const bool emitters : {true, false}) {
      const LitScene lit(scene, 500, 1, emitters);
      // Blocks hold the lights of one depth after another.
      std::size_t expected = 0, counted = 0, block = 0;
      for (int edges = 0; edges < LitScene::max_depth - 1; ++edges) {
        if (edges > 0 || emitters) expected += lit.walked(edges);
        for (; block < lit.lights().blocks(edges); ++block) {
          counted += static_cast<std::size_t>(lit.lights().count(block));
        }
        EXPECT_EQ(counted, expected) << scene << ", " << edges << " edges";
      }
      EXPECT_EQ(lit.lights().size(), expected);
      EXPECT_EQ(lit.lights().blocks(LitScene::max_depth), lit.lights().blocks());
      EXPECT_EQ(lit.lights().blocks(-1), 0U);
    }
  }
}

// A light at the shading point itself gives nothing rather than infinity.
TEST(VplContributions, OfALightAtThePoint) {
  const LitScene lit({"cornell"}, 50, std::numeric_limits<float>::infinity());
  lit.with_points(0, [&](std::span<const ShadingPoint> points) {
    const DiffuseBlock* block = nullptr;
    std::size_t b = 0;
    for (; block == nullptr; ++b) block = lit.lights().diffuse(b);
    Vertex moved = *points[0].vertex;
    moved.surface.x = V3f(block->x[3], block->y[3], block->z[3]);
    const ShadingPoint there(moved, 1, 3, 0);
    Terms terms;
    lit.terms().evaluate(there, b - 1, terms);
    EXPECT_EQ(terms.lit >> 3 & 1, 0U);
    EXPECT_EQ(terms.r[3], 0);
    for (int i = 0; i < Lanes::size; ++i) EXPECT_TRUE(std::isfinite(terms.luminance[i]));
  });
}

}  // namespace
}  // namespace lacuna
