#include "renderer/gltf/gltf_triangles.h"

#include <algorithm>
#include <limits>
#include <optional>

#include "renderer/geometry/scene_data.h"
#include "renderer/gltf/gltf_accessors.h"

namespace lacuna::gltf {
namespace {

std::size_t corner_count(const file::Model& model, const file::Primitive& primitive) {
  const int accessor =
      primitive.indices >= 0 ? primitive.indices : primitive.attributes.at("POSITION");
  return model.accessors[static_cast<std::size_t>(accessor)].count;
}

/// The corners of triangle `t` as positions in the sequence of indices (glTF 2.0, section 3.7.2.1).
std::array<std::size_t, 3> corners(int mode, std::size_t t) {
  if (mode == mode_strip) return {t, t + 1 + t % 2, t + 2 - t % 2};
  if (mode == mode_fan) return {t + 1, t + 2, 0};
  return {3 * t, 3 * t + 1, 3 * t + 2};
}

}  // namespace

bool is_triangle_mode(int mode) {
  return mode == mode_triangles || mode == mode_strip || mode == mode_fan;
}

std::size_t count_triangles(const file::Model& model, const file::Primitive& primitive) {
  const std::size_t n = corner_count(model, primitive);
  if (primitive.mode == mode_triangles) return n / 3;
  return n < 3 ? 0 : n - 2;
}

std::size_t spare_corners(const file::Model& model, const file::Primitive& primitive) {
  const std::size_t n = corner_count(model, primitive);
  return primitive.mode == mode_triangles || n < 3 ? n % 3 : 0;
}

std::vector<Triangle> assemble_triangles(const file::Model& model, const file::Primitive& primitive,
                                         std::size_t vertices, bool mirrored,
                                         const std::string& place) {
  std::optional<AccessorView> indices;
  if (primitive.indices >= 0) {
    indices.emplace(model, primitive.indices, ElementType::scalar, Components::indices, "indices");
  }
  std::vector<Triangle> triangles(count_triangles(model, primitive));
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const auto at = corners(primitive.mode, t);
    for (std::size_t k = 0; k < 3; ++k) {
      const auto vertex = indices ? indices->index(at[k]) : static_cast<std::uint32_t>(at[k]);
      if (vertex >= vertices) {
        throw SceneError(place + ": indices[" + std::to_string(at[k]) + "] is " +
                         std::to_string(vertex) + "; allowed: below " + std::to_string(vertices));
      }
      triangles[t][k] = vertex;
    }
    if (mirrored) std::swap(triangles[t][1], triangles[t][2]);
  }
  return triangles;
}

std::vector<std::uint32_t> compact(std::vector<Triangle>& triangles, std::size_t vertices) {
  constexpr std::uint32_t unused = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> renumbered(vertices, unused);
  for (const Triangle& t : triangles) {
    for (const std::uint32_t v : t) renumbered[v] = 0;
  }
  std::vector<std::uint32_t> kept;
  for (std::size_t v = 0; v < vertices; ++v) {
    if (renumbered[v] == unused) continue;
    renumbered[v] = static_cast<std::uint32_t>(kept.size());
    kept.push_back(static_cast<std::uint32_t>(v));
  }
  for (Triangle& t : triangles) {
    for (std::uint32_t& v : t) v = renumbered[v];
  }
  return kept;
}

bool is_degenerate(const V3f& a, const V3f& b, const V3f& c) {
  const V3d ab = V3d(b) - V3d(a);
  const V3d bc = V3d(c) - V3d(b);
  const V3d ca = V3d(a) - V3d(c);
  const double twice_area = ab.cross(bc).length();
  std::array<double, 3> lengths{ab.length(), bc.length(), ca.length()};
  std::sort(lengths.begin(), lengths.end());
  // The sine of the largest angle, between the two shorter edges, against a few units of the last
  // place of a float. A triangle with one tiny edge, but large angles at it, is not degenerate.
  constexpr double flat = 0x1p-22;
  return !(twice_area > flat * lengths[0] * lengths[1]) ||
         twice_area < std::numeric_limits<float>::min();
}

Dropped drop_unusable(std::vector<Triangle>& triangles, const std::vector<V3f>& positions) {
  Dropped dropped;
  std::erase_if(triangles, [&](const Triangle& t) {
    const V3f &a = positions[t[0]], &b = positions[t[1]], &c = positions[t[2]];
    if (!is_finite(a) || !is_finite(b) || !is_finite(c)) {
      ++dropped.non_finite;
      return true;
    }
    if (!is_degenerate(a, b, c)) return false;
    ++dropped.degenerate;
    return true;
  });
  return dropped;
}

}  // namespace lacuna::gltf
