#pragma once

#include "renderer/geometry/scene_data.h"
#include "renderer/gltf/gltf_warnings.h"

namespace lacuna::gltf {

/// A lamp that is there twice gives twice the light where it is sampled, and once where a ray meets
/// it. So of emitting triangles with the same corners in the same order, and with materials,
/// normals and texture coordinates that are equal, all but the first are removed, and warned of.
void merge_equal_emitters(SceneData& scene, Warnings& warnings);

}  // namespace lacuna::gltf
