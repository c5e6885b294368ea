// Gates and node maps against sums of one light after another.

#include "renderer/visibility/gate_visibility.h"
#include "renderer/visibility/node_map_visibility.h"
#include "renderer/visibility/plain_visibility.h"
#include "tests/renderer/many_lights/lit_scene.h"

namespace lacuna {
namespace {

using test::gathered;
using test::LitScene;

/// The sum over all lights of what they give times `v(light)`; what is below 0 is tested by a ray.
template <class V>
double by_hand(const LitScene& lit, const ShadingPoint& at, V&& v) {
  double total = 0;
  Terms terms;
  const VplSet& lights = lit.lights();
  for (std::size_t b = 0; b < lights.blocks(at.edges); ++b) {
    lit.terms().evaluate(at, b, terms);
    for (int i = 0; i < lights.count(b); ++i) {
      double seen = v(lights.geometry(b, i));
      if (seen < 0) seen = lit.scene().rays().occluded(lit.terms().ray(at, b, i)) ? 0 : 1;
      if (terms.r[i] > 0) total += double(terms.r[i]) * seen;
    }
  }
  return total;
}

/// `expected(at, light)`: V by its definition.
template <class Visibility, class V>
void expect_sums(const LitScene& lit, const Visibility& visibility, V&& expected) {
  int compared = 0, shadowed = 0;
  for (const std::uint32_t first : {0U, 400U, 900U}) {
    lit.with_points(first, [&](std::span<const ShadingPoint> points) {
      const auto values = gathered(lit, lit.context(1), visibility, points);
      const auto all = gathered(lit, lit.context(1), NoVisibility{{}}, points);
      for (std::size_t k = 0; k < points.size(); ++k) {
        const double sum = by_hand(
            lit, points[k], [&](const VplGeometry& light) { return expected(points[k], light); });
        // A light at the rim of a gate may count or not.
        EXPECT_NEAR(values[k], sum, 1e-4 * all[k] + 1e-12);
        compared += all[k] > 0;
        shadowed += all[k] > 1.05 * values[k];
      }
    });
  }
  EXPECT_GT(compared, 50);
  EXPECT_GT(shadowed, 20) << "nothing was in shadow";
}

/// The visibility clusters of a scene's nodes.
class NodeClusters {
 public:
  explicit NodeClusters(SpaceAnalysis& space)
      : lookup(space.voxels().transform, space.node_map()),
        clusters_(space.clusters()),
        simplified_(space.simplified()) {}
  std::uint32_t operator()(std::uint32_t node) const {
    return clusters_.of_node[simplified_.parent[node]];
  }
  const SurfaceLookup lookup;

