#pragma once

#include <vector>

#include "renderer/geometry/scene_data.h"
#include "renderer/gltf/gltf_model.h"
#include "renderer/gltf/gltf_nodes.h"
#include "renderer/gltf/gltf_pose.h"
#include "renderer/gltf/gltf_warnings.h"

namespace lacuna::gltf {

/// Fills `scene.origin`, `meshes` (one for each primitive of each placed node, in scene
/// coordinates), `dropped_triangles` and `geometry_hash`. Reads `scene.materials`, and adds copies
/// for meshes with vertex colours. Every primitive has the index of its material
/// (choose_materials()). Throws SceneError.
void build_meshes(const file::Model& model, const std::vector<PlacedNode>& nodes,
                  const Skins& skins, SceneData& scene, Warnings& warnings);

}  // namespace lacuna::gltf
