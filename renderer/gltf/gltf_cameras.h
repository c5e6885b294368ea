#pragma once

#include <vector>

#include "renderer/geometry/scene_data.h"
#include "renderer/gltf/gltf_nodes.h"
#include "renderer/gltf/gltf_warnings.h"
#include "renderer/settings/scene_settings.h"

namespace lacuna::gltf {

/// The cameras of the placed nodes, relative to `origin` (SceneData::origin). Throws SceneError.
std::vector<CameraData> read_cameras(const GltfObject& root, const std::vector<PlacedNode>& nodes,
                                     const V3d& origin);

/// The KHR_lights_punctual lights of the placed nodes, relative to `origin`. Throws SceneError.
std::vector<PunctualLight> read_lights(const GltfObject& root, const std::vector<PlacedNode>& nodes,
                                       const V3d& origin, Warnings& warnings);

/// Divides the intensity of photometric lights by 683 lm/W; warns of `file`'s that are likely to be
/// such: those of Blender's exporter.
void convert_lights(const GltfObject& root, LightUnits units, std::vector<PunctualLight>& lights,
                    Warnings& warnings);

}  // namespace lacuna::gltf
