// Which light vertices the nodes of the skeleton see: by shadow rays and by cube maps of depth.

#include "renderer/connections/node_visibility.h"

#include <gtest/gtest.h>

#include <map>

#include "renderer/connections/node_weights.h"
#include "renderer/connections/skeleton_connections.h"
#include "renderer/view_maps/filtered_node_maps.h"
#include "tests/renderer/connections/lit_scene.h"
#include "tests/renderer/many_lights/lit_scene.h"
#include "tests/statistics.h"

namespace lacuna {
namespace {

using statistics::Moments;
using test::Lit;
using test::LitScene;
using test::PathScene;

SkeletonConnectionsSettings seeing_by(NodeVisibilityTest test) {
  SkeletonConnectionsSettings s;
  s.node_visibility = test;
  s.acceptance = 0;
  s.unshadowed = false;
  return s;
}

std::vector<double> by_rays(const Scene& scene, const LightVertices& lights, int s, const V3f& x) {
  std::vector<double> visible;
  for (const Ray& ray : rays_to(lights, s, x))
    visible.push_back(scene.rays().occluded(ray) ? 0 : 1);
  return visible;
}

/// A scene, its skeleton and its light vertices.
struct SeenScene {
  explicit SeenScene(const PathScene& scene) : space(scene, 16, 2), vertices(scene) {}

  LitScene space;
  Lit vertices;
  std::vector<V3f> nodes = filtered_nodes(space.space());
  const LightVertices& lights() const { return vertices.lights; }
};

class NodesSee : public testing::TestWithParam<PathScene> {};

// Area emitters, points, cones, the sun and the sky, and vertices of light paths.
TEST_P(NodesSee, ByMapsWhatTheySeeByRays) {
  SeenScene scene(GetParam());
  NodeVisibility maps;
  maps.prepare(scene.space.prepare_context(), scene.nodes,
               seeing_by(NodeVisibilityTest::node_maps));
  ASSERT_TRUE(maps.by_maps());
  NodeVisibility::Tests tests;
  Moments wrong;  // shares of the vertices that one node decides on
  std::size_t seen = 0, hidden = 0, all = 0;
  for (std::size_t node = 0; node < scene.nodes.size(); ++node) {
    Moments of_node;
    for (int s = 1; s <= scene.lights().longest(); ++s) {
      const auto map = maps.between(scene.space.context(1), node, scene.lights(), s, tests);
      const auto rays = by_rays(scene.space.scene(), scene.lights(), s, scene.nodes[node]);
      ASSERT_EQ(map.size(), rays.size());
      for (std::size_t i = 0; i < map.size(); ++i) {
        EXPECT_GE(map[i], 0);
        EXPECT_LE(map[i], 1.00001);
        of_node.add((map[i] > 0.5) != (rays[i] > 0.5) ? 1 : 0);
        ++(rays[i] > 0.5 ? seen : hidden);
      }
      all += map.size();
    }
    wrong.add(of_node.mean());
  }
  EXPECT_GT(std::min(seen, hidden), all / 50);
  // Most in many_lights, whose emitters are smaller than texels.
  EXPECT_LT(statistics::t_test_at_least(wrong, 0.06), 0.01)
      << wrong.mean() << " +- " << wrong.standard_error();
  // A few decisions are checked.
  EXPECT_EQ(tests.rays, tests.checked);
  EXPECT_GT(tests.checked, all / 100);
  EXPECT_LT(tests.checked, all / 20);
  EXPECT_LE(tests.wrong, tests.checked / 10);
}

// The distribution at each eye vertex is that of V by its definition, whichever way it is decided.
TEST_P(NodesSee, AsTheirDistributionsSay) {
  SeenScene scene(GetParam());
  const auto traced = filtered_node_maps(scene.space.prepare_context(), scene.nodes, node_map_size);
  const double least = scene.space.space().voxels().transform.voxel_size / 2;
  std::map<NodeVisibilityTest, std::uint64_t> rays;
  int apart = 0;
  for (const auto test : {NodeVisibilityTest::rays, NodeVisibilityTest::node_maps}) {
    SkeletonConnections connections(seeing_by(test));
    connections.prepare(scene.space.prepare_context());
    CellStatistics statistics;
    statistics.resize(connections.cells());
    CellStatistics::Accumulator visited(connections.cells());
    for (std::uint32_t n = 0; n < connections.cells(); ++n) visited.visit(n);
    statistics.add({&visited, 1});
    Counters counters;
    connections.begin(scene.space.context(1), scene.lights(), statistics, counters);
    rays[test] = counters.shadow_rays;
    EXPECT_EQ(connections.statistics().size() > 2, test == NodeVisibilityTest::node_maps);

    std::map<std::uint32_t, const ResamplingCell*> cells;
    for (const std::uint32_t first : {0U, 400U, 900U}) {
      scene.space.with_points(first, [&](std::span<const ShadingPoint> points) {
        Rng rng(1, 0, 0, Rng::Purpose::test);
        for (const ShadingPoint& p : points) {
          const auto at = connections.find(*p.vertex, 1, rng);
          if (at.distributions != nullptr) cells[at.cell] = at.distributions;
        }
      });
    }
    EXPECT_GT(cells.size(), 0U);
    for (const auto& [node, cell] : cells) {
      const NodeView view(*traced, node, scene.nodes[node], 1);
      for (int s = 1; s <= scene.lights().longest(); ++s) {
        const std::size_t n = scene.lights().count(s);
        if (n == 0) continue;
        const auto map = visible_fractions(scene.lights(), s, view);
        const auto ray = by_rays(scene.space.scene(), scene.lights(), s, scene.nodes[node]);
        auto v = node_weights(scene.lights(), s, scene.nodes[node], least, LightSides::facing);
        double sum = 0;
        for (std::size_t i = 0; i < n; ++i) {
          apart += v[i] > 0 && map[i] != ray[i];
          v[i] *= test == NodeVisibilityTest::rays ? ray[i] : map[i];
          sum += v[i];
        }
        for (std::size_t i = 0; i < n; ++i) {
          const double uniform = 1 / double(n);
          const double expected = sum > 0 ? (v[i] / sum + uniform) / 2 : uniform;
          EXPECT_NEAR(double(cell->table(s).pmf(static_cast<std::uint32_t>(i)).value), expected,
                      1e-5 * expected)
              << "node " << node << ", s " << s << ", vertex " << i;
        }
      }
    }
  }
  EXPECT_GT(apart, 0) << "rays and maps decide alike: the test cannot tell them apart";
  EXPECT_GT(rays[NodeVisibilityTest::rays], 20 * rays[NodeVisibilityTest::node_maps]);
  EXPECT_GT(rays[NodeVisibilityTest::node_maps], 0U);
}

INSTANTIATE_TEST_SUITE_P(All, NodesSee,
                         testing::Values(PathScene{"ajar"}, PathScene{"atrium"},
                                         PathScene{"many_lights"}, PathScene{"open", true}),
                         [](const auto& s) { return s.param.name; });

}  // namespace
}  // namespace lacuna
