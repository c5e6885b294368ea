#pragma once

#include <functional>
#include <span>
#include <vector>

#include "analysis/skeleton/graph.h"
#include "renderer/guides/shortest_paths.h"
#include "renderer/settings/guide_settings.h"

namespace lacuna {

/// A point on the way to the light at which rays from the surroundings of a node are aimed.
struct ImportancePoint {
  Imath::V3d at{0.0};  ///< voxels
  double weight = 0;
};

/// Finds the importance points of skeleton nodes (Noel 2015, 9.2.1, 9.3), one node at a time.
class ImportancePaths {
 public:
  /// `importance`: f of each node (eq. 164), in any unit; 0: not an importance node. Referenced,
  /// not copied.
  ImportancePaths(const SkeletonGraph& graph, std::span<const double> importance,
                  ImportanceAim aim);

  /// For every importance node reachable from `node`: a point on the visible part of the shortest
  /// path to it (eq. 162, or by `aim`), with weight f / d^2 (eq. 164). Importance nodes whose paths
  /// have the same visible part share a point with the sum of their weights: the same mixture with
  /// fewer lobes. `sees(j)`: whether node j is visible from `node`; called only if the whole path
  /// before j is visible. d is at least the node's radius and half a voxel: all nodes within its
  /// ball are equally near, and the thesis' formula is undefined at d = 0.
  std::vector<ImportancePoint> points(std::uint32_t node,
                                      const std::function<bool(std::uint32_t)>& sees);

 private:
  void find_paths(std::uint32_t node);
  void mark_wanted();
  void follow(std::uint32_t node, std::uint32_t v);
  Imath::V3d aim_at(std::uint32_t v) const;

  const SkeletonGraph& graph_;
  std::span<const double> importance_;
  ImportanceAim aim_;
  ShortestPaths
      paths_;  // from the current node; the edge to a node is the index of its predecessor
  std::vector<std::uint32_t> settled_;  // in order of distance
  std::vector<std::uint32_t> last_visible_;
  // For the path to a visible node: its number of nodes, and the sum of their positions; the node
  // whose ball subtends the smallest angle, and its radius over its distance.
  std::vector<std::uint32_t> steps_, tightest_;
  std::vector<Imath::V3d> sum_;
  std::vector<double> size_, weight_;
  std::vector<char> wanted_;
};

}  // namespace lacuna
