#pragma once

#include "renderer/emitters/emitter_point.h"
#include "renderer/path/mis.h"
#include "renderer/path/vertex.h"
#include "renderer/scene/camera.h"

namespace lacuna {

// The ends of a connecting edge: a surface that a walk reached, a point on an emitter, or the eye.
// All have the same members, which connect.h asks for; directions are unit and lead away from the
// end.

/// A surface that a walk reached, which is vertex `index` of its path.
template <class Guide>
struct SurfaceEndpoint {
  const Vertex& v;
  int index;
  Transport transport;
  const Guide& guide;

  static constexpr bool infinite = false;
  const V3f& x() const { return v.surface.x; }
  /// What the path carries on along `w`: its throughput, f and the cosine.
  Rgb scatter(const V3f& w) const { return v.throughput * v.bsdf->eval(v.wp, w, transport); }
  /// Density of the walk's going on along `w`.
  double pdf(const V3f& w) const { return guide.pdf(v, v.wp, w, transport).value; }
  /// Density with which the other walk, arriving from `w`, would go on to the vertex before.
  double pdf_rev(const V3f& w) const {
    const Transport other =
        transport == Transport::radiance ? Transport::importance : Transport::radiance;
    return guide.pdf(v, w, v.wp, other).value;
  }
  /// Of this end as seen along the edge: density per area from one per steradian is times
  /// area_factor over the squared distance.
  double area_factor(const V3f& w) const { return double(abs_dot(v.surface.ng, w)); }
  double p_fwd() const { return double(v.p_fwd.value); }
  double mis_partial() const { return v.mis_partial; }
  bool prev_connectible() const { return v.prev_connectible; }
  /// Where a ray along `w` starts.
  V3f origin(const V3f& w) const {
    return offset_origin(v.surface.x, v.surface.ng, v.surface.extent, w);
  }
};

/// A point on an emitter: vertex 0 of a light's path, whether the path goes on or not.
struct EmitterEndpoint {
  const EmitterPoint& e;
  static constexpr int index = 0;

  bool infinite() const { return e.infinite(); }
  const V3f& x() const { return e.x; }
  Rgb scatter(const V3f& w) const {
    if (!e.pdf.positive()) return Rgb(0, 0, 0);
    const float cosine = e.kind == EmitterPoint::Kind::area ? abs_dot(e.ng, w) : 1.0F;
    return e.towards(w) * (cosine / e.pdf.value);
  }
  double pdf(const V3f& w) const { return double(e.leaving_pdf(w).value); }
  static double pdf_rev(const V3f&) { return 0; }
  double area_factor(const V3f& w) const {
    return e.kind == EmitterPoint::Kind::area ? double(abs_dot(e.ng, w)) : 1.0;
  }
  double p_fwd() const { return double(e.pdf.value); }
  static double mis_partial() { return 0; }
  /// An eye's path can meet it.
  bool prev_connectible() const { return !e.delta(); }
  V3f origin(const V3f& w) const {
    return e.kind == EmitterPoint::Kind::area ? offset_origin(e.x, e.ng, e.extent, w) : e.x;
  }
};

/// The eye, a point.
struct EyeEndpoint {
  const Camera& camera;
  static constexpr int index = 0;

  const V3f& x() const { return camera.position(); }
  /// The importance of light arriving from `w`, to be spread by Camera::splat().
  Rgb scatter(const V3f& w) const { return Rgb(camera.density(w).value); }
  double pdf(const V3f& w) const { return double(camera.density(w).value); }
  V3f origin(const V3f&) const { return camera.position(); }
};

}  // namespace lacuna
