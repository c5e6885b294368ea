#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "renderer/core/alias_table.h"
#include "renderer/emitters/environment.h"
#include "renderer/scene/scene_data.h"
#include "renderer/scene/surface.h"

namespace lacuna {

/// A point or a direction that light comes from, drawn for next event estimation.
struct EmitterSample {
  V3f x;             ///< position; for an infinite emitter: unit direction towards it
  V3f ng{0, 0, 0};   ///< of an area emitter: unit normal of its front side
  float extent = 0;  ///< of the triangle x lies on, see TriangleRecord
  Rgb emission;  ///< towards the receiver: radiance; W/sr of a point; W/m^2 of a directional light
  Pdf<Area>
      pdf{};  ///< selection included. Infinite: per steradian. Delta: the selection's probability
  bool infinite = false;
  bool delta = false;  ///< point, spot, directional: no path can hit it
};

/// All emitters of a scene; one is chosen with probability proportional to its power, so the
/// density of any point on one is known wherever it is seen from.
class EmitterSet {
 public:
  /// `scene_radius` > 0 (scene units) bounds the scene: the power of infinite emitters is what
  /// passes through its great disk. Keeps pointers to `scene` and `triangles`; the emission
  /// textures must be decoded.
  EmitterSet(const SceneData& scene, const TriangleTable& triangles,
             std::unique_ptr<Environment> environment, float scene_radius);

  bool empty() const { return selection_.empty(); }
  std::size_t size() const { return entries_.size(); }

  /// Draws a point for the receiver at `x`. Not to be called when empty().
  EmitterSample sample(const V3f& x, Rng& rng) const;

  /// Density with which sample() returns a point of triangle `triangle` of `mesh`.
  Pdf<Area> pdf(std::uint32_t mesh, std::uint32_t triangle) const;
  /// Density with which sample() returns direction `w`, per steradian (see EmitterSample::pdf).
  Pdf<Area> environment_pdf(const V3f& w) const;
  /// Radiance that arrives from direction `w` at infinity.
  Rgb background(const V3f& w) const;
  const Environment* environment() const { return environment_.get(); }

 private:
  struct Entry {
    enum class Kind : std::uint8_t { triangle, punctual, environment } kind;
    std::uint32_t mesh_or_light = 0;
    std::uint32_t triangle = 0;
    Pdf<Area> pdf{};        // of a triangle: selection included
    Rgb emission{0, 0, 0};  // of a triangle without an emission texture
  };

  void add_mesh(std::uint32_t mesh, std::vector<double>& powers);
  EmitterSample sample_triangle_of(const Entry& e, const V3f& x, const V2f& u) const;
  static EmitterSample sample_punctual(const PunctualLight& light, const V3f& x);

  const SceneData* scene_;
  const TriangleTable* triangles_;
  std::unique_ptr<Environment> environment_;
  std::vector<Entry> entries_;
  AliasTable selection_;
  static constexpr std::uint32_t none = ~0U;
  std::vector<std::uint32_t> first_entry_;  // of each mesh; none: it does not emit
  std::uint32_t environment_entry_ = none;
};

}  // namespace lacuna
