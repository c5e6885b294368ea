#pragma once

#include <vector>

#include "renderer/gltf/gltf_nodes.h"
#include "renderer/gltf/gltf_warnings.h"

namespace lacuna::gltf {

/// The perspective cameras of the placed nodes; others are left out with a warning. Throws
/// SceneError.
std::vector<CameraData> read_cameras(const GltfObject& root, const std::vector<PlacedNode>& nodes,
                                     Warnings& warnings);

/// The KHR_lights_punctual lights of the placed nodes. Throws SceneError.
std::vector<PunctualLight> read_lights(const GltfObject& root, const std::vector<PlacedNode>& nodes,
                                       Warnings& warnings);

}  // namespace lacuna::gltf