 private:
  const VisibilityClusters& clusters_;
  const SimplifiedSkeleton& simplified_;
};

class SkeletonShadows : public testing::TestWithParam<test::PathScene> {};

TEST_P(SkeletonShadows, OfNodeMapsAreThoseOfTheLightsNodes) {
  LitScene lit(GetParam(), 200, 2);
  const NodeMapsVisibilitySettings settings{.map_size = 32, .filter = 3};
  NodeMapVisibility visibility(settings);
  lit.prepare(visibility);
  const GridTransform transform = lit.space().voxels().transform;
  std::vector<V3f> nodes;
  for (const Imath::V3i& c : lit.space().filtered().graph.corners) {
    nodes.emplace_back(transform.to_world(V3d(c)));
  }
  const NodeMaps maps = trace_node_maps(lit.scene(), nodes, 32, lit.pool(), no_memory_limit);
  const SurfaceLookup lookup(transform, lit.space().filtered_map());
  expect_sums(lit, visibility, [&](const ShadingPoint& at, const VplGeometry& light) {
    const std::uint32_t node = node_of(lookup, light);
    if (node == no_node) return -1.0;
    const Vertex& v = *at.vertex;
    const V3f n = dot(v.wp, v.surface.ng) < 0 ? -v.surface.ng : v.surface.ng;
    return double(NodeView(maps, node, nodes[node], 3).visible_fraction(v.surface.x, n));
  });
}

TEST_P(SkeletonShadows, OfGatesAreClustersAndCones) {
  LitScene lit(GetParam(), 200, 2);
  for (const GateFalloff falloff : {GateFalloff::cosine, GateFalloff::rim, GateFalloff::none}) {
    GateVisibility visibility({.falloff = falloff});
    lit.prepare(visibility);
    SpaceAnalysis& space = lit.space();
    const GridTransform transform = space.voxels().transform;
    const NodeClusters cluster_of(space);
    const SurfaceLookup& lookup = cluster_of.lookup;
    const VisibilityGates& gates = space.gates();
    expect_sums(lit, visibility, [&](const ShadingPoint& at, const VplGeometry& light) {
      const std::uint32_t from = node_of(lookup, light), to = node_of(lookup, at);
      if (from == no_node || to == no_node) return -1.0;
      if (cluster_of(from) == cluster_of(to)) return 1.0;
      double most = 0;
      for (const VisibilityGate& g : gates.gates) {
        if (g.clusters[0] != cluster_of(from) && g.clusters[1] != cluster_of(from)) continue;
        const V3d y(light.x), c(transform.to_world(V3d(g.centre))), a(g.axis);
        const V3d w = (V3d(at.vertex->surface.x) - y).normalized();
        const double t = (c - y).dot(a) / w.dot(a);
        const double r = (y + w * t - c).length() / (double(g.radius) * transform.voxel_size);
        if (!(t > 0 && r <= 1)) continue;
        const double cosine = w.dot((c - y).normalized());
        most = std::max(most, falloff == GateFalloff::cosine ? std::max(0.0, cosine)
                              : falloff == GateFalloff::rim  ? 1 - r * r
                                                             : 1);
      }
      return most;
    });
  }
}

TEST_P(SkeletonShadows, OfGatesAreTheSameByGeometryClusters) {
  LitScene lit(GetParam(), 200, 2);
  GateVisibility points({}), clusters({.tests = GateTests::clusters});
  lit.prepare(points);
  lit.prepare(clusters);
  for (const std::uint32_t first : {0U, 400U, 900U}) {
    lit.with_points(first, [&](std::span<const ShadingPoint> shaded) {
      EXPECT_EQ(gathered(lit, lit.context(1), points, shaded),
                gathered(lit, lit.context(1), clusters, shaded));
    });
  }
  const auto told = clusters.statistics();
  ASSERT_EQ(told.size(), 6U);
  EXPECT_GT(told[2].second, 0) << told[2].first;
  EXPECT_LE(told[4].second, told[5].second) << "tests of points";
}

TEST_P(SkeletonShadows, WithoutGatesAreClustersAlone) {
  LitScene lit(GetParam(), 200, 2);
  GateVisibility visibility({.through_gates = false});
  lit.prepare(visibility);
  const NodeClusters cluster_of(lit.space());
  expect_sums(lit, visibility, [&](const ShadingPoint& at, const VplGeometry& light) {
    const std::uint32_t from = node_of(cluster_of.lookup, light),
                        to = node_of(cluster_of.lookup, at);
    if (from == no_node || to == no_node) return -1.0;
    return cluster_of(from) == cluster_of(to) ? 1.0 : 0.0;
  });
  const auto told = visibility.statistics();
  EXPECT_EQ(told[0].second, lit.space().clusters().count);
  EXPECT_EQ(told[1].second, 0) << told[1].first;
}

INSTANTIATE_TEST_SUITE_P(All, SkeletonShadows,
                         testing::Values(test::PathScene{"ajar"}, test::PathScene{"bends"},
                                         test::PathScene{"many_lights"},
                                         test::PathScene{"open", true}),
                         [](const auto& s) { return s.param.name; });

// A cone and a sphere that do not meet have no common point; most that have none do not meet.
TEST(GeometryClusters, MissNoPointInACone) {
  Rng rng(9, 0, 0, Rng::Purpose::test);
  const auto random = [&] { return V3f(rng.next(), rng.next(), rng.next()) * 2.0F - V3f(1.0F); };
  int within = 0, missed = 0, meets = 0;
  for (int n = 0; n < 4000; ++n) {
    const V3f gate = random(), axis = random().normalized(), centre = random() * 2.0F;
    const float gate_radius = 0.6F * rng.next(), radius = 0.5F * rng.next();
    const auto all = [](const V3f& v) { return Float8x3{v.x, v.y, v.z}; };
    const bool said = cone_meets(all(gate), gate_radius * gate_radius, all(centre), radius) == 0xff;
    meets += said;
    bool inside = false;
    for (int k = 0; k < 50; ++k) {
      const V3f w = centre + random().normalized() * (radius * rng.next());
      const float t = gate.dot(axis) / w.dot(axis);
      inside = inside || (t > 0 && (w * t - gate).length() <= gate_radius);
    }
    within += inside;
    missed += inside && !said;
  }
  EXPECT_EQ(missed, 0);
  EXPECT_GT(within, 200);
  EXPECT_LT(meets, 3000);
}

// Groups change the order of the lights, and nothing else.
TEST(VplSet, InGroupsGiveTheSame) {
  struct ByPlace : ExactVisibility {
    using ExactVisibility::ExactVisibility;
    static std::uint32_t group(const VplGeometry& p) {
      if (p.infinite || p.n == V3f(0.0F)) return no_group;
      return p.n.y > 0.5F ? 7 : p.x.x > 0 ? 3 : 0;
    }
  };
  for (const test::PathScene& scene : {test::PathScene{"ajar"}, {"open", true}, {"many_lights"}}) {
    LitScene lit(scene, 300, 2);
    std::vector<double> expected;
    lit.with_points(300, [&](auto points) {
      expected = gathered(lit, lit.context(1), ExactVisibility{{}}, points);
    });
    const std::size_t size = lit.lights().size();
    ByPlace grouped{{}};
    lit.prepare(grouped);
    EXPECT_EQ(lit.lights().size(), size);
    for (std::size_t b = 0; b < lit.lights().blocks(); ++b) {
      for (int i = 0; i < lit.lights().count(b); ++i) {
        EXPECT_EQ(ByPlace::group(lit.lights().geometry(b, i)), lit.lights().group(b));
      }
    }
    lit.with_points(300, [&](auto points) {
      const auto values = gathered(lit, lit.context(1), grouped, points);
      ASSERT_EQ(values.size(), expected.size());
      for (std::size_t i = 0; i < values.size(); ++i) {
        EXPECT_NEAR(values[i], expected[i], 1e-5 * expected[i]);
      }
    });
  }
}

}  // namespace
}  // namespace lacuna
