#pragma once

#include <cstdint>
#include <vector>

#include "analysis/skeleton/simplify.h"

namespace lacuna {

/// Parts of the simplified skeleton whose balls fill an almost convex region: points of one part
/// mostly see each other.
struct VisibilityClusters {
  std::uint32_t count = 0;
  std::vector<std::uint32_t> of_node;  ///< of each node of the simplified skeleton its cluster
};

/// Noel 2015, 7.2.2. Each cluster is a connected part of the graph; clusters are numbered as they
/// are made, the widest first. `alpha` in [0, 1]: by how much of the cluster's largest radius a
/// node's radius may fall short to join over an edge (thesis: 20 %), else std::invalid_argument.
/// Decided here, where the text leaves it open:
/// - Nodes of equal radius are taken in the order of their indices.
/// - A node is accessible in a ball if the graph leads there through nodes in the ball that are in
///   no other cluster.
/// - A curvature node may join because it lies in a ball; the cluster does not grow on from it.
///   Only where a cluster starts at such a node, it grows.
VisibilityClusters visibility_clusters(const SimplifiedSkeleton& skeleton, double alpha);

}  // namespace lacuna
