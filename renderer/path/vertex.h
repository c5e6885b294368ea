#pragma once

#include <optional>

#include "renderer/core/density.h"
#include "renderer/geometry/surface.h"
#include "renderer/materials/bsdf.h"

namespace lacuna {

/// A reference to a cell of a guide (renderer/guides), whose distribution of directions is used at
/// a surface.
struct GuidingCell {
  static constexpr std::uint32_t none = 0xffffffff;

  /// Probability of sampling the cell's distribution instead of the BSDF; 0: there is none.
  float probability = 0;
  std::uint32_t index = none;  ///< index of the cell in its GuidingDistribution
  std::uint32_t part = none;   ///< index within the cell, for distributions that need one
};

/// One vertex of an eye path or a light path.
struct Vertex {
  enum class Kind : std::uint8_t { eye, emitter, surface, background };
  Kind kind = Kind::eye;
  bool delta = false;  ///< the walk left it through a delta lobe
  /// The previous vertex is connectible(): one of the two conditions of c_j in mis.h.
  bool prev_connectible = true;
  std::uint8_t letters = 0;  ///< PathAutomaton::State after the vertices before, if one is used
  Surface surface;           ///< emitter: x, ng; background: only x, the unit direction to infinity
  V3f wp{0, 0, 0};           ///< unit, to the previous vertex
  Rgb throughput{1, 1, 1};   ///< product of f |cos| / pdf over the edges up to here
  Pdf<Area> p_fwd{};         ///< density of this vertex on this walk; background: per steradian
  /// The sum over i < j of mis_partial_sum(), without the factor pdf_rev: that depends on the next
  /// edge.
  double mis_partial = 0;
  /// Vertex 1 of a light path: EmitterPoint::next_event_ratio of vertex 0 for this receiver; 1 for
  /// other vertices.
  float next_event_ratio = 1;
  GuidingCell guiding_cell;  ///< of the surface as seen from wp, for eye paths
  std::optional<Bsdf> bsdf;  ///< of a surface from which the path may continue

  /// The geometric normal on the side of wp.
  V3f side() const { return dot(surface.ng, wp) < 0 ? -surface.ng : surface.ng; }
  /// A connecting edge may end here: the vertex does not scatter through a delta lobe only.
  bool connectible() const { return kind == Kind::surface ? !delta && bsdf->connectible() : true; }
};

/// p |cos| / distance^2: the density per area at `to` of a direction `w` (unit) sampled at `from`
/// with density `p`. The background has no area: its density stays per steradian, and rays from it
/// have a density per area across `w` (EmitterPoint::pdf_Le, Camera::density). The only conversion
/// between the measures.
inline Pdf<Area> to_area(Pdf<SolidAngle> p, const Vertex& from, const V3f& w, const Vertex& to) {
  if (to.kind == Vertex::Kind::background) {
    // Of parallel rays, which leave the scene, the direction has no density: it is as good as
    // certain, and no other technique finds it.
    constexpr float certain = 1e30F;
    return Pdf<Area>(from.kind == Vertex::Kind::background ? certain : p.value);
  }
  const float cosine = abs_dot(to.surface.ng, w);
  if (from.kind == Vertex::Kind::background) return Pdf<Area>(p.value * cosine);
  return Pdf<Area>(p.value * cosine / (to.surface.x - from.surface.x).length2());
}

}  // namespace lacuna
