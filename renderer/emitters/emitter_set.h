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
  float extent = 0;  ///< of the triangle x lies on, see TriangleShape
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
  /// passes through its great disk. Keeps a pointer to `scene`; the emission textures must be
  /// decoded.
  EmitterSet(const SceneData& scene, std::unique_ptr<Environment> environment, float scene_radius);

  bool empty() const { return selection_.empty(); }
  std::size_t size() const { return entries_.size(); }

  /// Draws an emitter, before the receiver is known: its memory is then on its way while the ray to
  /// the receiver is traced. Not to be called when empty().
  std::uint32_t choose(Rng& rng) const {
    const std::uint32_t i = selection_.sample(rng);
    __builtin_prefetch(&entries_[i]);
    return i;
  }
  /// Draws a point on the emitter `chosen` for the receiver at `x`; its density includes the
  /// choice.
  EmitterSample sample(std::uint32_t chosen, const V3f& x, Rng& rng) const;

  /// Density with which sample() returns a point of triangle `triangle` of `mesh`.
  Pdf<Area> pdf(std::uint32_t mesh, std::uint32_t triangle) const;
  /// Density with which sample() returns direction `w`, per steradian (see EmitterSample::pdf).
  Pdf<Area> environment_pdf(const V3f& w) const;
  /// Radiance that arrives from direction `w` at infinity.
  Rgb background(const V3f& w) const;
  const Environment* environment() const { return environment_.get(); }

 private:
  /// What the entries of one mesh, or the only entry of a light, have in common.
  struct Source {
    enum class Kind : std::uint8_t { mesh, punctual, environment } kind;
    bool both_sides = false;
    bool textured = false;    // emission is not the same everywhere
    Rgb emission{0, 0, 0};    // of a mesh
    std::uint32_t index = 0;  // of the mesh or of the light
    std::uint32_t first_entry = 0;
  };
  /// A triangle or a light; what a draw needs lies in one cache line.
  struct alignas(64) Entry : TriangleShape {
    Pdf<Area> pdf{};  // selection included
    std::uint32_t source = 0;
  };

  void add_mesh(std::uint32_t mesh, std::vector<double>& powers);
  void add_light(const Source& source, double power, std::vector<double>& powers);
  EmitterSample sample_triangle_of(std::uint32_t chosen, const V3f& x, const V2f& u) const;
  EmitterSample sample_environment(Rng& rng) const;
  static EmitterSample sample_punctual(const PunctualLight& light, const V3f& x);

  const SceneData* scene_;
  std::unique_ptr<Environment> environment_;
  std::vector<Source> sources_;
  HugeVector<Entry> entries_;
  AliasTable selection_;
  static constexpr std::uint32_t none = ~0U;
  std::vector<std::uint32_t> first_entry_;  // of each mesh; none: it does not emit
  std::uint32_t environment_entry_ = none;
};

}  // namespace lacuna
