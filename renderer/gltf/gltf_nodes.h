#pragma once

#include <vector>

#include "renderer/core/vec.h"
#include "renderer/gltf/gltf_object.h"

namespace lacuna::gltf {

/// Row `i` in [0, 3] of a transform without its last column.
inline V3d row(const M44d& m, int i) { return {m[i][0], m[i][1], m[i][2]}; }

/// A node with a mesh, a camera or a light.
struct PlacedNode {
  GltfObject place;
  M44d to_world;  ///< row vectors: p_world = p * to_world; finite
  /// Dimensions that to_world leaves of space: 3 where it can be inverted; 2 where it flattens
  /// meshes; 0 where it leaves a line or a point, and so nothing of them.
  int rank = 3;
  /// As to_world, with scales of 0 taken as 1: what turns cameras and lights, which have no size.
  M44d turn;
  bool can_turn = true;   ///< `turn` can be inverted
  bool mirrored = false;  ///< a left-handed `turn`
};

/// The nodes with a mesh, camera or light in the default scene, in depth-first order. A file
/// without a default scene: its first scene; a file without scenes: all root nodes. Warns of scales
/// of 0. Throws SceneError on a cycle, on a node with two parents, on more than 256 levels, and if
/// the transform of such a node overflows.
std::vector<PlacedNode> place_nodes(const GltfObject& root, Warnings& warnings);

}  // namespace lacuna::gltf
