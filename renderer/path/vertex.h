#pragma once

#include <optional>

#include "renderer/core/density.h"
#include "renderer/geometry/surface.h"
#include "renderer/materials/bsdf.h"

namespace lacuna {

/// Where a guide (renderer/guides) found its distribution of directions at a surface.
struct GuidingCell {
  float probability = 0;  ///< with which a direction is drawn from it, < 1; 0: there is none
  std::uint32_t index = 0xffffffff;  ///< the guide's own; at first: nothing
};

/// One vertex of a path, wherever it came from.
struct Vertex {
  enum class Kind : std::uint8_t { eye, emitter, surface, background };
  Kind kind = Kind::eye;
  bool delta = false;  ///< the walk left it through a delta lobe
  /// The strategy that joins the vertex before it to this one can make the path, as far as the
  /// former is concerned (mis.h).
  bool prev_connectible = true;
  Surface surface;          ///< emitter: x, ng; background: only x, the unit direction to infinity
  V3f wp{0, 0, 0};          ///< unit, to the previous vertex
  Rgb throughput{1, 1, 1};  ///< includes every division by a density, up to here
  Pdf<Area> p_fwd{};        ///< density of this vertex on this walk; background: per steradian
  double mis_partial =
      0;  ///< The part of mis_partial_sum() that is known before the path goes on (mis.h)
  GuidingCell site;          ///< of the surface as seen from wp
  std::optional<Bsdf> bsdf;  ///< of a surface from which the path may go on

  /// A surface's geometric normal on the side that the walk came from.
  V3f side() const { return dot(surface.ng, wp) < 0 ? -surface.ng : surface.ng; }
  /// An edge that was not sampled may begin or end here.
  bool connectible() const { return kind == Kind::surface ? !delta && bsdf->connectible() : true; }
};

/// Density per area at `to` of reaching it from `from` along unit `w`, drawn with density `p`. The
/// background has no area: its density stays per steradian; what comes from there is drawn per area
/// across `w` (EmitterPoint::leaving_pdf). The only conversion between the measures.
inline Pdf<Area> to_area(Pdf<SolidAngle> p, const Vertex& from, const V3f& w, const Vertex& to) {
  if (to.kind == Vertex::Kind::background) return Pdf<Area>(p.value);
  const float cosine = abs_dot(to.surface.ng, w);
  if (from.kind == Vertex::Kind::background) return Pdf<Area>(p.value * cosine);
  return Pdf<Area>(p.value * cosine / (to.surface.x - from.surface.x).length2());
}

}  // namespace lacuna
