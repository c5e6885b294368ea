#include "renderer/gltf/gltf_triangles.h"

#include <algorithm>
#include <limits>
#include <optional>

#include "renderer/core/huge_pages.h"
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

/// Calls `use(t, k, vertex)` for corner `k` of each triangle `t`, in order. Throws SceneError with
/// `place` for an index that is not below `vertices`.
template <class Use>
void for_each_corner(const file::Model& model, const file::Primitive& primitive,
                     std::size_t vertices, const std::string& place, Use&& use) {
  std::optional<AccessorView> indices;
  if (primitive.indices >= 0) {
    indices.emplace(model, primitive.indices, ElementType::scalar, Components::indices, "indices");
  }
  const std::size_t triangles = count_triangles(model, primitive);
  for (std::size_t t = 0; t < triangles; ++t) {
    const auto at = corners(primitive.mode, t);
    for (std::size_t k = 0; k < 3; ++k) {
      const auto vertex = indices ? indices->index(at[k]) : static_cast<std::uint32_t>(at[k]);
      if (vertex >= vertices) {
        throw SceneError(place + ": indices[" + std::to_string(at[k]) + "] is " +
                         std::to_string(vertex) + "; allowed: below " + std::to_string(vertices));
      }
      use(t, k, vertex);
    }
  }
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
  std::vector<Triangle> triangles;
  const std::size_t count = count_triangles(model, primitive);
  reserve_huge(triangles, count);
  triangles.resize(count);
  for_each_corner(model, primitive, vertices, place,
                  [&](std::size_t t, std::size_t k, std::uint32_t vertex) {
                    triangles[t][mirrored && k > 0 ? 3 - k : k] = vertex;
                  });
  return triangles;
}

std::vector<std::uint8_t> used_vertices(const file::Model& model, const file::Primitive& primitive,
                                        std::size_t vertices, const std::string& place) {
  std::vector<std::uint8_t> used(vertices);
  for_each_corner(model, primitive, vertices, place,
                  [&](std::size_t, std::size_t, std::uint32_t vertex) { used[vertex] = 1; });
  return used;
}

std::vector<std::uint32_t> compact(std::vector<Triangle>& triangles, std::size_t vertices) {
  std::vector<std::uint8_t> used(vertices);
  for (const Triangle& t : triangles) {
    for (const std::uint32_t v : t) used[v] = 1;
  }
  std::vector<std::uint32_t> kept;
  kept.reserve(vertices);
  for (std::size_t v = 0; v < vertices; ++v) {
    if (used[v] != 0) kept.push_back(static_cast<std::uint32_t>(v));
  }
  if (kept.size() == vertices) return kept;
  std::vector<std::uint32_t> renumbered(vertices);
  for (std::size_t i = 0; i < kept.size(); ++i) {
    renumbered[kept[i]] = static_cast<std::uint32_t>(i);
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
  const double area2 = ab.cross(bc).length2();  // of the parallelogram, squared
  const double sides2[3] = {ab.length2(), bc.length2(), ca.length2()};
  const double longest2 = std::max({sides2[0], sides2[1], sides2[2]});
  const double shorter2 = longest2 > 0 ? sides2[0] * sides2[1] * sides2[2] / longest2 : 0;
  // The sine of the largest angle, between the two shorter edges, against a few units of the last
  // place of a float. A triangle with one tiny edge, but large angles at it, is not degenerate.
  constexpr double flat2 = 0x1p-44, least = std::numeric_limits<float>::min();
  return !(area2 > flat2 * shorter2) || area2 < least * least;
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
