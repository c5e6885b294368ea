#pragma once

#include <immintrin.h>

#include <vector>

#include "renderer/core/huge_pages.h"
#include "renderer/geometry/ray_offset.h"
#include "renderer/geometry/triangle_shape.h"

namespace lacuna {

/// What the triangles of a mesh share.
struct MeshTraits {
  bool smooth = false;    ///< has interpolated normals
  bool textured = false;  ///< has texture coordinates that its material uses
  bool two_uv_sets = false;
  bool emits : 1 = false;
  bool emits_behind : 1 = false;
  std::uint32_t material = 0;

  MeshTraits() = default;
  MeshTraits(const Mesh& mesh, const Material& material);
};

/// The data of a triangle that every hit reads: one cache line.
struct alignas(64) TriangleRecord : TriangleShape, MeshTraits {
  TriangleRecord() = default;
  TriangleRecord(const Mesh& mesh, const MeshTraits& traits, std::uint32_t triangle)
      : TriangleShape(mesh, triangle), MeshTraits(traits) {}
};
static_assert(sizeof(TriangleRecord) == 64);

/// The further data that a hit on a textured or smooth triangle reads: one more cache line.
struct alignas(64) TriangleAttributes {
  std::array<V2f, 3> uv0;  ///< TEXCOORD_0 of the corners
  std::array<V3f, 3> normals;

  TriangleAttributes(const Mesh& mesh, std::uint32_t triangle);
};

/// The records of all triangles of a scene, and the attributes of smooth or textured ones. They are
/// stored in so many bytes at most; what has no room, first the attributes, is computed at each hit
/// from the meshes, to the same bits.
class TriangleTable {
 public:
  static const std::size_t default_bytes;

  /// Keeps a pointer to `scene`.
  TriangleTable(const SceneData& scene, const ThreadPool& pool,
                std::size_t most_bytes = default_bytes);
  /// Whether all records and attributes are.
  bool stored() const { return records_stored_ && attributes_stored_; }
  /// Requires stored().
  const TriangleRecord& at(std::uint32_t mesh, std::uint32_t triangle) const {
    return records_[first_[mesh].record + triangle];
  }
  /// Requires stored() and a smooth or textured triangle.
  const TriangleAttributes& attributes_at(std::uint32_t mesh, std::uint32_t triangle) const {
    return attributes_[first_[mesh].attributes + triangle];
  }
  TriangleRecord record(std::uint32_t mesh, std::uint32_t triangle) const {
    if (records_stored_) return at(mesh, triangle);
    return {scene_->meshes[mesh], first_[mesh].traits, triangle};
  }
  /// Requires a smooth or textured triangle.
  TriangleAttributes attributes(std::uint32_t mesh, std::uint32_t triangle) const {
    if (attributes_stored_) return attributes_at(mesh, triangle);
    return {scene_->meshes[mesh], triangle};
  }
  /// Prefetches what is read first.
  void prefetch(std::uint32_t mesh, std::uint32_t triangle) const {
    const First& first = first_[mesh];
    const auto ahead = [](const auto& data) {
      _mm_prefetch(reinterpret_cast<const char*>(&data), _MM_HINT_T0);
    };
    if (!stored()) ahead(scene_->meshes[mesh].triangles[triangle]);
    if (records_stored_) ahead(records_[first.record + triangle]);
    if (attributes_stored_ && first.attributes != none) {
      ahead(attributes_[first.attributes + triangle]);
    }
  }

 private:
  static constexpr std::size_t none = ~std::size_t{0};
  struct First {
    std::size_t record;
    std::size_t attributes;  // or none
    MeshTraits traits;
  };
  const SceneData* scene_;
  std::vector<First> first_;  // of each mesh
  bool records_stored_, attributes_stored_;
  HugeArray<TriangleRecord> records_;
  HugeArray<TriangleAttributes> attributes_;
};

/// The triangle of a hit, in scene coordinates.
TriangleShape placed_triangle(const SceneData& scene, const TriangleTable& table, const Hit& hit);

struct Surface;
/// The normal of the coat (ClearCoat::own_normal) at `s`, where barycentric `at` lies: unit, in
/// scene coordinates; the interpolated one, bent by the coat's own map.
V3f coat_normal(const SceneData& scene, const TriangleTable& table, const Surface& s,
                const V2f& at);

/// The geometry of a hit. `ng` is unit and points to the front of the triangle.
struct Surface {
  V3f x{0, 0, 0};
  V3f ng{0, 0, 0};
  V3f ns{0, 0, 0};   ///< unit; interpolated normals, or ng; bent by the normal map
  float offset = 0;  ///< ray_offset() at x
  std::array<V2f, 2> uv{V2f(0, 0), V2f(0, 0)};
  std::uint32_t mesh = 0;
  std::uint32_t triangle = 0;
  std::uint32_t material = 0;
  std::uint32_t instance = no_instance;  ///< as Hit::instance
  bool emits = false, emits_behind = false;

  Surface() = default;
  /// The hit of `ray`, or the hit at point `x` computed before, of any triangle.
  static Surface of_any(const SceneData& scene, const TriangleTable& table, const Ray& ray,
                        const Hit& hit);
  static Surface of_any(const SceneData& scene, const TriangleTable& table, const Hit& hit,
                        const V3f& x);
  // Inline: every hit constructs a Surface in place. For instances, normal maps and a table that is
  // not stored use of_any().
  /// The hit of `ray`.
  Surface(const SceneData& scene, const TriangleTable& table, const Ray& ray, const Hit& hit)
      : Surface(scene, table, hit, table.at(hit.mesh, hit.triangle).at(ray, hit.u, hit.v)) {}
  /// The hit at point `at`, computed before.
  Surface(const SceneData& scene, const TriangleTable& table, const Hit& hit, const V3f& at)
      : Surface(scene, table.at(hit.mesh, hit.triangle), hit, at,
                [&]() -> const TriangleAttributes& {
                  return table.attributes_at(hit.mesh, hit.triangle);
                }) {}
  /// The same on a triangle; `attributes_of` gives its attributes.
  template <class AttributesOf>
  Surface(const SceneData& scene, const TriangleRecord& r, const Hit& hit, const V3f& at,
          AttributesOf&& attributes_of)
      : x(at), mesh(hit.mesh), triangle(hit.triangle) {
    ng = r.ng;
    ns = r.ng;
    offset = ray_offset(x, ng, r.plane_error);
    material = r.material;
    emits = r.emits;
    emits_behind = r.emits_behind;
    if (!r.textured && !r.smooth) return;
    const TriangleAttributes& a = attributes_of();
    const float w = 1 - hit.u - hit.v;
    if (r.textured) {
      uv[0] = w * a.uv0[0] + hit.u * a.uv0[1] + hit.v * a.uv0[2];
      if (r.two_uv_sets) uv = scene.meshes[hit.mesh].uvs_at(hit.triangle, hit.u, hit.v);
    }
    if (r.smooth) {
      const V3f n = w * a.normals[0] + hit.u * a.normals[1] + hit.v * a.normals[2];
      const float length2 = n.length2();
      // Opposite normals can cancel: then keep ng.
      if (length2 > 0.0F) ns = n / std::sqrt(length2);
    }
  }
};

}  // namespace lacuna
