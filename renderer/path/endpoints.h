#pragma once

#include "renderer/emitters/emitter_point.h"
#include "renderer/path/guide.h"
#include "renderer/path/mis.h"
#include "renderer/path/vertex.h"
#include "renderer/scene/camera.h"

namespace lacuna {

// The endpoints of a connecting edge: a surface vertex, a point on an emitter, or the eye. All have
// the members that connect.h uses; directions are unit and point away from the endpoint.

/// The position of a vertex of any kind, for edge_between() and shadow_ray().
struct VertexPlace {
  const Vertex& v;

  bool infinite() const { return v.kind == Vertex::Kind::background; }
  const V3f& x() const { return v.surface.x; }
  /// The origin of a ray along `w`, offset from the surface. The eye and emitters in space have no
  /// surface and no offset. (Point lights that touch a surface: EmitterPoint::origin().)
  V3f origin(const V3f& w) const {
    return offset_origin(v.surface.x, v.surface.ng, v.surface.offset, w);
  }
  /// The end, offset from the surface, of a segment of length `distance` along -`w`.
  V3f end(const V3f& w, float distance) const {
    return offset_end(v.surface.x, v.surface.ng, v.surface.offset, w, distance);
  }
  /// What absorbs in unit direction `w`; null: nothing. Requires the surface's BSDF.
  const Medium* medium(const V3f& w) const {
    return v.kind == Vertex::Kind::surface ? v.bsdf->medium(w) : nullptr;
  }
};

/// A surface vertex: vertex `index` of its path.
struct SurfaceEndpoint {
  const Vertex& v;
  int index;
  Transport transport;
  const Guide& guide;

  static constexpr bool infinite = false;
  const V3f& x() const { return v.surface.x; }
  /// throughput f(wp, w) |cos|: what the path scatters along `w`.
  Rgb scatter(const V3f& w) const { return v.throughput * v.bsdf->eval(v.wp, w, transport); }
  /// The same, and sets `bsdf` to the density of `w` by the BSDF, which Bsdf::evaluate() computes
  /// with little extra work. If the result is black, `bsdf` may be 0.
  Rgb scatter(const V3f& w, Pdf<SolidAngle>& bsdf) const {
    const Bsdf::Evaluated e = v.bsdf->evaluate(v.wp, w, transport);
    bsdf = e.pdf;
    return v.throughput * e.value;
  }
  /// Density per steradian with which this walk would continue along `w`.
  double pdf(const V3f& w) const { return guide.pdf(v, v.wp, w, transport).value; }
  /// The same, given the density of `w` by the BSDF.
  double pdf(const V3f& w, Pdf<SolidAngle> bsdf) const {
    return guide.pdf(v, v.wp, w, transport, bsdf).value;
  }
  /// Density per steradian with which the walk from the other side, arriving from `w`, would
  /// continue to the previous vertex.
  double pdf_rev(const V3f& w) const {
    const Transport other =
        transport == Transport::radiance ? Transport::importance : Transport::radiance;
    return guide.pdf(v, w, v.wp, other).value;
  }
  /// |cos| at this endpoint: p_area = p_solid_angle area_factor(w) / distance^2.
  double area_factor(const V3f& w) const { return double(abs_dot(v.surface.ng, w)); }
  double p_fwd() const { return double(v.p_fwd.value); }
  double mis_partial() const { return v.mis_partial; }
  double next_event_ratio() const { return double(v.next_event_ratio); }
  bool prev_connectible() const { return v.prev_connectible; }
  /// The origin of a ray along `w`, offset from the surface.
  V3f origin(const V3f& w) const { return VertexPlace{v}.origin(w); }
  /// The end of a segment of length `distance` along -`w`, offset from the surface.
  V3f end(const V3f& w, float distance) const { return VertexPlace{v}.end(w, distance); }
  const Medium* medium(const V3f& w) const { return v.bsdf->medium(w); }
};

/// A point on an emitter: vertex 0 of a light path.
struct EmitterEndpoint {
  const EmitterPoint& e;
  const Guide& guide;
  static constexpr int index = 0;

  bool infinite() const { return e.infinite(); }
  const V3f& x() const { return e.x; }
  Rgb scatter(const V3f& w) const {
    const Pdf<Area> p = e.next_event_pdf();
    if (!p.positive()) return Rgb(0, 0, 0);
    const float cosine = e.kind == EmitterPoint::Kind::area ? abs_dot(e.ng, w) : 1.0F;
    return e.towards(w) * (cosine / p.value);
  }
  /// Density per steradian with which a light path leaves the point along `w`, times the density of
  /// the point on light paths over p_fwd().
  double pdf(const V3f& w) const {
    return double(guide.pdf_Le(e, w).value) / double(e.next_event_ratio);
  }
  static double pdf_rev(const V3f&) { return 0; }
  double area_factor(const V3f& w) const {
    return e.kind == EmitterPoint::Kind::area ? double(abs_dot(e.ng, w)) : 1.0;
  }
  /// Density with which the point was sampled. Light paths leave next_event_ratio at 1.
  double p_fwd() const { return double(e.next_event_pdf().value); }
  static double next_event_ratio() { return 1; }
  static double mis_partial() { return 0; }
  /// An eye path can hit the emitter: c_0 of mis.h.
  bool prev_connectible() const { return !e.delta(); }
  V3f origin(const V3f& w) const { return e.origin(w); }
  V3f end(const V3f& w, float distance) const { return e.end(w, distance); }
};

/// Makes `v` the vertex 0 of a light path that starts at `e`.
inline void place_on(const EmitterPoint& e, Vertex& v) {
  v.kind = e.infinite() ? Vertex::Kind::background : Vertex::Kind::emitter;
  v.surface.x = e.x;
  v.surface.ng = e.ng;
  v.surface.offset = e.kind == EmitterPoint::Kind::area ? e.offset : 0.0F;
}

/// A point that next event estimation has sampled, as a vertex, with its density.
inline Vertex next_event_vertex(const EmitterPoint& e) {
  Vertex v;
  place_on(e, v);
  v.p_fwd = e.next_event_pdf();
  return v;
}

/// A point of the eye (Camera::eye()).
struct EyeEndpoint {
  const Camera& camera;
  V3f point;
  static constexpr int index = 0;

  const V3f& x() const { return point; }
  /// Whether densities are per area across the edge, whatever its length.
  bool parallel() const { return camera.parallel(); }
  /// The importance emitted along `w`; Camera::splat() spreads it over pixels.
  Rgb scatter(const V3f& w) const { return Rgb(camera.density(w).value); }
  double pdf(const V3f& w) const { return double(camera.density(w).value); }
  V3f origin(const V3f&) const { return point; }
};

}  // namespace lacuna
