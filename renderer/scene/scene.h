#pragma once

#include <optional>
#include <string>

#include "analysis/parallel/thread_pool.h"
#include "renderer/emitters/emitter_set.h"
#include "renderer/geometry/rays.h"
#include "renderer/geometry/scene_data.h"
#include "renderer/geometry/surface.h"
#include "renderer/materials/gltf_material.h"

namespace lacuna {

/// What an integrator wants to know of a scene. What nobody asks for is not built: masks decide
/// what is there and are always included.
struct SceneNeeds {
  bool materials = false;  ///< scattering: textures of base colour, roughness, ...
  bool emission = false;   ///< emitters and the environment
  bool space = false;      ///< the analysis of the empty space
};

/// Light from all around, as a job names it.
struct EnvironmentImage {
  std::filesystem::path file;
  float scale = 1;
  float rotation = 0;  ///< radians
};

/// A scene ready to render. Immutable.
class Scene {
 public:
  /// Decodes the textures that `needs` asks for, builds the ray caster and, if asked for, the
  /// emitters. Throws SceneError; also where these textures have more than max_scene_texels.
  Scene(SceneData data, const SceneNeeds& needs, const std::optional<EnvironmentImage>& environment,
        const ThreadPool& pool);

  const SceneData& data() const { return *data_; }
  /// The surface at a hit of rays().
  Surface surface(const Hit& hit) const { return {*data_, triangles_, hit}; }
  /// Asks for what surface() will read.
  void prefetch(const Hit& hit) const { triangles_.prefetch(hit.mesh, hit.triangle); }
  const RayCaster& rays() const { return rays_; }
  /// Only where SceneNeeds::emission was asked for.
  const EmitterSet& emitters() const { return *emitters_; }
  bool has_emitters() const { return emitters_ != nullptr; }
  /// The box of all triangles, scene units.
  const Bounds& bounds() const { return bounds_; }
  int textures_decoded() const { return textures_decoded_; }
  std::uint64_t texture_bytes() const;

  /// Radiance that leaves `s` along unit `wo`.
  Rgb emitted(const Surface& s, const V3f& wo) const {
    if (!s.emits || (!s.emits_behind && dot(wo, s.ng) <= 0)) return {0, 0, 0};
    return emission(material(s), data_->textures, s.uv);
  }
  /// Makes the scattering at `s` in `place`, where it is to stay: it is too large to be moved
  /// about. Only where SceneNeeds::materials was asked for.
  void make_bsdf(const Surface& s, std::optional<Bsdf>& place) const {
    if (const auto& lobes = uniform_lobes_[s.material]) {
      place.emplace(*lobes, s.ng, s.ns);
    } else {
      place.emplace(surface_params(material(s), data_->textures, s.uv), s.ng, s.ns);
    }
  }
  /// Asks for the texels that make_bsdf() will read.
  void prefetch_bsdf(const Surface& s) const {
    if (!uniform_lobes_[s.material]) prefetch_textures(material(s), data_->textures, s.uv);
  }
  const Material& material(const Surface& s) const { return data_->materials[s.material]; }

 private:
  void make_uniform_lobes();
  void decode_textures(const SceneNeeds& needs, const ThreadPool& pool);

  std::unique_ptr<SceneData> data_;  // on the heap: rays and emitters point into it
  Bounds bounds_;
  int textures_decoded_ = 0;
  TriangleTable triangles_;
  std::vector<std::optional<Lobes>> uniform_lobes_;  // of materials whose scattering has no texture
  RayCaster rays_;
  std::unique_ptr<EmitterSet> emitters_;
};

}  // namespace lacuna
