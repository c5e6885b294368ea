#pragma once

#include <string>

#include "renderer/gltf/gltf_model.h"
#include "renderer/gltf/gltf_pose.h"
#include "renderer/gltf/gltf_warnings.h"

namespace lacuna::gltf {

/// What the animations of a file give its nodes at `seconds`: all of them, or, unless `name` is
/// empty, those of that name. Where several animate a property of a node, the first one counts,
/// with a warning. Throws SceneError.
Pose pose_at(const GltfObject& root, const file::Model& model, double seconds,
             const std::string& name, Warnings& warnings);

}  // namespace lacuna::gltf
