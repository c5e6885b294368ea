#include "renderer/materials/bsdf.h"

#include "renderer/core/frame.h"

namespace lacuna {
namespace {

/// Probabilities that a facet reflects and that it transmits.
struct FacetProbabilities {
  double reflect = 1, transmit = 0;

  FacetProbabilities() = default;  ///< only reflection
  explicit FacetProbabilities(const Interface::Split& split)
      : FacetProbabilities(split.reflected, split.transmitted) {}
  FacetProbabilities(const Rgb& reflected, const Rgb& transmitted) {
    const double r = double(luminance(reflected));
    const double t = double(luminance(transmitted));
    if (r + t == 0) return;
    reflect = r / (r + t);
    transmit = t / (r + t);
  }
};

/// The facet that refracts two directions on opposite sides into one another.
struct RefractingFacet {
  V3f m;
  float cos_o, cos_i;  ///< with m: positive and negative
  float
      cos_outside;  ///< of the direction in the thinner medium, where there is no total reflection
  float jacobian;   ///< (cos_o + eta cos_i)^-2

  static std::optional<RefractingFacet> find(const V3f& n, const V3f& wo, const V3f& wi,
                                             float eta) {
    const V3f h = wo + eta * wi;  // Walter et al. 2007, eq. 16
    const float length = h.length();
    if (length < cos_rounding) return std::nullopt;
    V3f m = h / length;
    if (dot(m, n) < 0) m = -m;
    const float o = dot(wo, m);
    const float i = dot(wi, m);
    if (o <= 0 || i >= 0) return std::nullopt;
    const float denominator = o + eta * i;
    return RefractingFacet{m, o, i, eta >= 1 ? o : -i, 1 / (denominator * denominator)};
  }
};

}  // namespace

Rgb Bsdf::albedo() const {
  if (lobes_.kind != Lobes::Kind::layered) return lobes_.diffuse;
  return lobes_.interface.r0 + lobes_.layer.let_through(0.0F) * lobes_.diffuse +
         lobes_.interface.glass_color;
}

Bsdf::ShadingFrame Bsdf::shading_frame(const V3f& n, const V3f& wo) const {
  const bool front = dot(wo, ng_) > 0;
  ShadingFrame result{n, front, dot(wo, n), lobes_.interface.eta(front)};
  if (lobes_.facets_compete()) result.mean_weight = lobes_.layer.mean_weight(result.cos_o);
  return result;
}

Bsdf::Choice Bsdf::choice(const ShadingFrame& from) const {
  Choice c;
  if (!lobes_.facets_compete()) {
    c.facets = 1;
    return c;
  }
  if (lobes_.interface.glass > 0) {
    const Interface::Split s = lobes_.interface.split(from.cos_o, from.eta);
    c.facets = double(luminance(s.reflected));
    if (lobes_.interface.clear()) {
      c.clear = double(luminance(s.transmitted));
      // Tilted facets may reflect even if the mean facet hardly does.
      if (lobes_.interface.ior > 1) c.facets += double(lobes_.interface.glass * from.mean_weight);
    } else {
      c.facets += double(luminance(s.transmitted));
    }
  } else {
    const float r0 = luminance(lobes_.interface.r0);
    c.facets = double(r0 + (lobes_.interface.r90 - r0) * from.mean_weight);
  }
  if (lobes_.has_diffuse())
    c.diffuse = double(luminance(lobes_.diffuse) * lobes_.layer.let_through(from.mean_weight));
  const double sum = c.diffuse + c.facets + c.clear;
  if (!(sum > 0)) return {};
  return {c.diffuse / sum, c.facets / sum, c.clear / sum};
}

int Bsdf::passage(const ShadingFrame& from, const V3f& wi) const {
  const float side_i = dot(wi, ng_);
  const float cos_i = dot(wi, from.n);
  const float same = from.front ? side_i : -side_i;
  if (same > 0 && cos_i > 0) return 1;
  return same < 0 && cos_i < 0 ? -1 : 0;
}

template <bool want_f, bool want_pdf>
void Bsdf::reflected(const ShadingFrame& from, const Choice* c, const V3f& wo, const V3f& wi,
                     Scatter& s) const {
  const float cos_i = dot(wi, from.n);
  if (lobes_.has_diffuse()) {
    if constexpr (want_f) {
      const float scale =
          lobes_.layer.scale(lobes_.layer.let_through(from.mean_weight),
                             lobes_.layer.let_through(lobes_.layer.mean_weight(cos_i)));
      s.f = lobes_.diffuse * (scale * cos_i * inv_pi);
    }
    if constexpr (want_pdf) s.pdf = static_cast<float>(c->diffuse) * cos_i * inv_pi;
  }
  const V3f h = wo + wi;
  const float length = std::sqrt(h.length2());
  if (lobes_.interface.smooth() || length < cos_rounding) return;
  const V3f m = h * (1 / length);
  const float a = lobes_.interface.alpha;
  const float d = ggx_d(m, from.n, a);
  Interface::Split split;
  if (want_f || lobes_.facets_transmit()) split = lobes_.interface.split(0.5F * length, from.eta);
  if constexpr (want_f) s.f += split.reflected * (d * ggx_g2_over_4cos(from.cos_o, cos_i, a));
  if constexpr (want_pdf) {
    // Visible normals; dm / dwi = 1 / (4 wo.m).
    const FacetProbabilities coin =
        lobes_.facets_transmit() ? FacetProbabilities(split) : FacetProbabilities();
    s.pdf +=
        static_cast<float>(c->facets * coin.reflect) * 0.25F * ggx_g1_over_cos(from.cos_o, a) * d;
  }
}

template <bool want_f, bool want_pdf>
void Bsdf::transmitted(const ShadingFrame& from, const Choice* c, const V3f& wo, const V3f& wi,
                       Scatter& s) const {
  if (lobes_.interface.smooth() || !lobes_.facets_transmit()) return;
  const auto facet = RefractingFacet::find(from.n, wo, wi, from.eta);
  if (!facet) return;
  const Rgb share = lobes_.interface.split(facet->cos_outside, lobes_.interface.ior).transmitted;
  const float a = lobes_.interface.alpha;
  const float cos_i = -dot(wi, from.n);
  const float common = ggx_d(facet->m, from.n, a) * ggx_g1_over_cos(from.cos_o, a) * facet->cos_o *
                       -facet->cos_i * facet->jacobian;
  // Walter et al. 2007, eq. 21, times the light's cosine; n_o^2 / (...)^2 is the jacobian, which
  // includes the 1 / eta^2 of radiance.
  if constexpr (want_f) s.f = share * (common * ggx_g1_over_cos(cos_i, a) * cos_i);
  if constexpr (want_pdf) {
    // dm / dwi = eta^2 |wi.m| / (...)^2 (Walter et al. 2007, eq. 17).
    const FacetProbabilities coin(lobes_.interface.split(facet->cos_o, from.eta).reflected, share);
    s.pdf = static_cast<float>(c->facets * coin.transmit) * common * from.eta * from.eta;
  }
}

template <bool want_f, bool want_pdf>
Bsdf::Scatter Bsdf::scatter(const ShadingFrame& from, const Choice* c, const V3f& wo,
                            const V3f& wi) const {
  Scatter s;
  const int side = passage(from, wi);
  if (side > 0) reflected<want_f, want_pdf>(from, c, wo, wi, s);
  if (side < 0) transmitted<want_f, want_pdf>(from, c, wo, wi, s);
  return s;
}

Rgb Bsdf::eval_any(const V3f& wo, const V3f& wi, Transport transport) const {
  const float side = dot(wo, ng_);
  const float side_i = dot(wi, ng_);
  if (lobes_.kind == Lobes::Kind::black || side == 0 || side_i == 0) return Rgb(0, 0, 0);
  if (transport == Transport::radiance || flat_) {
    const ShadingFrame from = shading_frame(eye_normal(wo, side), wo);
    const Rgb f = scatter<true, false>(from, nullptr, wo, wi).f;
    // Reciprocal for ns = ng: importance is not scaled by 1 / eta^2.
    const bool unscale = transport == Transport::importance && (side > 0) != (side_i > 0);
    return unscale ? f * (from.eta * from.eta) : f;
  }
  if (std::abs(side) < cos_rounding) return Rgb(0, 0, 0);
  const ShadingFrame from = shading_frame(eye_normal(wi, side_i), wi);
  return scatter<true, false>(from, nullptr, wi, wo).f * std::abs(side_i / side);
}

Bsdf::Evaluated Bsdf::evaluate_any(const V3f& wo, const V3f& wi, Transport transport) const {
  if (transport != Transport::radiance && !flat_) {
    return {eval_any(wo, wi, transport), pdf_any(wo, wi, transport)};
  }
  const float side = dot(wo, ng_);
  if (lobes_.kind == Lobes::Kind::black || side == 0) return {};
  const V3f n = eye_normal(wo, side);
  const bool front = side > 0;
  // Early out before the lobes' terms: half of all directions lie behind an opaque surface.
  if (!transmits() && passage({n, front, 0, 1}, wi) <= 0) return {};
  const ShadingFrame from = shading_frame(n, wo);
  const Choice c = choice(from);
  Scatter s = scatter<true, true>(from, &c, wo, wi);
  const bool crosses = front != (dot(wi, ng_) > 0);
  if (transport == Transport::importance && crosses) s.f *= from.eta * from.eta;
  return {s.f, Pdf<SolidAngle>(s.pdf)};
}

std::optional<LambertLobe> Bsdf::lambert_lobe(const V3f& from) const {
  if (lobes_.kind != Lobes::Kind::lambert) return std::nullopt;
  const float side = dot(from, ng_);
  const V3f ng = side < 0 ? -ng_ : ng_;
  if (flat_) return LambertLobe{lobes_.diffuse * inv_pi, ng, ng, 1};
  const V3f ns = side < 0 ? -ns_ : ns_;
  if (std::abs(side) < cos_rounding) return LambertLobe{Rgb(0, 0, 0), ng, ns, 1};
  return LambertLobe{lobes_.diffuse * inv_pi, ng, ns,
                     std::max(0.0F, dot(from, ns)) / std::abs(side)};
}

Pdf<SolidAngle> Bsdf::pdf_any(const V3f& wo, const V3f& wi, Transport transport) const {
  const float side = dot(wo, ng_);
  if (lobes_.kind == Lobes::Kind::black || side == 0) return {};
  const auto density = [&](const V3f& n) {
    const ShadingFrame from = shading_frame(n, wo);
    const Choice c = choice(from);
    return scatter<false, true>(from, &c, wo, wi).pdf;
  };
  if (transport == Transport::radiance || flat_) {
    return Pdf<SolidAngle>(density(eye_normal(wo, side)));
  }
  const float by_ng = density(normal(false, side));
  if (!in_front_of_ns(wo, side)) return Pdf<SolidAngle>(by_ng);
  return Pdf<SolidAngle>(0.5F * (density(normal(true, side)) + by_ng));
}

double Bsdf::delta_probability(const Choice& c, const Interface::Split& split,
                               bool transmitted) const {
  if (transmitted && lobes_.interface.clear()) return c.clear;
  if (!lobes_.interface.smooth()) return 0;
  const FacetProbabilities coin =
      lobes_.facets_transmit() ? FacetProbabilities(split) : FacetProbabilities();
  return c.facets * (transmitted ? coin.transmit : coin.reflect);
}

std::optional<Bsdf::LobeSample> Bsdf::sample_lobe(const ShadingFrame& from, const Choice& c,
                                                  const V3f& wo, double u_lobe,
                                                  const V2f& u) const {
  const V3f& n = from.n;
  if (u_lobe < c.diffuse) return LobeSample{sample_cosine(n, u)};
  u_lobe -= c.diffuse;
  const bool clear = u_lobe < c.clear;
  if (!clear && c.facets == 0) return std::nullopt;
  const bool smooth = clear || lobes_.interface.smooth();
  V3f m = n;
  if (!smooth) {
    const Frame frame(n);
    m = frame.to_world(ggx_sample_visible(frame.to_local(wo), lobes_.interface.alpha, u));
  }
  const float cos_m = dot(wo, m);
  if (cos_m <= 0) return std::nullopt;
  const Interface::Split split = lobes_.interface.split(cos_m, from.eta);
  LobeSample result;
  result.delta = smooth;
  if (clear) {
    result.transmitted = true;
  } else {
    const FacetProbabilities coin =
        lobes_.facets_transmit() ? FacetProbabilities(split) : FacetProbabilities();
    result.transmitted = u_lobe - c.clear >= c.facets * coin.reflect;
  }
  if (result.transmitted) {
    const Fresnel f = fresnel_dielectric(cos_m, from.eta);
    if (f.total) return std::nullopt;
    result.wi = refract(wo, m, from.eta, f.cos_t);
  } else {
    result.wi = reflect(wo, m);
  }
  if (smooth) {
    const double p = delta_probability(c, split, result.transmitted);
    result.share =
        (result.transmitted ? split.transmitted : split.reflected) / static_cast<float>(p);
  }
  return result;
}

float Bsdf::frame_probability(const V3f& w, const V3f& n) const {
  if (flat_) return 1;
  if (in_front_of_ns(w, dot(w, ng_))) return 0.5F;
  return n == ng_ || n == -ng_ ? 1 : 0;
}

std::optional<DeltaLobe> Bsdf::delta(const V3f& wo, bool transmitted) const {
  const float side = dot(wo, ng_);
  if (lobes_.kind != Lobes::Kind::layered || side == 0) return std::nullopt;
  const V3f n = eye_normal(wo, side);
  const ShadingFrame from = shading_frame(n, wo);
  if (!(from.cos_o > 0)) return std::nullopt;
  const Interface::Split split = lobes_.interface.split(from.cos_o, from.eta);
  DeltaLobe lobe;
  lobe.p_radiance = delta_probability(choice(from), split, transmitted);
  if (!(lobe.p_radiance > 0)) return std::nullopt;
  if (transmitted) {
    const Fresnel f = fresnel_dielectric(from.cos_o, from.eta);
    if (f.total) return std::nullopt;
    lobe.wi = refract(wo, n, from.eta, f.cos_t);
    lobe.value = split.transmitted / (from.eta * from.eta);
  } else {
    lobe.wi = reflect(wo, n);
    lobe.value = split.reflected;
  }
  if (passage(from, lobe.wi) != (transmitted ? -1 : 1)) return std::nullopt;
  const ShadingFrame back = shading_frame(transmitted ? -n : n, lobe.wi);
  if (!(back.cos_o > 0)) return std::nullopt;
  if (transmitted) {  // eta^2 cos_i dwi = cos_o dwo
    lobe.jacobian = double(from.cos_o) / (double(from.eta) * double(from.eta) * double(back.cos_o));
  }
  lobe.p_importance =
      delta_probability(choice(back), lobes_.interface.split(back.cos_o, back.eta), transmitted) *
      double(frame_probability(lobe.wi, n)) * lobe.jacobian;
  return lobe;
}

std::optional<BsdfSample> Bsdf::finish_delta(const LobeSample& drawn, const ShadingFrame& from,
                                             const V3f& wo, float frame_probability,
                                             Transport transport) const {
  Rgb weight = drawn.share / frame_probability;
  if (transport == Transport::radiance) {
    if (drawn.transmitted) weight /= from.eta * from.eta;
  } else if (!flat_) {
    // The eye, at wi, must see the surface with the same normal. The delta, converted from the
    // light's direction to the eye's, yields the ratio of cosines with n, and exactly cancels 1 /
    // eta^2.
    const bool with_ns = from.n == ns_ || from.n == -ns_;
    const float divisor = abs_dot(drawn.wi, from.n) * abs_dot(wo, ng_);
    if (seen_with_ns(drawn.wi, dot(drawn.wi, ng_)) != with_ns ||
        divisor < cos_rounding * cos_rounding)
      return std::nullopt;
    weight *= from.cos_o * abs_dot(drawn.wi, ng_) / divisor;
  }
  return BsdfSample{drawn.wi, weight, {}, true, drawn.transmitted};
}

std::optional<BsdfSample> Bsdf::sample_any(const V3f& wo, double u_lobe, const V2f& u,
                                           Transport transport) const {
  const float side = dot(wo, ng_);
  if (lobes_.kind == Lobes::Kind::black || side == 0) return std::nullopt;
  V3f n = eye_normal(wo, side);
  float frame_probability = 1;
  if (transport == Transport::importance && !flat_) {
    n = normal(false, side);
    if (in_front_of_ns(wo, side)) {
      // Some eyes see the surface with ns, others with ng: sample either.
      frame_probability = 0.5F;
      if (u_lobe < 0.5F) n = normal(true, side);
      u_lobe = 2 * u_lobe - (u_lobe >= 0.5F ? 1.0F : 0.0F);
    }
  }
  const ShadingFrame from = shading_frame(n, wo);
  const Choice c = choice(from);
  const std::optional<LobeSample> drawn = sample_lobe(from, c, wo, u_lobe, u);
  if (!drawn || passage(from, drawn->wi) != (drawn->transmitted ? -1 : 1)) return std::nullopt;
  if (drawn->delta) return finish_delta(*drawn, from, wo, frame_probability, transport);

  const V3f& wi = drawn->wi;
  Scatter s;
  if (transport == Transport::radiance || flat_) {
    s = scatter<true, true>(from, &c, wo, wi);
    if (transport == Transport::importance && drawn->transmitted) s.f *= from.eta * from.eta;
  } else {
    s = {eval_any(wo, wi, transport), pdf_any(wo, wi, transport).value};
  }
  if (!(s.pdf > 0)) return std::nullopt;
  return BsdfSample{wi, s.f / s.pdf, Pdf<SolidAngle>(s.pdf), false, drawn->transmitted};
}

}  // namespace lacuna
