#pragma once

#include <Imath/ImathVec.h>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "analysis/skeleton/clusters.h"

namespace lacuna {

/// A disk that separates two visibility clusters.
struct VisibilityGate {
  Imath::V3f centre;  ///< voxels
  Imath::V3f axis;    ///< unit length, from clusters[0] to clusters[1]
  float radius;       ///< voxels; 0 where a node touches the scene (NodeRadius::corner)
  std::array<std::uint32_t, 2> clusters;  ///< of nodes[0] and of nodes[1], different
  std::array<std::uint32_t, 2> nodes;     ///< of the simplified skeleton, ascending
};

/// All gates, by their nodes, and those of each cluster.
struct VisibilityGates {
  std::vector<VisibilityGate> gates;
  std::vector<std::uint32_t> first;  ///< clusters + 1 offsets into `by_cluster`
  std::vector<std::uint32_t> by_cluster;

  /// The gates that leave a cluster, ascending.
  std::span<const std::uint32_t> of(std::uint32_t cluster) const {
    return {by_cluster.data() + first[cluster], by_cluster.data() + first[cluster + 1]};
  }
};

/// Noel 2015, 7.2.3: one gate for each edge of the simplified skeleton between two clusters, at its
/// middle and across it, with the smaller of the two radii.
VisibilityGates visibility_gates(const SkeletonGraph& simplified,
                                 const VisibilityClusters& clusters);

}  // namespace lacuna
