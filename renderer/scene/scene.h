#pragma once

#include <optional>
#include <string>

#include "base/parallel/thread_pool.h"
#include "renderer/emitters/emitter_set.h"
#include "renderer/geometry/rays.h"
#include "renderer/geometry/scene_data.h"
#include "renderer/geometry/surface.h"
#include "renderer/geometry/surface_contact.h"
#include "renderer/materials/gltf_material.h"

namespace lacuna {

/// The parts of a scene that an integrator needs; other parts are not built. Alpha masks are always
/// built, because they affect visibility.
struct SceneNeeds {
  bool materials = false;   ///< scattering: textures of base colour, roughness, ...
  bool emission = false;    ///< emitters and the environment
  bool space = false;       ///< the analysis of the empty space
  bool light_tree = false;  ///< selection of emitters for a receiver; requires `emission`
};

/// The environment light of a job, which replaces that of the file.
struct EnvironmentImage {
  std::filesystem::path file;
  float scale = 1;
  float rotation = 0;  ///< radians
};

/// A scene ready to render. Immutable.
class Scene {
 public:
  /// Decodes the needed textures, builds the ray caster and, if needed, the emitters. Throws
  /// SceneError, also if these textures have more than max_scene_texels together.
  Scene(SceneData data, const SceneNeeds& needs, const std::optional<EnvironmentImage>& environment,
        const ThreadPool& pool);

  const SceneData& data() const { return *data_; }
  /// The surface at a hit of rays().
  Surface surface(const Ray& ray, const Hit& hit) const {
    if (!plain_) [[unlikely]]
      return Surface::of_any(*data_, triangles_, ray, hit);
    return {*data_, triangles_, ray, hit};
  }
  /// The same if the point `x` has been computed.
  Surface surface(const Hit& hit, const V3f& x) const {
    if (!plain_) [[unlikely]]
      return Surface::of_any(*data_, triangles_, hit, x);
    return {*data_, triangles_, hit, x};
  }
  /// The geometry of a triangle of a placed mesh.
  TriangleShape triangle(std::uint32_t mesh, std::uint32_t triangle) const {
    return triangles_.record(mesh, triangle);
  }
  /// The geometry of the triangle of a hit.
  TriangleShape triangle(const Hit& hit) const { return placed_triangle(*data_, triangles_, hit); }
  /// Prefetches what surface() reads.
  void prefetch(const Hit& hit) const { triangles_.prefetch(hit.mesh, hit.triangle); }
  const RayCaster& rays() const { return rays_; }
  /// Requires SceneNeeds::emission.
  const EmitterSet& emitters() const { return *emitters_; }
  bool has_emitters() const { return emitters_ != nullptr; }
  /// The box of all triangles, scene units.
  const Bounds& bounds() const { return bounds_; }
  int textures_decoded() const { return textures_decoded_; }
  std::uint64_t texture_bytes() const;

  /// Radiance that leaves `s` in unit direction `wo`.
  Rgb emitted(const Surface& s, const V3f& wo) const {
    if (!s.emits || (!s.emits_behind && dot(wo, s.ng) <= 0)) return {0, 0, 0};
    const Material& m = material(s);
    const bool varies = m.emission_texture.used() || m.emits_vertex_colors();
    return varies ? varying_emission(s) : m.emission;
  }
  /// Constructs the BSDF at `s` in `place`, because a move would be slow. Requires
  /// SceneNeeds::materials.
  void make_bsdf(const Surface& s, std::optional<Bsdf>& place) const {
    if (const auto& lobes = uniform_lobes_[s.material]) {
      place.emplace(*lobes, s.ng, s.ns);
    } else {
      make_varying_bsdf(s, place);
    }
    if (place->needs_tangents()) set_tangents(s, *place);
  }
  /// Whether some solid absorbs.
  bool has_media() const { return has_media_; }
  /// The medium that light crosses from `s` in direction `w`; null: none.
  const Medium* medium(const Surface& s, const V3f& w) const {
    return dot(w, s.ng) < 0 ? material(s).medium() : nullptr;
  }
  /// The probability with which a ray hits the surface at `s`, above 0: below 1 only with alphaMode
  /// BLEND.
  float coverage(const Surface& s) const { return material(s).blend ? blended_coverage(s) : 1.0F; }
  /// Prefetches the texels that make_bsdf() reads.
  void prefetch_bsdf(const Surface& s) const {
    if (!uniform_lobes_[s.material]) prefetch_textures(material(s), data_->textures, s.uv);
  }
  /// Barycentric (u, v) of a surface in its triangle, as in Hit.
  V2f barycentric(const Surface& s) const {
    const Hit hit{.mesh = s.mesh, .triangle = s.triangle, .instance = s.instance};
    return placed_triangle(*data_, triangles_, hit).barycentric(s.x);
  }
  const Material& material(const Surface& s) const { return data_->materials[s.material]; }
  /// The surfaces that contain the point `x`; none if it lies in no surface.
  std::optional<SurfaceContact> find_contact(const V3f& x) const;

 private:
  /// COLOR_0; the material has vertex colours.
  Rgb vertex_color(const Surface& s) const;
  // Not inline: emitted() and make_bsdf() are called at every hit, and most materials are uniform.
  Rgb varying_emission(const Surface& s) const;
  void make_varying_bsdf(const Surface& s, std::optional<Bsdf>& place) const;
  float blended_coverage(const Surface& s) const;
  void find_contacts(const ThreadPool& pool);
  void make_uniform_lobes();
  void set_tangents(const Surface& s, Bsdf& bsdf) const;
  /// `own_environment`: whether that of the file counts.
  void decode_textures(const SceneNeeds& needs, bool own_environment, const ThreadPool& pool);

  std::unique_ptr<SceneData> data_;  // on the heap: rays and emitters point into it
  Bounds bounds_;
  int textures_decoded_ = 0;
  bool plain_ = true;  // neither instances nor normal maps, and the table of triangles is stored
  bool has_media_ = false;
  std::vector<std::optional<Lobes>>
      uniform_lobes_;  // of each material; none if its scattering varies over its surfaces
  std::vector<std::uint8_t> lambertian_;  // of each material: whether it is_lambertian()
  RayCaster rays_;
  TriangleTable triangles_;  // behind rays_, whose building takes memory for a while
  std::unique_ptr<EmitterSet> emitters_;
};

}  // namespace lacuna
