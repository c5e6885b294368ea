// The skeleton of a grid of the thesis author's, beside the one that his code found:
//
//   grid_skeleton GRID (l1 | chebyshev | FILE)
//
// By the keep rule with that distance; or the nodes of FILE, "x y z" a
// line, as corners of voxels. Prints a line of numbers, then the nodes as such lines. The numbers:
// nodes, edges, and quartiles of how far voxels of empty space beside the scene lie from the node
// that they are mapped to, in voxels.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "analysis/complex/curvilinear.h"
#include "analysis/skeleton/build_graph.h"
#include "analysis/skeleton/node_map.h"
#include "analysis/space/distance.h"
#include "analysis/space/opening.h"
#include "analysis/space/opening_query.h"
#include "tests/bench/grids.h"

namespace {

using namespace lacuna;

SkeletonGraph skeleton(const BitGrid3& domain, std::string_view distance, const ThreadPool& pool) {
  const auto l1 = l1_distance(domain, pool, no_memory_limit);
  ThinningReport report;
  if (distance == "l1") {
    const OpeningQuery opening(l1, pool);
    const SpaceMaps maps{l1, [&](Imath::V3i v, int r) { return opening.reaches(v, r); }};
    return build_graph(curvilinear_skeleton(domain, maps, report, &pool), l1, pool);
  }
  const auto steps = chebyshev_distance(domain, pool, no_memory_limit);
  const auto opening = opening_forest(steps, pool, no_memory_limit).opening;
  const SpaceMaps maps{steps, [&](Imath::V3i v, int r) { return opening(v) >= r; }};
  return build_graph(curvilinear_skeleton(domain, maps, report, &pool), l1, pool);
}

SkeletonGraph nodes_of(const std::string& file) {
  std::ifstream in(file);
  SkeletonGraph graph;
  for (Imath::V3i p; in >> p.x >> p.y >> p.z;) {
    graph.corners.push_back(p);
    graph.radii.push_back(0);
    graph.first.push_back(0);
  }
  if (graph.corners.empty()) throw std::runtime_error(file + " holds no node");
  return graph;
}

bool beside_scene(const BitGrid3& domain, Imath::V3i v) {
  if (!domain.get(v)) return false;
  for (int axis = 0; axis < 3; ++axis) {
    for (const int side : {-1, 1}) {
      Imath::V3i w = v;
      w[axis] += side;
      if (in_grid(w, domain.size()) && !domain.get(w)) return true;
    }
  }
  return false;
}

std::vector<double> surface_distances(const BitGrid3& domain, const SkeletonGraph& graph,
                                      const ThreadPool& pool) {
  const auto map = node_map(domain, graph, pool, no_memory_limit);
  const Imath::V3i n = domain.size();
  std::vector<double> all;
  for (int z = 0; z < n.z; ++z) {
    for (int y = 0; y < n.y; ++y) {
      for (int x = 0; x < n.x; ++x) {
        const Imath::V3i v(x, y, z);
        if (!beside_scene(domain, v) || map(v) == no_node) continue;
        const Imath::V3i d = 2 * (v - graph.corners[map(v)]) + Imath::V3i(1);
        all.push_back(0.5 * std::sqrt(static_cast<double>(d.dot(d))));
      }
    }
  }
  std::sort(all.begin(), all.end());
  return all;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    if (argc < 3) {
      throw std::invalid_argument("usage: grid_skeleton GRID (l1 | chebyshev | FILE)");
    }
    const BitGrid3 domain = bench::read_grid(argv[1]);
    const ThreadPool pool(0);
    const std::string what = argv[2];
    const SkeletonGraph graph =
        what == "l1" || what == "chebyshev" ? skeleton(domain, what, pool) : nodes_of(what);
    const std::vector<double> far = surface_distances(domain, graph, pool);
    const auto quartile = [&](std::size_t i) {
      return far.empty() ? 0 : far[i * (far.size() - 1) / 4];
    };
    fmt::print("{} {} {} {} {}\n", graph.nodes(), graph.edges(), quartile(1), quartile(2),
               quartile(3));
    for (const Imath::V3i& p : graph.corners) fmt::print("{} {} {}\n", p.x, p.y, p.z);
  } catch (const std::exception& e) {
    fmt::print(stderr, "grid_skeleton: {}\n", e.what());
    return 1;
  }
}
