// Surfaces under a coating (coating.h).

#include "renderer/materials/bsdf.h"

namespace lacuna {

/// The base, seen from inside the coating, where normals are those of `from`.
Bsdf Bsdf::below_coating(const ShadingFrame& from) const {
  const V3f ng = from.front ? from.n : -from.n;
  Bsdf base(*lobes_, ng, ng);
  base.bare_ = true;
  base.along_ = along_;
  return base;
}

Bsdf::Choice Bsdf::coated_choice(const ShadingFrame& from) const {
  const Coating& coating = *lobes_->further->coating;
  const float passes = coating.let_through(from.cos_o);
  const double boundary = double(luminance(coating.reflectance()) * (1 - passes));
  const double base =
      double(passes * luminance(coating.absorption_at(from.cos_o) * lobes_->further->scale));
  Choice c;
  if (!(boundary + base > 0)) return c;
  c.coat = boundary / (boundary + base);
  c.facets = base / (boundary + base);
  return c;
}

template <bool want_f, bool want_pdf>
Bsdf::Scatter Bsdf::coated_scatter(const ShadingFrame& from, const Choice* c, const V3f& wo,
                                   const V3f& wi) const {
  const Coating& coating = *lobes_->further->coating;
  const float cos_i = dot(wi, from.n);
  const Coating::Refracted o = coating.enter(wo, from.n, from.cos_o);
  const Coating::Refracted i = coating.enter(wi, from.n, cos_i);
  Scatter s;
  if (o.cos > 0 && i.cos > 0) {
    const Bsdf base = below_coating(from);
    const ShadingFrame inside = base.shading_frame(from.n, o.w);
    const Choice choice = want_pdf ? base.choice(inside) : Choice{};
    s = base.scatter<want_f, want_pdf>(inside, &choice, o.w, i.w);
    const float jacobian = coating.jacobian(cos_i, i.cos);
    if constexpr (want_f) s.f *= o.through * i.through * jacobian;
    if constexpr (want_pdf) s.pdf *= static_cast<float>(c->facets) * jacobian;
  }
  const V3f h = wo + wi;
  const float length = std::sqrt(h.length2());
  if (coating.smooth() || length < cos_rounding) return s;
  const V3f m = h * (1 / length);
  const Facets all = coating.facets(from.n, along_);
  const float d = all.d(m, wo);
  if constexpr (want_f) {
    s.f += lobes_->further->scale * coating.reflectance(0.5F * length) *
           (d * all.g2_over_4cos(wo, from.cos_o, wi, cos_i));
  }
  if constexpr (want_pdf) {
    s.pdf += static_cast<float>(c->coat) * 0.25F * all.sampled_over_d(wo, from.cos_o, m) * d;
  }
  return s;
}
template Bsdf::Scatter Bsdf::coated_scatter<true, true>(const ShadingFrame&, const Choice*,
                                                        const V3f&, const V3f&) const;
template Bsdf::Scatter Bsdf::coated_scatter<true, false>(const ShadingFrame&, const Choice*,
                                                         const V3f&, const V3f&) const;
template Bsdf::Scatter Bsdf::coated_scatter<false, true>(const ShadingFrame&, const Choice*,
                                                         const V3f&, const V3f&) const;

/// The mirror images in the boundary and in the base have the same direction.
Bsdf::DeltaSum Bsdf::coated_delta_sum(const ShadingFrame& from, const Choice& c,
                                      const V3f& wi) const {
  const Coating& coating = *lobes_->further->coating;
  DeltaSum sum;
  if (coating.smooth()) {
    sum = {lobes_->further->scale * coating.reflectance(from.cos_o), c.coat};
  }
  const Coating::Refracted o = coating.enter(reflect(wi, from.n), from.n, from.cos_o);
  if (!(o.cos > 0)) return sum;
  const Bsdf base = below_coating(from);
  const ShadingFrame inside = base.shading_frame(from.n, o.w);
  const DeltaSum below =
      base.delta_sum(inside, base.choice(inside), lobes_->interface.split(o.cos, inside.eta),
                     reflect(o.w, from.n), false);
  sum.p += c.facets * below.p;
  sum.value += below.value * o.through * o.through;
  return sum;
}

std::optional<Bsdf::LobeSample> Bsdf::sample_coated(const ShadingFrame& from, const Choice& c,
                                                    const V3f& wo, double u_lobe,
                                                    const V2f& u) const {
  const Coating& coating = *lobes_->further->coating;
  const auto mirror = [&] {
    LobeSample result{reflect(wo, from.n)};
    result.delta = coated_delta_sum(from, c, result.wi);
    return result;
  };
  if (u_lobe < c.coat) {
    if (coating.smooth()) return mirror();
    const V3f m = coating.facets(from.n, along_).sample(wo, u);
    if (!(dot(wo, m) > 0)) return std::nullopt;
    return LobeSample{reflect(wo, m)};
  }
  const Coating::Refracted o = coating.enter(wo, from.n, from.cos_o);
  if (!(o.cos > 0) || c.facets == 0) return std::nullopt;
  const Bsdf base = below_coating(from);
  const ShadingFrame inside = base.shading_frame(from.n, o.w);
  const std::optional<LobeSample> drawn =
      base.sample_lobe(inside, base.choice(inside), o.w, (u_lobe - c.coat) / c.facets, u);
  if (!drawn || !(dot(drawn->wi, from.n) > 0)) return std::nullopt;
  if (drawn->delta.p > 0) return mirror();
  const std::optional<V3f> wi = coating.leave(drawn->wi, from.n);
  if (!wi) return std::nullopt;
  return LobeSample{*wi};
}

}  // namespace lacuna
