#pragma once

#include <utility>

#include "renderer/guides/mixed_guide.h"
#include "renderer/guides/skeleton_to_eye.h"

namespace lacuna {

/// A guide of light paths, from their first edge on. It guides nothing else: eye paths, emitters
/// without area and those that emit on both sides are sampled as without it.
class LightGuide : public MixedGuide {
 public:
  explicit LightGuide(std::unique_ptr<GuidingDistribution> directions)
      : MixedGuide(std::move(directions), Transport::importance) {}

  /// It learns nothing.
  static bool learns() { return false; }
  static void save(ByteWriter&) {}
  static void load(ByteReader&) {}

  /// The first edge of a light path from the point `e` on one of `lights`. A surface emits as a
  /// white Lambertian one scatters what arrives along its normal, but for the factor pi.
  std::optional<Leaving> sample_first_edge(const EmitterSet& lights, const EmitterPoint& e,
                                           Rng& rng) const {
    if (!guides(e)) return lights.sample_first_edge(e, rng);
    Vertex v;
    make_white(e, v);
    const std::optional<BsdfSample> s = sample(v, rng, Transport::importance);
    if (!s || !e.pdf.positive()) return std::nullopt;
    const Rgb emitted = e.towards(s->wi);
    if (is_black(emitted)) return std::nullopt;
    return Leaving{{offset_origin(e.x, e.ng, e.extent, s->wi), s->wi},
                   s->pdf,
                   emitted * s->weight * (pi / e.pdf.value)};
  }
  /// Density of unit `w` with which sample_first_edge() leaves `e`, as EmitterPoint::leaving_pdf().
  Pdf<SolidAngle> leaving_pdf(const EmitterPoint& e, const V3f& w) const {
    if (!guides(e)) return e.leaving_pdf(w);
    Vertex v;
    make_white(e, v);
    return pdf(v, e.ng, w, Transport::importance);
  }

 private:
  static bool guides(const EmitterPoint& e) {
    return e.kind == EmitterPoint::Kind::area && !e.both_sides;
  }
  void make_white(const EmitterPoint& e, Vertex& v) const {
    v.kind = Vertex::Kind::surface;
    v.surface.x = e.x;
    v.surface.ng = v.surface.ns = v.wp = e.ng;
    v.surface.extent = e.extent;
    v.bsdf.emplace(white_, e.ng, e.ng);
    on_hit(v);
  }

  Lobes white_{SurfaceParams{.f0 = Rgb(0, 0, 0), .f90 = 0}};
};

/// Returns `make(guide)` with the light guide of these settings: a BsdfGuide or a LightGuide.
template <class Make>
auto with_light_guide(const LightGuideSettings& settings, Make&& make) {
  if (const auto* s = std::get_if<SkeletonLightGuideSettings>(&settings))
    return make(LightGuide(std::make_unique<SkeletonToEye>(*s)));
  return make(BsdfGuide{});
}

}  // namespace lacuna
