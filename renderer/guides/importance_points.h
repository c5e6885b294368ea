#pragma once

#include <functional>
#include <span>
#include <vector>

#include "analysis/skeleton/graph.h"
#include "renderer/guides/shortest_paths.h"
#include "renderer/settings/guide_settings.h"

namespace lacuna {

/// Where rays that start around a node are to go, to come nearer to the light.
struct ImportancePoint {
  Imath::V3d at{0.0};  ///< voxels
  double weight = 0;
};

/// The importance points of one node of a skeleton after another (Noel 2015, 9.2.1, 9.3).
class ImportancePaths {
 public:
  /// `importance`: f of each node (eq. 164), in any unit; 0: it is no importance node. Kept by
  /// reference.
  ImportancePaths(const SkeletonGraph& graph, std::span<const double> importance,
                  ImportanceAim aim);

  /// For every importance node that the graph leads to from `node`, a point of the visible part of
  /// the shortest path there (eq. 162, or as `aim` says), with weight f / d^2 (eq. 164). Importance
  /// nodes whose paths part where they are no longer seen have one point, with the sum of their
  /// weights: the mixture over all of them is the same, with few lobes. `sees(j)`: node `node` sees
  /// node j; asked only where the path there is seen. d is at least the node's radius, and half a
  /// voxel: within its ball all are equally near, and the thesis' formula has no value where d = 0.
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
  ShortestPaths paths_;  // from the node asked for last; an edge is the node that it comes from
  std::vector<std::uint32_t> settled_;  // in the order of their distance
  std::vector<std::uint32_t> last_seen_;
  // Of the path to a node that is seen: how many nodes it has and the sum of their places; the one
  // whose ball looks smallest, and how small.
  std::vector<std::uint32_t> steps_, tightest_;
  std::vector<Imath::V3d> sum_;
  std::vector<double> size_, weight_;
  std::vector<char> wanted_;
};

}  // namespace lacuna
