#pragma once

#include <functional>
#include <numeric>
#include <string>
#include <vector>

#include "analysis/complex/curvilinear.h"
#include "analysis/skeleton/adjacency.h"
#include "analysis/skeleton/build_graph.h"
#include "analysis/space/distance.h"
#include "analysis/space/memory_limit.h"
#include "analysis/space/opening_query.h"
#include "tests/analysis/complex/random_voxels.h"

namespace lacuna::testing {

/// Several threads. While a pool of one thread lives, no pool has more: such pools are to be
/// temporary.
inline const ThreadPool& threads() {
  static const ThreadPool pool(4);
  return pool;
}

/// A domain with what the analysis makes of it.
struct Space {
  BitGrid3 domain;
  Grid3<std::uint16_t> l1;
  SkeletonGraph graph;
};

inline CubicalComplex thinned(const BitGrid3& domain, const Grid3<std::uint16_t>& l1) {
  const OpeningQuery opening(l1, threads());
  ThinningReport report;
  return curvilinear_skeleton(
      domain, {l1, [&](Imath::V3i v, int radius) { return opening.reaches(v, radius); }}, report);
}

inline Space space_of(BitGrid3 domain) {
  Space space{std::move(domain), {}, {}};
  space.l1 = l1_distance(space.domain, threads(), no_memory_limit);
  space.graph = build_graph(thinned(space.domain, space.l1), space.l1, threads());
  return space;
}

/// The graph of space_of() with the radii of voxels.
inline SkeletonGraph graph_by_voxels(const BitGrid3& domain) {
  const auto l1 = l1_distance(domain, threads(), no_memory_limit);
  return build_graph_by_voxels(thinned(domain, l1),
                               squared_distance(domain, threads(), no_memory_limit), threads());
}

/// Voxels [low, high).
inline void add_box(BitGrid3& domain, Imath::V3i low, Imath::V3i high) {
  for (int z = low.z; z < high.z; ++z)
    for (int y = low.y; y < high.y; ++y)
      for (int x = low.x; x < high.x; ++x) domain.set(x, y, z);
}

inline BitGrid3 bent_corridor() {
  BitGrid3 domain({44, 40, 10});
  add_box(domain, {1, 1, 1}, {9, 38, 9});
  add_box(domain, {1, 30, 1}, {42, 38, 9});
  return domain;
}
inline BitGrid3 two_rooms_and_a_door() {
  BitGrid3 domain({52, 22, 22});
  add_box(domain, {1, 1, 1}, {24, 21, 21});
  add_box(domain, {24, 8, 1}, {28, 13, 12});
  add_box(domain, {28, 1, 1}, {51, 21, 21});
  return domain;
}
inline BitGrid3 ring() {
  BitGrid3 domain({32, 32, 8});
  add_box(domain, {1, 1, 1}, {31, 31, 7});
  for (int z = 0; z < 8; ++z)
    for (int y = 9; y < 23; ++y)
      for (int x = 9; x < 23; ++x) domain.reset({x, y, z});
  return domain;
}
/// A thin helix of voxels that touch at edges only, here and there.
inline BitGrid3 diagonal_steps() {
  BitGrid3 domain({20, 20, 20});
  for (int i = 1; i < 19; ++i) domain.set(i, i, i < 10 ? 3 : i - 6);
  add_box(domain, {1, 1, 1}, {4, 4, 4});
  return domain;
}

struct NamedDomain {
  std::string name;
  BitGrid3 domain;
};

/// Made shapes and random ones, small enough for brute force.
inline std::vector<NamedDomain> domains() {
  std::vector<NamedDomain> all;
  all.push_back({"corridor", bent_corridor()});
  all.push_back({"rooms", two_rooms_and_a_door()});
  all.push_back({"ring", ring()});
  all.push_back({"steps", diagonal_steps()});
  all.push_back({"one voxel", random_voxels({1, 1, 1}, 1, 0, 1)});
  all.push_back({"nothing", BitGrid3({9, 5, 7})});
  all.push_back({"full", random_voxels({17, 9, 12}, 1, 0, 1)});
  for (unsigned seed = 1; seed <= 3; ++seed) {
    all.push_back({"noise 30 %", random_voxels({21, 14, 18}, 0.3, 0, seed)});
    all.push_back({"noise 80 %", random_voxels({21, 14, 18}, 0.8, 0, seed)});
    all.push_back({"blobs", random_voxels({30, 27, 33}, 0.003, 5, seed)});
  }
  return all;
}

/// Of each node the smallest index in its component.
inline std::vector<std::uint32_t> components(const SkeletonGraph& graph) {
  std::vector<std::uint32_t> of(graph.nodes(), no_node), stack;
  for (std::uint32_t start = 0; start < graph.nodes(); ++start) {
    if (of[start] != no_node) continue;
    of[start] = start;
    stack.assign(1, start);
    while (!stack.empty()) {
      const std::uint32_t n = stack.back();
      stack.pop_back();
      for (const std::uint32_t m : graph.of(n))
        if (of[m] == no_node) of[m] = start, stack.push_back(m);
    }
  }
  return of;
}
inline std::size_t count_components(const SkeletonGraph& graph) {
  const std::vector<std::uint32_t> of = components(graph);
  std::size_t n = 0;
  for (std::uint32_t i = 0; i < of.size(); ++i) n += of[i] == i;
  return n;
}
inline std::size_t count_loops(const SkeletonGraph& graph) {
  return graph.edges() + count_components(graph) - graph.nodes();
}

/// "" if lists of neighbours ascend, without doubles and without the node itself, and are
/// symmetric; else what is wrong.
inline std::string fault(const SkeletonGraph& graph) {
  if (graph.first.size() != graph.nodes() + 1 || graph.radii.size() != graph.nodes())
    return "sizes";
  if (graph.first.front() != 0 || graph.first.back() != graph.neighbours.size()) return "offsets";
  for (std::uint32_t n = 0; n < graph.nodes(); ++n) {
    std::uint32_t before = no_node;
    for (const std::uint32_t m : graph.of(n)) {
      if (m == n || m >= graph.nodes()) return "neighbour of " + std::to_string(n);
      if (before != no_node && before >= m) return "order at " + std::to_string(n);
      before = m;
      const auto back = graph.of(m);
      if (std::find(back.begin(), back.end(), n) == back.end())
        return "no way back to " + std::to_string(n);
    }
  }
  return "";
}

/// A graph made by hand.
inline SkeletonGraph make_graph(std::vector<Imath::V3i> corners, std::vector<float> radii,
                                const std::vector<std::array<std::uint32_t, 2>>& edges) {
  SkeletonGraph graph;
  graph.corners = std::move(corners);
  graph.radii = std::move(radii);
  set_edges(graph, edges);
  return graph;
}

/// `nodes` nodes of one radius along x.
inline SkeletonGraph straight_line(int nodes, float radius) {
  std::vector<Imath::V3i> corners;
  std::vector<std::array<std::uint32_t, 2>> edges;
  for (int i = 0; i < nodes; ++i) {
    corners.emplace_back(i, 0, 0);
    if (i > 0) edges.push_back({static_cast<std::uint32_t>(i - 1), static_cast<std::uint32_t>(i)});
  }
  return make_graph(std::move(corners), std::vector<float>(static_cast<std::size_t>(nodes), radius),
                    edges);
}

inline bool same(const SkeletonGraph& a, const SkeletonGraph& b, Imath::V3i shift = Imath::V3i(0)) {
  for (std::size_t n = 0; n < std::min(a.nodes(), b.nodes()); ++n)
    if (a.corners[n] + shift != b.corners[n]) return false;
  return a.nodes() == b.nodes() && a.radii == b.radii && a.first == b.first &&
         a.neighbours == b.neighbours;
}

/// In a larger grid, moved.
inline BitGrid3 moved(const BitGrid3& domain, Imath::V3i shift) {
  BitGrid3 grid(domain.size() + shift + Imath::V3i(3));
  for (int z = 0; z < domain.size().z; ++z)
    for (int y = 0; y < domain.size().y; ++y)
      for (int x = 0; x < domain.size().x; ++x)
        if (domain.get(x, y, z)) grid.set(Imath::V3i(x, y, z) + shift);
  return grid;
}

inline CubicalComplex moved(const CubicalComplex& complex, Imath::V3i shift) {
  CubicalComplex larger{BitGrid3(complex.size() + shift + Imath::V3i(3))};
  for (int z = 0; z <= complex.size().z; ++z)
    for (int y = 0; y <= complex.size().y; ++y)
      for (int x = 0; x <= complex.size().x; ++x)
        for (FaceType m = 0; m < face_types; ++m)
          if (complex.has({x, y, z}, m)) larger.add(Imath::V3i(x, y, z) + shift, m);
  return larger;
}
/// The same skeleton in a larger grid.
inline Space moved_space(const BitGrid3& domain, Imath::V3i shift) {
  Space space{moved(domain, shift), {}, {}};
  space.l1 = l1_distance(space.domain, threads(), no_memory_limit);
  const auto l1 = l1_distance(domain, threads(), no_memory_limit);
  space.graph = build_graph(moved(thinned(domain, l1), shift), space.l1, threads());
  return space;
}

}  // namespace lacuna::testing
