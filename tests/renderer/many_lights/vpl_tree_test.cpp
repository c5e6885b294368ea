// Trees of virtual lights: their parts, their bounds and how their lights are chosen.

#include "renderer/many_lights/vpl_tree.h"

#include "tests/renderer/many_lights/lit_scene.h"
#include "tests/statistics.h"

namespace lacuna {
namespace {

using test::LitScene;

TEST(VplTree, DividesAllLights) {
  for (const char* scene : {"ajar", "coated_points", "atrium"}) {
    const LitScene lit({scene}, 500, 2);
    const VplTree tree(lit.lights(), lit.pool());
    ASSERT_EQ(tree.size(), lit.lights().size());
    std::uint32_t next = 0;
    for (const std::uint32_t root : tree.roots()) {
      std::vector<std::uint32_t> waiting{root};
      while (!waiting.empty()) {
        const VplTree::Node& node = tree.node(waiting.back());
        waiting.pop_back();
        if (node.child == 0) {
          EXPECT_EQ(node.first, next++);
          EXPECT_EQ(node.end, next);
          EXPECT_EQ(node.intensity, tree.intensity(node.first));
          continue;
        }
        const VplTree::Node &a = tree.node(node.child), &b = tree.node(node.child + 1);
        EXPECT_EQ(a.first, node.first);
        EXPECT_EQ(a.end, b.first);
        EXPECT_EQ(b.end, node.end);
        EXPECT_NEAR(a.intensity + b.intensity, node.intensity, 1e-5F * node.intensity);
        waiting.push_back(node.child + 1);
        waiting.push_back(node.child);
      }
    }
    EXPECT_EQ(next, tree.size());
  }
}

// So many lights that several threads divide them.
TEST(VplTree, IsTheSameForAnyNumberOfThreads) {
  const LitScene lit({"ajar"}, 8000, 2);
  ASSERT_GT(lit.lights().size(), 20000U);
  const VplTree one(lit.lights(), ThreadPool(1)), three(lit.lights(), ThreadPool(3));
  ASSERT_EQ(one.nodes().size(), three.nodes().size());
  for (std::uint32_t i = 0; i < one.nodes().size(); ++i) {
    const VplTree::Node &a = one.node(i), &b = three.node(i);
    ASSERT_EQ(a.intensity, b.intensity);
    ASSERT_EQ(a.bounds.size2(), b.bounds.size2());
    ASSERT_EQ(std::tie(a.first, a.end, a.child), std::tie(b.first, b.end, b.child));
  }
}

TEST(VplTree, ChoosesByIntensity) {
  const LitScene lit({"ajar"}, 60, 2);
  const VplTree tree(lit.lights(), lit.pool());
  constexpr int rounds = 20000;
  Rng rng(1, 0, 0, Rng::Purpose::test);
  for (const std::uint32_t root : tree.roots()) {
    const VplTree::Node& node = tree.node(root);
    std::vector<double> observed(node.end - node.first), expected;
    for (int r = 0; r < rounds; ++r) ++observed[tree.choose(node, rng.next_choice()) - node.first];
    for (std::uint32_t i = node.first; i < node.end; ++i) {
      expected.push_back(rounds * double(tree.intensity(i)) / double(node.intensity));
    }
    const auto result = statistics::chi_square_test(observed, expected);
    EXPECT_GT(result.p, statistics::sidak(1e-5, tree.roots().size())) << result.message;
  }
}

// A node whose geometric term is 0 holds no light that illuminates the point, and the term at the
// least distance is a bound for each light below.
TEST(VplTree, BoundsGeometricTerms) {
  for (const char* scene : {"ajar", "cornell", "atrium"}) {
    const LitScene lit({scene}, 300, 2);
    const VplTree tree(lit.lights(), lit.pool());
    std::size_t dark = 0;
    lit.with_points(500, [&](std::span<const ShadingPoint> points) {
      Terms terms;
      for (const ShadingPoint& p : points.first(20)) {
        const V3f x = p.vertex->surface.x, n = p.vertex->side();
        for (const VplTree::Node& node : tree.nodes()) {
          if (node.kind != VplTree::Kind::diffuse || node.end - node.first > 64) continue;
          const auto g = node.bounds.geometric_terms({x.x, x.y, x.z}, {n.x, n.y, n.z}, true);
          const float bound = _mm256_cvtss_f32(g.at(g.least2).v);
          dark += bound == 0;
          for (std::uint32_t l = node.first; l < node.end; ++l) {
            const VplGeometry light = lit.lights().geometry(tree.block(l), tree.lane(l));
            const V3f d = light.x - x;
            const float d2 = d.length2();
            const float term =
                std::max(0.0F, dot(d, n)) * std::max(0.0F, -dot(d, light.n)) / (d2 * d2);
            EXPECT_LE(term, bound * (1 + 1e-4F) + 1e-6F / d2);
            if (bound > 0) continue;
            lit.terms().evaluate(p, tree.block(l), terms, std::uint64_t{1} << tree.lane(l));
            EXPECT_EQ(terms.lit, 0U);
          }
        }
      }
    });
    EXPECT_GT(dark, 100U) << scene;
  }
}

}  // namespace
}  // namespace lacuna
