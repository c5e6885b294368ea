#pragma once

#include <array>

#include "renderer/geometry/scene_data.h"

namespace lacuna {

/// The directions in which the texture coordinates u and v of a triangle grow, unit, in the
/// coordinates of its mesh. The vertical
/// texture axis of glTF points down; its tangent space's bitangent points up, along -v. Without
/// coordinates, or where they are degenerate: along the first edge, and across it.
std::array<V3f, 2> uv_tangents(const Mesh& mesh, std::uint32_t triangle, int uv_set);

}  // namespace lacuna
