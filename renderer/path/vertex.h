#pragma once

#include <optional>

#include "renderer/core/density.h"
#include "renderer/materials/bsdf.h"
#include "renderer/scene/surface.h"

namespace lacuna {

/// One vertex of a path, wherever it came from.
struct Vertex {
  enum class Kind : std::uint8_t { eye, surface, background };
  Kind kind = Kind::eye;
  bool delta = false;        ///< the walk left it through a delta lobe
  Surface surface;           ///< background: only x, the unit direction to infinity
  V3f wp{0, 0, 0};           ///< unit, to the previous vertex
  Rgb throughput{1, 1, 1};   ///< includes every division by a density, up to here
  Pdf<Area> p_fwd{};         ///< density of this vertex on this walk; background: per steradian
  std::optional<Bsdf> bsdf;  ///< of a surface from which the path may go on
};

/// Density per area at `to` of reaching it from `from` along unit `w`. The background has no area:
/// its density stays per steradian. The only conversion between the two measures.
inline Pdf<Area> to_area(Pdf<SolidAngle> p, const V3f& from, const V3f& w, const Vertex& to) {
  if (to.kind == Vertex::Kind::background) return Pdf<Area>(p.value);
  return Pdf<Area>(p.value * abs_dot(to.surface.ng, w) / (to.surface.x - from).length2());
}

}  // namespace lacuna
