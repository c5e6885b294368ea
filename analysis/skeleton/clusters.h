#pragma once

#include <cstdint>
#include <vector>

#include "analysis/skeleton/simplify.h"

namespace lacuna {

/// Parts of the simplified skeleton whose balls fill an almost convex region: points of one part
/// mostly see each other.
struct VisibilityClusters {
  std::uint32_t count = 0;
  std::vector<std::uint32_t> of_node;  ///< cluster of each node of the simplified skeleton
};

/// Noel 2015, 7.2.2. Each cluster is a connected part of the graph; clusters are numbered in the
/// order of their construction, the widest first. A node joins over an edge if its radius is at
/// least (1 - `alpha`) times the cluster's largest radius; `alpha` in [0, 1] (thesis: 20 %), else
/// std::invalid_argument. The thesis leaves open what is decided here:
/// - Nodes of equal radius are taken in the order of their indices.
/// - A node is accessible in a ball if a path of nodes that lie in the ball and belong to no other
///   cluster leads to it.
/// - A curvature node may join because it lies in a ball, but the cluster does not grow from it. It
///   grows from a curvature node only if it starts there.
VisibilityClusters visibility_clusters(const SimplifiedSkeleton& skeleton, double alpha);

}  // namespace lacuna
