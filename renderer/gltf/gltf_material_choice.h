#pragma once

#include <string>

#include "renderer/gltf/gltf_model.h"
#include "renderer/gltf/gltf_object.h"

namespace lacuna::gltf {

/// Gives every primitive of `model` the index of its material: that of the variant
/// (KHR_materials_variants), else its own, else glTF's default, the last of `materials`. `variant`:
/// the name of one of the file's, or empty. Throws SceneError if the file has no variant of that
/// name, with the names that it has.
void choose_materials(const GltfObject& root, const std::string& variant, std::size_t materials,
                      file::Model& model);

}  // namespace lacuna::gltf
