#pragma once

#include <vector>

#include "renderer/core/vec.h"
#include "renderer/gltf/gltf_object.h"

namespace lacuna::gltf {

/// Row `i` in [0, 3] of a transform without its last column.
inline V3d row(const M44d& m, int i) { return {m[i][0], m[i][1], m[i][2]}; }

/// A node that puts something into the scene: a mesh, a camera or a light.
struct PlacedNode {
  GltfObject place;
  M44d to_world;           ///< row vectors: p_world = p * to_world; finite and invertible
  double determinant = 0;  ///< of the upper 3x3; its sign tells mirrored nodes
};

/// The nodes that the default scene (or the first one, or, without scenes, all roots) reaches and
/// that carry something, in depth-first order. Throws SceneError on a cycle, a node with two
/// parents, more than 256 levels, and a singular or overflowing transform above something carried.
std::vector<PlacedNode> place_nodes(const GltfObject& root);

}  // namespace lacuna::gltf
