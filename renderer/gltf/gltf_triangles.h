#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "renderer/core/vec.h"
#include "renderer/gltf/gltf_model.h"

namespace lacuna::gltf {

using Triangle = std::array<std::uint32_t, 3>;

/// True for the primitive modes that are made of triangles.
bool is_triangle_mode(int mode);

/// The triangles of a list, strip or fan; every index is below `vertices`. `mirrored` swaps the
/// winding, so that the front stays the front. Throws SceneError with `place`.
std::vector<Triangle> assemble_triangles(const file::Model& model, const file::Primitive& primitive,
                                         std::size_t vertices, bool mirrored,
                                         const std::string& place);

/// For each vertex 1 if a triangle uses it, else 0. Throws as assemble_triangles().
std::vector<std::uint8_t> used_vertices(const file::Model& model, const file::Primitive& primitive,
                                        std::size_t vertices, const std::string& place);

/// Number of triangles of the primitive, without reading them.
std::size_t count_triangles(const file::Model& model, const file::Primitive& primitive);

/// Corners at the end of the primitive that make no whole triangle.
std::size_t spare_corners(const file::Model& model, const file::Primitive& primitive);

/// Renumbers `triangles` to the vertices they use, in the old order; returns the old numbers.
std::vector<std::uint32_t> compact(std::vector<Triangle>& triangles, std::size_t vertices);

/// Whether the three corners are collinear within single precision, at any scale, so that the
/// direction of the normal would be noise.
bool is_degenerate(const V3f& a, const V3f& b, const V3f& c);

struct Dropped {
  std::uint64_t non_finite = 0;
  std::uint64_t degenerate = 0;
  std::uint64_t total() const { return non_finite + degenerate; }
};

/// Removes triangles that cannot be hit: with a vertex that is not finite, and degenerate ones.
Dropped drop_unusable(std::vector<Triangle>& triangles, const std::vector<V3f>& positions);

}  // namespace lacuna::gltf
