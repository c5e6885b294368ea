#pragma once

#include <cstdint>
#include <vector>

#include "analysis/skeleton/graph.h"

namespace lacuna {

/// A sparser skeleton, and which of its nodes stands for each node of the one it came from.
struct FilteredSkeleton {
  SkeletonGraph graph;
  std::vector<std::uint32_t>
      source;  ///< of each filtered node its node in the first graph, ascending
  std::vector<std::uint32_t> parent;  ///< of each node of the first graph its filtered node
};

/// Noel 2015, 6.3, Alg. 4: nodes in the maximal ball of a larger one are removed: few nodes stay
/// where the space is wide, many where it is narrow. Decided here, where the text leaves it open:
/// - Nodes of equal radius are taken in the order of their indices.
/// - A node is accessible from another (line 6) if the graph leads there through nodes that lie in
///   the ball and belong to no other node yet. So each filtered node stands for a connected part
///   of the graph, the filtered graph is the graph with these parts contracted, and its components
///   are the graph's. This takes linear time, after sorting.
/// - A node that others belong to is never given to another (line 7 alone would allow it where a
///   ball reaches around a wall, and leave grandchildren).
FilteredSkeleton filter_skeleton(const SkeletonGraph& graph);

}  // namespace lacuna
