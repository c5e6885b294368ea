#pragma once

#include <cstdint>
#include <vector>

#include "renderer/geometry/scene_data.h"
#include "renderer/gltf/gltf_vertices.h"
#include "renderer/gltf/gltf_warnings.h"

namespace lacuna::gltf {

/// Reads of the `kept` vertices what `material` needs: texture coordinates, and tangents with a
/// normal map; and the vertex colours, unless all are white. Throws SceneError.
void read_attributes(const Source& source, const Vertices& vertices,
                     const std::vector<std::uint32_t>& kept, const Material& material, Mesh& mesh,
                     Warnings& warnings);

}  // namespace lacuna::gltf
