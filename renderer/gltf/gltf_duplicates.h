#pragma once

#include "renderer/geometry/scene_data.h"
#include "renderer/gltf/gltf_warnings.h"

namespace lacuna::gltf {

/// Removes duplicates of emitting triangles and warns of them. Next event estimation samples both
/// of two coincident emitters, but a ray hits only one, so the two estimates of the same light
/// would differ. Duplicates have the same corners in the same order and equal materials, normals
/// and texture coordinates; the first one is kept.
void merge_equal_emitters(SceneData& scene, Warnings& warnings);

}  // namespace lacuna::gltf
