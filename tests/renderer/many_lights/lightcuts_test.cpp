// Lightcuts against the sum of all lights: within the bounds of their nodes, and exact if every
// light is its own node.

#include "renderer/many_lights/lightcuts.h"

#include "renderer/visibility/plain_visibility.h"
#include "tests/renderer/many_lights/lit_scene.h"

namespace lacuna {
namespace {

using test::gathered;
using test::LitScene;

/// The cut of a point with exact visibility.
std::vector<Lightcuts::Entry> cut_of(const LitScene& lit, const Lightcuts& cuts,
                                     const ShadingPoint& p) {
  Terms terms;
  return cuts.cut(p, [&](std::size_t block, int i, float weight) {
    lit.terms().evaluate(p, block, terms, std::uint64_t{1} << i, weight);
    const bool lights =
        terms.lit != 0 && !lit.scene().rays().occluded(lit.terms().ray(p, block, i));
    return lights ? V3d(Rgb(terms.r[i], terms.g[i], terms.b[i])) : V3d(0);
  });
}

double luminance_of_all(const LitScene& lit, const ShadingPoint& p) {
  Counters counters;
  LightSum sum;
  LightGather<ExactVisibility>(lit.context(1), lit.terms(), ExactVisibility{{}}, {})
      .gather(std::span(&p, 1), std::span(&sum, 1), counters);
  return luminance(sum.value.x, sum.value.y, sum.value.z);
}

TEST(Lightcuts, ErrIsWithinTheirBounds) {
  for (const char* scene : {"ajar", "cornell"}) {
    const LitScene lit({scene}, 2000, 2);
    const VplTree tree(lit.lights(), lit.pool());
    std::size_t coarse = 0, fine = 0, most = 0;
    for (const LightcutsSettings& s : {LightcutsSettings{.error = 0.3}, LightcutsSettings{},
                                       LightcutsSettings{.error = 0.001, .most = 200}}) {
      const Lightcuts cuts(lit.terms(), tree, s, lit.context(1));
      lit.with_points(500, [&](std::span<const ShadingPoint> points) {
        for (const ShadingPoint& p : points.first(30)) {
          double sum = 0, bounds = 0, largest = 0;
          const auto cut = cut_of(lit, cuts, p);
          for (const auto& e : cut) {
            sum += luminance(e.value.x, e.value.y, e.value.z);
            bounds += e.bound;
            largest = std::max(largest, e.bound);
          }
          EXPECT_NEAR(sum, luminance_of_all(lit, p), bounds + 1e-4 * sum);
          if (cut.size() < static_cast<std::size_t>(s.most)) {
            EXPECT_LE(largest, s.error * sum * (1 + 1e-9) + 1e-12);
          }
          EXPECT_LE(cut.size(), static_cast<std::size_t>(s.most));
          (s.error == 0.3 ? coarse : s.error == 0.001 ? most : fine) += cut.size();
        }
      });
    }
    EXPECT_LT(coarse, fine);
    EXPECT_GT(most, 0U);
  }
}

TEST(Lightcuts, OfSingleLightsAreTheSumOfAll) {
  for (const char* scene : {"ajar", "coated_points", "atrium"}) {
    const LitScene lit({scene}, 200, 2);
    const VplTree tree(lit.lights(), lit.pool());
    const Lightcuts cuts(lit.terms(), tree, {.error = 0, .most = 1 << 20}, lit.context(1));
    lit.with_points(400, [&](std::span<const ShadingPoint> points) {
      const ExactVisibility exact{{}};
      const auto all = gathered(lit, lit.context(1), exact, points);
      const auto cut = gathered(lit, lit.context(1), exact, points, nullptr, {&cuts});
      for (std::size_t i = 0; i < all.size(); ++i) EXPECT_NEAR(cut[i], all[i], 1e-5 * all[i]);
    });
  }
}

TEST(Lightcuts, ChildrenShareTheRepresentativeOfTheirParent) {
  const LitScene lit({"ajar"}, 2000, 2);
  const VplTree tree(lit.lights(), lit.pool());
  const Lightcuts cuts(lit.terms(), tree, {}, lit.context(1));
  for (std::uint32_t i = 0; i < tree.nodes().size(); ++i) {
    const VplTree::Node& node = tree.node(i);
    const std::uint32_t r = cuts.representative(i);
    ASSERT_TRUE(r >= node.first && r < node.end);
    if (node.child == 0) continue;
    EXPECT_TRUE(cuts.representative(node.child) == r || cuts.representative(node.child + 1) == r);
  }
}

TEST(Lightcuts, OfNoLightsAreNothing) {
  const LitScene lit({"ajar"}, 1, 2, false);
  const VplSet none(1, {1, false, 0.1F});
  const VplContributions terms(none, 2);
  const VplTree tree(none, lit.pool());
  const Lightcuts cuts(terms, tree, {}, lit.context(1));
  lit.with_points(400, [&](std::span<const ShadingPoint> points) {
    EXPECT_TRUE(cut_of(lit, cuts, points[0]).empty());
  });
}

}  // namespace
}  // namespace lacuna
