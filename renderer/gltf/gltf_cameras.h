#pragma once

#include <vector>

#include "renderer/geometry/scene_data.h"
#include "renderer/gltf/gltf_nodes.h"
#include "renderer/gltf/gltf_warnings.h"

namespace lacuna::gltf {

/// The perspective cameras of the placed nodes, relative to `origin` (SceneData::origin); others
/// are left out with a warning. Throws SceneError.
std::vector<CameraData> read_cameras(const GltfObject& root, const std::vector<PlacedNode>& nodes,
                                     const V3d& origin, Warnings& warnings);

/// The KHR_lights_punctual lights of the placed nodes, relative to `origin`. Throws SceneError.
std::vector<PunctualLight> read_lights(const GltfObject& root, const std::vector<PlacedNode>& nodes,
                                       const V3d& origin, Warnings& warnings);

}  // namespace lacuna::gltf
