#pragma once

#include <string>

#include "renderer/gltf/gltf_model.h"
#include "renderer/gltf/gltf_pose.h"
#include "renderer/gltf/gltf_warnings.h"

namespace lacuna::gltf {

/// The pose of a file's nodes at `seconds` by all of its animations, or, unless `name` is empty, by
/// those of that name. If several animate one property of a node, the first is used, with a
/// warning. Throws SceneError.
Pose pose_at(const GltfObject& root, const file::Model& model, double seconds,
             const std::string& name, Warnings& warnings);

}  // namespace lacuna::gltf
