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
  M44d to_world;           ///< row vectors: p_world = p * to_world; finite and invertible
  double determinant = 0;  ///< of the upper 3x3; its sign tells mirrored nodes
};

/// The nodes with a mesh, camera or light in the default scene, in depth-first order. A file
/// without a default scene: its first scene; a file without scenes: all root nodes. Throws
/// SceneError on a cycle, on a node with two parents, on more than 256 levels, and if the transform
/// of such a node is singular or overflows.
std::vector<PlacedNode> place_nodes(const GltfObject& root);

}  // namespace lacuna::gltf
