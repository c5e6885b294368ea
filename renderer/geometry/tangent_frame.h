#pragma once

#include <optional>

#include "renderer/geometry/surface.h"

namespace lacuna {

/// The directions of a texture on a surface: a right- or left-handed orthonormal frame.
struct TangentFrame {
  V3f s{1, 0, 0};  ///< tangent: towards +u
  V3f t{0, 1, 0};  ///< bitangent: upwards in the image, towards -v
  V3f n{0, 0, 1};

  V3f to_world(const V3f& w) const { return s * w.x + t * w.y + n * w.z; }
};

/// The frame around `at_hit.ns`, in scene coordinates, at barycentric `at`
/// (TriangleShape::barycentric()): of the file's tangents, or else of the texture coordinates that
/// `texture` reads, transformed as it says. None without both, or if they have no direction across
/// the normal. glTF asks for MikkTSpace if a file has no tangents; here the direction is that of
/// each triangle, not the mean over those around a vertex: it differs where the coordinates are
/// bent, by as much as from one triangle to the next.
std::optional<TangentFrame> tangent_frame(const SceneData& scene, const Surface& at_hit,
                                          const V2f& at, const TextureRef& texture);

/// dx/du and -dx/dv on the triangle of a hit, in scene coordinates: of the texture coordinates that
/// `texture` reads, transformed as it says.
struct TextureDirections {
  V3d along, up;
};
/// None if the triangle has no such coordinates, or all three corners have them on a line.
std::optional<TextureDirections> texture_directions(const SceneData& scene, const Surface& at_hit,
                                                    const TextureRef& texture);

}  // namespace lacuna
