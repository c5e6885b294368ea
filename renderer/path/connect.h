#pragma once

#include "renderer/path/vertex.h"
#include "renderer/scene/scene.h"

namespace lacuna {

/// The edge that joins a vertex of an eye path to a point on an emitter.
struct Connection {
  Rgb contribution{0, 0, 0};  ///< unweighted: throughput f G Le / pdf, without visibility
  V3f w{0, 0, 0};             ///< unit, from the vertex to the emitter
  float distance2 = 0;        ///< squared length; of an infinite emitter: meaningless
};

/// Joins `v` to `e`. Nothing is traced and nothing changed; the caller asks Scene::visible for what
/// is not black.
inline Connection connect(const Vertex& v, const EmitterSample& e) {
  Connection c;
  if (is_black(e.emission) || !e.pdf.positive()) return c;
  float geometry = 1;
  if (e.infinite) {
    c.w = e.x;
  } else {
    const V3f edge = e.x - v.surface.x;
    c.distance2 = edge.length2();
    if (!(c.distance2 > 0)) return c;
    c.w = edge / std::sqrt(c.distance2);
    geometry = (e.delta ? 1.0F : abs_dot(e.ng, c.w)) / c.distance2;
  }
  const Rgb f = v.bsdf->eval(v.wp, c.w, Transport::radiance);
  if (is_black(f)) return c;
  c.contribution = v.throughput * f * e.emission * (geometry / e.pdf.value);
  return c;
}

/// Density per area of reaching `e` by a direction drawn at `v` with density `p` (infinite: per
/// steradian); zero for delta emitters, which no direction reaches.
inline Pdf<Area> to_area(Pdf<SolidAngle> p, const Connection& c, const EmitterSample& e) {
  if (e.delta) return {};
  if (e.infinite) return Pdf<Area>(p.value);
  return Pdf<Area>(p.value * abs_dot(e.ng, c.w) / c.distance2);
}

}  // namespace lacuna
