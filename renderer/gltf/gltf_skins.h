#pragma once

#include <vector>

#include "renderer/gltf/gltf_model.h"
#include "renderer/gltf/gltf_nodes.h"
#include "renderer/gltf/gltf_pose.h"

namespace lacuna::gltf {

/// The skins that `nodes` use; others are empty. `to_world`: the transform of every node of the
/// file. Throws SceneError.
Skins pose_skins(const GltfObject& root, const file::Model& model,
                 const std::vector<PlacedNode>& nodes, const std::vector<M44d>& to_world);

}  // namespace lacuna::gltf
