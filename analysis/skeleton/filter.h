#pragma once

#include <cstdint>
#include <vector>

#include "analysis/geometry/grid.h"
#include "analysis/skeleton/graph.h"

namespace lacuna {

/// A sparser skeleton, and the filtered node that represents each node of the original skeleton.
struct FilteredSkeleton {
  SkeletonGraph graph;
  std::vector<std::uint32_t> source;  ///< original node of each filtered node, ascending
  std::vector<std::uint32_t> parent;  ///< filtered node of each original node
};

/// Noel 2015, 6.3, Alg. 4: removes nodes that lie in the maximal ball of a larger one, so few nodes
/// remain where the space is wide and many where it is narrow. The thesis leaves open what is
/// decided here:
/// - Nodes of equal radius are taken in the order of their indices.
/// - A node is accessible from another (line 6) if a path of nodes that lie in the ball and belong
///   to no other node yet leads to it. So each filtered node represents a connected part of the
///   graph, the filtered graph is the graph with these parts contracted, and both have the same
///   components. This takes linear time, after sorting.
/// - A node that others belong to is never assigned to another (line 7 alone would allow it where a
///   ball reaches around a wall, and leave grandchildren).
FilteredSkeleton filter_skeleton(const SkeletonGraph& graph);

/// The same as in the author's code, in quadratic time: a node removes all nodes whose distance is
/// less than its radius, accessible or not; of equal radii, the node with more neighbours comes
/// first. Distances and radii are in scene units in single precision, so a distance equal to the
/// radius may be less by rounding. With the author's own skeleton of door and its radii 74 nodes
/// remain, as in Table 5; by exact numbers 83.
FilteredSkeleton filter_without_access(const SkeletonGraph& graph, const GridTransform& transform);

}  // namespace lacuna
