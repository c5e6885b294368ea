#pragma once

#include <optional>

#include "renderer/path/endpoints.h"
#include "renderer/scene/scene.h"

namespace lacuna {

/// The edge between the endpoint of an eye path and the endpoint of a light path, or a point on an
/// emitter. Visibility is not included: the caller traces shadow_ray().
struct Connection {
  V3f w{0, 0, 0};         ///< unit, from the eye's endpoint to the light's
  float distance2 = 1;    ///< squared length; 1 if one of the endpoints is at infinity
  float distance = 1;     ///< length; 1 if the light's endpoint is at infinity
  bool infinite = false;  ///< the light's endpoint is at infinity
  /// scatter() of both endpoints over distance2, times the transmittance: without MIS weight and
  /// visibility.
  Rgb contribution{0, 0, 0};
  /// Density of w by the BSDF of the eye's endpoint; none: not evaluated yet.
  std::optional<Pdf<SolidAngle>> eye_bsdf_pdf;

  explicit operator bool() const { return !is_black(contribution); }
};

template <class End>
constexpr bool at_infinity(const End& e) {
  if constexpr (requires { e.infinite(); }) return e.infinite();
  return false;
}

/// The geometry of the edge; its contribution is left at 0. Where both endpoints are at the same
/// point, w is 0.
template <class Eye, class Light>
Connection edge_between(const Eye& eye, const Light& light) {
  Connection c;
  c.infinite = at_infinity(light);
  if (c.infinite) {
    c.w = light.x();
  } else {
    const V3f edge = light.x() - eye.x();
    c.distance2 = edge.length2();
    c.distance = std::sqrt(c.distance2);
    if (c.distance2 > 0) c.w = edge / c.distance;
    if constexpr (requires { eye.parallel(); }) {
      if (eye.parallel() && c.distance2 > 0) c.distance2 = 1;
    }
  }
  return c;
}

/// What absorbs at an endpoint in unit direction `w`; null: nothing.
template <class End>
const Medium* medium_at(const End& e, const V3f& w) {
  if constexpr (requires { e.medium(w); }) return e.medium(w);
  return nullptr;
}

/// The transmittance of the edge of length `c.distance`.
template <class Eye, class Light>
Rgb transmittance(const Eye& eye, const Light& light, const Connection& c) {
  const Medium* const a = medium_at(eye, c.w);
  const Medium* const b = medium_at(light, -c.w);
  if (a == nullptr && b == nullptr) return Rgb(1, 1, 1);
  return transmittance(a, b, c.infinite ? infinite_distance : c.distance);
}

/// Connects the endpoints `eye` and `light`. The result converts to false if the unoccluded
/// contribution is black.
template <class Eye, class Light>
Connection connect(const Eye& eye, const Light& light) {
  Connection c = edge_between(eye, light);
  if (!(c.distance2 > 0)) return c;
  const Rgb emitted = light.scatter(-c.w);
  if (is_black(emitted)) return c;
  Rgb scattered;
  if constexpr (requires { eye.scatter(c.w, c.eye_bsdf_pdf.emplace()); }) {
    scattered = eye.scatter(c.w, c.eye_bsdf_pdf.emplace());
  } else {
    scattered = eye.scatter(c.w);
  }
  c.contribution = scattered * emitted / c.distance2;
  c.contribution *= transmittance(eye, light, c);
  return c;
}

/// The shadow ray between the two endpoints, both offset from their surfaces.
template <class Eye, class Light>
Ray shadow_ray(const Eye& eye, const Light& light, const Connection& c) {
  const V3f from = eye.origin(c.w);
  if (c.infinite) return {from, c.w};
  return {from, light.end(-c.w, c.distance) - from, 1.0F};
}

/// Density per steradian with which the walk from the eye would continue along the connection.
template <class Eye>
double eye_pdf(const Eye& eye, const Connection& c) {
  if constexpr (requires { eye.pdf(c.w, *c.eye_bsdf_pdf); }) {
    if (c.eye_bsdf_pdf) return eye.pdf(c.w, *c.eye_bsdf_pdf);
  }
  return eye.pdf(c.w);
}

/// sum_{i < s} n_i p_i / p_s: the techniques with fewer vertices on the light's side (mis.h).
template <class Eye, class Light>
double light_side_sum(const Eye& eye, const Light& light, const Connection& c,
                      const SampleCounts& n) {
  if (light.index == 0 && !light.prev_connectible()) return 0;
  const double g =
      eye_pdf(eye, c) * (c.infinite ? 1.0 : light.area_factor(c.w) / double(c.distance2));
  const double pdf_rev = light.mis_partial() > 0 ? light.pdf_rev(-c.w) : 0.0;
  const TechniqueCounts side = light_side(n).with_one(light.next_event_ratio());
  return g / light.p_fwd() *
         (mis_partial_sum(side, light.index, light.prev_connectible(), pdf_rev,
                          light.mis_partial()) +
          merge_partial(side, light.index, true, light.p_fwd()));
}

/// sum_{i > s} n_i p_i / p_s: the techniques with fewer vertices on the eye's side (mis.h).
template <class Eye, class Light>
double eye_side_sum(const Eye& eye, const Light& light, const Connection& c,
                    const SampleCounts& n) {
  const double h = light.pdf(-c.w) * eye.area_factor(c.w) / double(c.distance2);
  const double pdf_rev = eye.mis_partial() > 0 ? eye.pdf_rev(c.w) : 0.0;
  return h / eye.p_fwd() *
         (mis_partial_sum(eye_side(n), eye.index, eye.prev_connectible(), pdf_rev,
                          eye.mis_partial()) +
          merge_partial(eye_side(n), eye.index, true, eye.p_fwd()));
}

/// The MIS weight of a connection between a surface and an emitter or another surface.
template <class Eye, class Light>
double weight(const Eye& eye, const Light& light, const Connection& c, const SampleCounts& n) {
  const double own = n.of(light.index + 1, eye.index + 1);
  return mis_weight(own, light_side_sum(eye, light, c, n),
                    n.bidirectional() ? eye_side_sum(eye, light, c, n) : 0.0);
}

/// The MIS weight of a connection to the eye (t = 1).
template <class Light>
double weight(const EyeEndpoint& eye, const Light& light, const Connection& c,
              const SampleCounts& n) {
  return mis_weight(n.splat, light_side_sum(eye, light, c, n), 0.0);
}

/// The point on an emitter that an eye path hit at `v`; none if it emits nothing towards the
/// previous vertex.
inline std::optional<EmitterPoint> emitter_at(const Scene& scene, const Vertex& v) {
  if (v.kind == Vertex::Kind::background) {
    const EmitterPoint e = scene.emitters().hit_background(v.surface.x);
    return is_black(e.emission) ? std::nullopt : std::optional(e);
  }
  const Rgb radiance = scene.emitted(v.surface, v.wp);
  if (is_black(radiance)) return std::nullopt;
  return scene.emitters().hit(v.surface, radiance);
}

/// The MIS weight of an eye path whose vertex `v`, at `index` >= 1, is the point `e` on an emitter
/// (s = 0). If the vertex before it is connectible and not the eye, `e.next_event_ratio` must be
/// the ratio for that vertex. `guide`: the guide of light paths, for the density of their first
/// edge.
inline double hit_weight(const Vertex& v, int index, const EmitterPoint& e, const SampleCounts& n,
                         const Guide& guide) {
  const double one_less = n.of(1, index);
  // x_0 is never merged, and a path of one edge has no next event estimation.
  const TechniqueCounts side{
      .none = 0, .one = one_less, .more = one_less * double(e.next_event_ratio)};
  const double pdf_rev = v.mis_partial > 0 ? double(guide.pdf_Le(e, v.wp).value) : 0.0;
  return mis_weight(n.hit, 0.0,
                    double(e.pdf.value) / double(v.p_fwd.value) *
                        mis_partial_sum(side, index, v.prev_connectible, pdf_rev, v.mis_partial));
}

}  // namespace lacuna
