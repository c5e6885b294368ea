#pragma once

#include <vector>

#include "renderer/gltf/gltf_object.h"
#include "renderer/gltf/gltf_pose.h"
#include "renderer/gltf/gltf_transforms.h"

namespace lacuna::gltf {

/// A node with a mesh, a camera or a light.
struct PlacedNode {
  GltfObject place;
  M44d to_world;  ///< row vectors: p_world = p * to_world; finite
  /// Rank of to_world: 3 if it can be inverted; 2 if it flattens meshes into a plane; 0 for rank 1
  /// or 0, which leaves nothing of them.
  int rank = 3;
  /// to_world with scales of 0 taken as 1: the transform of cameras and lights, which have no size.
  M44d turn;
  bool can_turn = true;             ///< `turn` can be inverted
  bool mirrored = false;            ///< a left-handed `turn`
  std::vector<double> weights;      ///< of the mesh's morph targets; none: 0
  std::optional<std::size_t> skin;  ///< of a node with a mesh
  bool visible = true;              ///< KHR_node_visibility of it and of all nodes above
};

/// The nodes with a mesh, camera or light in the default scene, in depth-first order. A file
/// without a default scene: its first scene; a file without scenes: all root nodes. Warns of scales
/// of 0. Throws SceneError on a cycle, on a node with two parents, on more than 256 levels, and if
/// the transform of such a node overflows.
std::vector<PlacedNode> place_nodes(const GltfObject& root, const Pose& pose, Warnings& warnings);

/// The transforms of all nodes of a file that place_nodes() reads, inside its scene or not.
std::vector<M44d> node_transforms(const GltfObject& root, const Pose& pose);

}  // namespace lacuna::gltf
