#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "jobs/cli/overlay.h"
#include "renderer/core/false_colour.h"

namespace lacuna {
namespace {

constexpr double bar = 0.12;   // half the width of an edge, voxels
constexpr double knot = 0.35;  // half the width of a node

/// Two unit vectors that form a right-handed frame with `n`.
std::array<V3d, 2> across(const V3d& n) {
  const V3d other = std::abs(n.x) < 0.6 ? V3d(1, 0, 0) : V3d(0, 1, 0);
  const V3d u = n.cross(other).normalized();
  return {u, n.cross(u)};
}

class Builder {
 public:
  Builder(const GridTransform& grid, std::string name, const Rgb& colour)
      : grid_(grid), mesh_{std::move(name), colour, {}, {}} {}

  std::uint32_t vertex(const V3d& p) {
    mesh_.positions.emplace_back(grid_.to_world(p));
    return static_cast<std::uint32_t>(mesh_.positions.size() - 1);
  }
  void quad(const V3d& a, const V3d& b, const V3d& c, const V3d& d) {
    const std::uint32_t i = vertex(a);
    vertex(b), vertex(c), vertex(d);
    mesh_.triangles.push_back({i, i + 1, i + 2});
    mesh_.triangles.push_back({i, i + 2, i + 3});
  }
  /// A bar with a square section between two points.
  void edge(const V3d& a, const V3d& b) {
    const V3d along = b - a;
    const auto [u, v] = across(along.normalized());
    const std::array<V3d, 4> ring{(u + v) * bar, (v - u) * bar, (-u - v) * bar, (u - v) * bar};
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const V3d &p = ring[i], &q = ring[(i + 1) % ring.size()];
      quad(a + p, a + q, b + q, b + p);
    }
  }
  void octahedron(const V3d& c, double r) {
    const std::array<std::uint32_t, 6> i{vertex(c + V3d(r, 0, 0)), vertex(c - V3d(r, 0, 0)),
                                         vertex(c + V3d(0, r, 0)), vertex(c - V3d(0, r, 0)),
                                         vertex(c + V3d(0, 0, r)), vertex(c - V3d(0, 0, r))};
    for (const std::size_t z : {4U, 5U}) {
      for (const auto& [x, y] : {std::pair{0, 2}, {2, 1}, {1, 3}, {3, 0}}) {
        mesh_.triangles.push_back(
            {i[static_cast<std::size_t>(x)], i[static_cast<std::size_t>(y)], i[z]});
      }
    }
  }
  void disk(const V3d& centre, const V3d& axis, double radius) {
    constexpr int corners = 24;
    const auto [u, v] = across(axis);
    const std::uint32_t middle = vertex(centre);
    for (int k = 0; k < corners; ++k) {
      const double angle = 2 * std::numbers::pi * k / corners;
      vertex(centre + (u * std::cos(angle) + v * std::sin(angle)) * radius);
    }
    for (std::uint32_t k = 0; k < corners; ++k) {
      mesh_.triangles.push_back({middle, middle + 1 + k, middle + 1 + (k + 1) % corners});
    }
  }
  OverlayMesh take() { return std::move(mesh_); }

 private:
  const GridTransform& grid_;
  OverlayMesh mesh_;
};

void add_edges(Builder& to, const SkeletonGraph& graph, std::uint32_t node) {
  for (const std::uint32_t other : graph.of(node)) {
    if (other > node) to.edge(V3d(graph.corners[node]), V3d(graph.corners[other]));
  }
}

}  // namespace

std::vector<OverlayMesh> skeleton_overlay(const SkeletonGraph& graph, const GridTransform& grid) {
  Builder edges(grid, "edges", {0.9F, 0.1F, 0.1F}), ends(grid, "ends", {0.1F, 0.3F, 1}),
      junctions(grid, "junctions", {0.1F, 0.8F, 0.1F});
  for (std::uint32_t i = 0; i < graph.nodes(); ++i) {
    add_edges(edges, graph, i);
    if (graph.degree(i) == 2) continue;
    (graph.degree(i) < 2 ? ends : junctions).octahedron(V3d(graph.corners[i]), knot);
  }
  return {edges.take(), ends.take(), junctions.take()};
}

std::vector<OverlayMesh> cluster_overlay(const SimplifiedSkeleton& skeleton,
                                         const VisibilityClusters& clusters,
                                         const GridTransform& grid) {
  std::vector<Builder> builders;
  for (std::uint32_t c = 0; c < clusters.count; ++c) {
    builders.emplace_back(grid, "cluster " + std::to_string(c), false_colour(c, 1));
  }
  for (std::uint32_t i = 0; i < skeleton.graph.nodes(); ++i) {
    Builder& b = builders[clusters.of_node[i]];
    add_edges(b, skeleton.graph, i);
    b.octahedron(V3d(skeleton.graph.corners[i]), 2 * knot);
  }
  std::vector<OverlayMesh> meshes;
  meshes.reserve(builders.size());
  for (Builder& b : builders) meshes.push_back(b.take());
  return meshes;
}

std::vector<OverlayMesh> gate_overlay(const VisibilityGates& gates, const GridTransform& grid) {
  std::vector<OverlayMesh> meshes;
  for (std::size_t i = 0; i < gates.gates.size(); ++i) {
    const VisibilityGate& g = gates.gates[i];
    Builder b(grid, "gate " + std::to_string(i), false_colour(static_cast<std::uint32_t>(i), 2));
    constexpr double least = 0.25;  // voxels: keeps gates of radius 0 visible
    b.disk(V3d(g.centre), V3d(g.axis), std::max<double>(g.radius, least));
    meshes.push_back(b.take());
  }
  return meshes;
}

std::vector<OverlayMesh> path_overlay(std::span<const TracedPath> paths, const Bounds& box) {
  const double length = (box.high - box.low).length();
  GridTransform grid;
  grid.voxel_size = length > 0 ? 0.01 * length : 0.01;
  std::vector<OverlayMesh> meshes;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    Builder b(grid, "path " + std::to_string(i + 1) + " " + paths[i].letters,
              false_colour(static_cast<std::uint32_t>(i), 4));
    std::optional<V3d> last;
    for (const TracedVertex& v : paths[i].vertices) {
      V3d at = (V3d(v.x) - grid.origin) / grid.voxel_size;
      if (v.infinite && !last) continue;  // the eye of a parallel projection
      if (v.infinite) at = *last + V3d(v.x) * (length / grid.voxel_size);
      if (last && at != *last) b.edge(*last, at);
      if (!v.infinite) b.octahedron(at, knot);
      last = at;
    }
    meshes.push_back(b.take());
  }
  return meshes;
}

std::vector<OverlayMesh> portal_overlay(const Portals& portals, const RegionLabels& regions,
                                        const GridTransform& grid) {
  std::vector<OverlayMesh> meshes;
  for (std::size_t i = 0; i < portals.portals.size(); ++i) {
    const Portal& portal = portals.portals[i];
    Builder b(grid, "portal " + std::to_string(portal.a) + " " + std::to_string(portal.b),
              false_colour(static_cast<std::uint32_t>(i), 3));
    for (std::uint64_t k = 0; k < portal.faces(); ++k) {
      const VoxelFace f = portals.face(portal, k);
      const Imath::V3i at = regions.label.voxel(f.voxel);
      b.quad(f.point(at, 0, 0), f.point(at, 1, 0), f.point(at, 1, 1), f.point(at, 0, 1));
    }
    meshes.push_back(b.take());
  }
  return meshes;
}

}  // namespace lacuna
