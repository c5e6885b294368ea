#include <gtest/gtest.h>

#include <cstring>
#include <deque>

#include "analysis/skeleton/filter.h"
#include "analysis/skeleton/node_map.h"
#include "tests/analysis/skeleton/skeletons.h"

namespace lacuna::testing {
namespace {

using Imath::V3i;

struct LiteralMap {
  Grid3<std::uint32_t> node;
  Grid3<int> distance;
};

/// Alg. 5 as it stands: one queue. Nodes start from the voxels of the domain around their corners,
/// the first come first.
LiteralMap literal_map(const BitGrid3& domain, const SkeletonGraph& graph) {
  LiteralMap map{Grid3<std::uint32_t>(domain.size()), Grid3<int>(domain.size())};
  for (std::size_t i = 0; i < map.node.count(); ++i) map.node[i] = no_node, map.distance[i] = -1;
  std::deque<V3i> queue;
  const auto take = [&](V3i v, std::uint32_t node, int distance) {
    if (!in_grid(v, domain.size()) || !domain.get(v) || map.node(v) != no_node) return;
    map.node(v) = node;
    map.distance(v) = distance;
    queue.push_back(v);
  };
  for (std::uint32_t n = 0; n < graph.nodes(); ++n)
    for (int i = 0; i < 8; ++i) take(graph.corners[n] - V3i(i >> 2, i >> 1 & 1, i & 1), n, 0);
  while (!queue.empty()) {
    const V3i v = queue.front();
    queue.pop_front();
    for (const V3i& d :
         {V3i(0, 0, 1), V3i(0, 0, -1), V3i(0, 1, 0), V3i(0, -1, 0), V3i(1, 0, 0), V3i(-1, 0, 0)})
      take(v + d, map.node(v), map.distance(v) + 1);
  }
  return map;
}

std::vector<SkeletonGraph> graphs_of(const Space& space) {
  std::vector<SkeletonGraph> graphs{space.graph, filter_skeleton(space.graph).graph};
  if (space.graph.nodes() > 0)  // one node alone: long ways round
    graphs.push_back(make_graph({space.graph.corners.back()}, {space.graph.radii.back()}, {}));
  return graphs;
}

bool equal(const Grid3<std::uint32_t>& a, const Grid3<std::uint32_t>& b) {
  return a.size() == b.size() &&
         (a.count() == 0 ||
          std::memcmp(a.data(), b.data(), a.count() * sizeof(std::uint32_t)) == 0);
}

/// By a search from each node alone.
TEST(NodeMap, GivesANearestNode) {
  for (const auto& [name, domain] : domains()) {
    const SkeletonGraph graph = filter_skeleton(space_of(domain).graph).graph;
    const Grid3<std::uint32_t> map = node_map(domain, graph, threads(), no_memory_limit);
    const LiteralMap nearest = literal_map(domain, graph);
    for (std::uint32_t n = 0; n < graph.nodes(); ++n) {
      const LiteralMap from = literal_map(domain, make_graph({graph.corners[n]}, {0}, {}));
      for (std::size_t i = 0; i < map.count(); ++i)
        if (map[i] == n && nearest.distance[i] >= 0) {
          ASSERT_EQ(from.distance[i], nearest.distance[i]) << name << ' ' << map.voxel(i);
        }
    }
  }
}

/// Distances from Alg. 5, labels handed on by them as node_map.h says.
TEST(NodeMap, BreaksTiesByTheOrderOfNeighbours) {
  for (const auto& [name, domain] : domains())
    for (const SkeletonGraph& graph : graphs_of(space_of(domain))) {
      const LiteralMap literal = literal_map(domain, graph);
      const Grid3<std::uint32_t> map = node_map(domain, graph, threads(), no_memory_limit);
      for (std::size_t i = 0; i < map.count(); ++i) {
        const V3i v = map.voxel(i);
        if (literal.distance[i] == 0) {
          ASSERT_EQ(map[i], literal.node[i]) << name << ' ' << v;
        }
        if (literal.distance[i] <= 0) continue;
        for (const V3i& d : {V3i(-1, 0, 0), V3i(1, 0, 0), V3i(0, -1, 0), V3i(0, 1, 0),
                             V3i(0, 0, -1), V3i(0, 0, 1)}) {
          if (!in_grid(v + d, map.size()) || literal.distance(v + d) != literal.distance[i] - 1)
            continue;
          ASSERT_EQ(map[i], map(v + d)) << name << ' ' << v;
          break;
        }
      }
    }
}

TEST(NodeMap, HoldsANodeWhereverTheDomainHasOne) {
  for (const auto& [name, domain] : domains())
    for (const bool filtered : {false, true}) {
      const SkeletonGraph full = space_of(domain).graph;
      const SkeletonGraph graph = filtered ? filter_skeleton(full).graph : full;
      const Grid3<std::uint32_t> map = node_map(domain, graph, threads(), no_memory_limit);
      for (std::size_t i = 0; i < map.count(); ++i)
        ASSERT_EQ(map[i] != no_node, domain.get(map.voxel(i))) << name << ' ' << map.voxel(i);
    }
}

TEST(NodeMap, EntersWhatFacesDoNotReachOverEdgesAndCorners) {
  BitGrid3 domain({12, 9, 9});
  add_box(domain, {1, 1, 1}, {3, 3, 3});
  domain.set(3, 3, 2);                    // over an edge
  domain.set(4, 4, 3);                    // over a corner
  add_box(domain, {5, 3, 3}, {9, 5, 5});  // over an edge again
  domain.set(11, 8, 8);                   // a component without a node
  const Grid3<std::uint32_t> map =
      node_map(domain, make_graph({{1, 1, 1}, {3, 3, 3}}, {0, 0}, {}), threads(), no_memory_limit);
  EXPECT_EQ(map(1, 1, 1), 0u);
  EXPECT_EQ(map(2, 2, 2), 1u);
  EXPECT_EQ(map(3, 3, 2), 1u);  // a start of node 1
  EXPECT_EQ(map(4, 4, 3), 1u);
  EXPECT_EQ(map(8, 3, 4), 1u);
  EXPECT_EQ(map(11, 8, 8), no_node);
  EXPECT_EQ(map(0, 0, 0), no_node);
}

TEST(NodeMap, IsTheSameForAnyNumberOfThreads) {
  const BitGrid3 domain = random_voxels({90, 70, 80}, 0.0006, 9, 5);
  const SkeletonGraph graph = filter_skeleton(space_of(domain).graph).graph;
  const Grid3<std::uint32_t> one = node_map(domain, graph, ThreadPool(1), no_memory_limit);
  for (int run = 0; run < 5; ++run)
    ASSERT_TRUE(equal(one, node_map(domain, graph, threads(), no_memory_limit)));
}

TEST(NodeMap, MovesWithTheGrid) {
  const V3i shift(5, 1, 11);
  for (const auto& [name, domain] : domains()) {
    const Space here = space_of(domain), there = moved_space(domain, shift);
    const auto a = node_map(domain, here.graph, threads(), no_memory_limit);
    const auto b = node_map(there.domain, there.graph, threads(), no_memory_limit);
    for (std::size_t i = 0; i < a.count(); ++i)
      ASSERT_EQ(a[i], b(a.voxel(i) + shift)) << name << ' ' << a.voxel(i);
  }
}

TEST(NodeMap, GoesThroughATunnelOneVoxelWide) {
  BitGrid3 domain({1024, 3, 3});
  add_box(domain, {0, 1, 1}, {1024, 2, 2});
  const auto map = node_map(domain, make_graph({{1024, 1, 1}, {0, 1, 1}}, {0, 0}, {}), threads(),
                            no_memory_limit);
  for (int x = 0; x < 1024; ++x) EXPECT_EQ(map(x, 1, 1), x < 512 ? 1u : 0u) << x;
}

TEST(NodeMap, RefusesNodesOutsideTheGridAndTooMuchMemory) {
  const BitGrid3 domain({4, 5, 6});
  EXPECT_NO_THROW(node_map(domain, make_graph({{4, 5, 6}}, {0}, {}), threads(), no_memory_limit));
  try {
    node_map(domain, make_graph({{0, 0, 0}, {4, 6, 6}}, {0, 0}, {}), threads(), no_memory_limit);
    FAIL();
  } catch (const std::invalid_argument& e) {
    EXPECT_NE(std::string(e.what()).find("node 1 lies at corner (4, 6, 6)"), std::string::npos)
        << e.what();
  }
  EXPECT_THROW(node_map(domain, make_graph({}, {}, {}), threads(), 100), MemoryLimitError);
}

}  // namespace
}  // namespace lacuna::testing
