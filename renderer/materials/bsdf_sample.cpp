// Sampling of the BSDF, and its delta lobes.

#include "renderer/materials/bsdf.h"

#include "renderer/materials/facet_probabilities.h"

namespace lacuna {

namespace {

/// Uniform on the hemisphere around `n`.
V3f sample_hemisphere(const V3f& n, const V2f& u) {
  // The disk preserves areas, and so does its lift to z = 1 - r^2 (Shirley and Chiu 1997).
  const V2f d = sample_disk(u);
  const float r2 = d.x * d.x + d.y * d.y;
  const float stretch = std::sqrt(2 - r2);
  return Frame(n).to_world({d.x * stretch, d.y * stretch, 1 - r2});
}

}  // namespace

bool Bsdf::has_broad_further() const {
  const Covers& covers = lobes_->further->covers;
  return !is_black(lobes_->further->diffuse_through) || covers.sheen.any() ||
         (covers.coat.any() && !covers.coat.smooth()) || coating_alpha() > 0;
}

Bsdf::Choice Bsdf::choice(const ShadingFrame& from) const {
  Choice c;
  if (!lobes_->facets_compete()) {
    c.facets = 1;
    return c;
  }
  if (coated()) return coated_choice(from);
  weigh_base(from, c);
  if (!lobes_->further) {
    const double sum = c.diffuse + c.facets + c.clear;
    if (!(sum > 0)) return {};
    c.diffuse /= sum;
    c.facets /= sum;
    c.clear /= sum;
    return c;
  }
  add_covers(from, c);
  const double sum = c.diffuse + c.through + c.facets + c.clear + c.coat + c.sheen;
  if (!(sum > 0)) return {};
  for (double* p : {&c.diffuse, &c.through, &c.facets, &c.clear, &c.coat, &c.sheen}) *p /= sum;
  return c;
}

void Bsdf::weigh_base(const ShadingFrame& from, Choice& c) const {
  const Interface& interface = lobes_->interface;
  if (interface.glass > 0 || interface.film.strength > 0 || interface.exact()) {
    const Interface::Split s = interface.split(from.cos_o, from.eta);
    c.facets = double(luminance(s.reflected));
    if (interface.clear()) {
      c.clear = double(luminance(s.transmitted));
      // Tilted facets may reflect even if the mean facet hardly does.
      if (interface.ior != 1) c.facets += double(interface.glass * from.mean_weight);
    } else {
      c.facets += double(luminance(s.transmitted));
    }
  } else {
    const float r0 = luminance(interface.r0);
    c.facets = double(r0 + (interface.r90 - r0) * from.mean_weight);
  }
  const float through_layer = lobes_->layer.let_through(from.mean_weight);
  if (lobes_->has_diffuse()) c.diffuse = double(luminance(lobes_->diffuse) * through_layer);
  if (lobes_->further)
    c.through = double(luminance(lobes_->further->diffuse_through) * through_layer);
}

void Bsdf::add_covers(const ShadingFrame& from, Choice& c) const {
  if (!lobes_->further->covers.any() || !(lobes_->interface.thin || from.front)) return;
  for (double* p : {&c.diffuse, &c.through, &c.facets, &c.clear}) {
    *p *= double(from.through.both());
  }
  c.coat = double(1 - from.through.coat);
  c.sheen = double(from.through.coat * (1 - from.through.sheen));
}

double Bsdf::delta_probability(const Choice& c, const Interface::Split& split,
                               bool transmitted) const {
  if (transmitted && lobes_->interface.clear()) return c.clear;
  if (!lobes_->interface.smooth()) return 0;
  const FacetProbabilities coin =
      lobes_->facets_transmit() ? FacetProbabilities(split) : FacetProbabilities();
  return c.facets * (transmitted ? coin.transmit : coin.reflect);
}

Bsdf::DeltaSum Bsdf::delta_sum(const ShadingFrame& from, const Choice& c,
                               const Interface::Split& split, const V3f& wi,
                               bool transmitted) const {
  if (coated()) return transmitted ? DeltaSum{} : coated_delta_sum(from, c, wi);
  DeltaSum sum{{0, 0, 0}, delta_probability(c, split, transmitted)};
  if (sum.p > 0) sum.value = transmitted ? split.transmitted : split.reflected;
  if (!lobes_->further) return sum;
  const Covers::Through o = from.through, i = let_through(wi, abs_dot(wi, from.n));
  sum.value *= std::min(o.coat, i.coat) * std::min(o.sheen, i.sheen);
  if (!transmitted && c.coat > 0 && lobes_->further->covers.coat.smooth()) {
    sum.p += c.coat;
    sum.value += Rgb(lobes_->further->covers.coat.reflectance(from.cos_o));
  }
  sum.value *= lobes_->further->scale;
  return sum;
}

std::optional<V3f> Bsdf::passed(const ShadingFrame& from, const V3f& wo, const V3f& m) const {
  if (lobes_->interface.thin) {
    if (m == from.n) return -wo;
    const V3f wr = reflect(wo, m);
    return wr - (2 * dot(wr, from.n)) * from.n;
  }
  const Fresnel f = fresnel_dielectric(dot(wo, m), from.eta);
  if (f.total) return std::nullopt;
  return refract(wo, m, from.eta, f.cos_t);
}

std::optional<Bsdf::LobeSample> Bsdf::sample_lobe(const ShadingFrame& from, const Choice& c,
                                                  const V3f& wo, double u_lobe,
                                                  const V2f& u) const {
  const V3f& n = from.n;
  if (u_lobe < c.diffuse) return LobeSample{sample_cosine(n, u)};
  u_lobe -= c.diffuse;
  if (lobes_->further) {
    if (coated()) return sample_coated(from, c, wo, u_lobe, u);
    if (u_lobe < c.through) return LobeSample{sample_cosine(-n, u), true};
    u_lobe -= c.through;
    if (u_lobe < c.sheen) return LobeSample{sample_hemisphere(n, u)};
    u_lobe -= c.sheen;
    if (u_lobe < c.coat) return sample_coat(from, c, wo, u);
    u_lobe -= c.coat;
  }
  const bool clear = u_lobe < c.clear;
  if (!clear && c.facets == 0) return std::nullopt;
  const bool smooth = clear || lobes_->interface.smooth();
  const V3f m = smooth ? n : facets(n).sample(wo, u);
  const float cos_m = dot(wo, m);
  if (cos_m <= 0) return std::nullopt;
  const Interface::Split split = lobes_->interface.split(cos_m, from.eta);
  LobeSample result;
  if (clear) {
    result.transmitted = true;
  } else {
    const FacetProbabilities coin =
        lobes_->facets_transmit() ? FacetProbabilities(split) : FacetProbabilities();
    result.transmitted = u_lobe - c.clear >= c.facets * coin.reflect;
  }
  if (result.transmitted) {
    const std::optional<V3f> wi = passed(from, wo, m);
    if (!wi) return std::nullopt;
    result.wi = *wi;
  } else {
    result.wi = reflect(wo, m);
  }
  if (smooth) result.delta = delta_sum(from, c, split, result.wi, result.transmitted);
  return result;
}

Bsdf::LobeSample Bsdf::sample_coat(const ShadingFrame& from, const Choice& c, const V3f& wo,
                                   const V2f& u) const {
  const Coat& coat = lobes_->further->covers.coat;
  if (!coat.smooth()) {
    return {.wi = reflect(wo, Facets(from.coat_n, coat.alpha).sample(wo, u)), .by_coat = true};
  }
  LobeSample result{reflect(wo, from.n)};
  result.delta =
      delta_sum(from, c, lobes_->interface.split(from.cos_o, from.eta), result.wi, false);
  return result;
}

float Bsdf::frame_probability(const V3f& w, const V3f& n) const {
  if (flat_) return 1;
  if (in_front_of_ns(w, dot(w, ng_))) return 0.5F;
  return n == ng_ || n == -ng_ ? 1 : 0;
}

std::optional<DeltaLobe> Bsdf::delta(const V3f& wo, bool transmitted) const {
  const float side = dot(wo, ng_);
  if (lobes_->kind != Lobes::Kind::layered || dark(side)) return std::nullopt;
  const V3f n = eye_normal(wo, side);
  const ShadingFrame from = shading_frame(n, wo);
  if (!(from.cos_o > 0)) return std::nullopt;
  DeltaLobe lobe;
  const std::optional<V3f> wi = transmitted ? passed(from, wo, n) : reflect(wo, n);
  if (!wi) return std::nullopt;
  lobe.wi = *wi;
  const DeltaSum sum = delta_sum(from, choice(from), lobes_->interface.split(from.cos_o, from.eta),
                                 lobe.wi, transmitted);
  if (!(sum.p > 0)) return std::nullopt;
  lobe.p_radiance = sum.p;
  lobe.value = transmitted ? sum.value / (from.bend * from.bend) : sum.value;
  if (passage(from.front, n, lobe.wi) != (transmitted ? -1 : 1)) return std::nullopt;
  const ShadingFrame back = shading_frame(transmitted ? -n : n, lobe.wi);
  if (!(back.cos_o > 0)) return std::nullopt;
  if (transmitted) {  // bend^2 cos_i dwi = cos_o dwo
    lobe.jacobian =
        double(from.cos_o) / (double(from.bend) * double(from.bend) * double(back.cos_o));
  }
  lobe.p_importance =
      delta_sum(back, choice(back), lobes_->interface.split(back.cos_o, back.eta), wo, transmitted)
          .p *
      double(frame_probability(lobe.wi, n)) * lobe.jacobian;
  return lobe;
}

std::optional<BsdfSample> Bsdf::finish_delta(const LobeSample& drawn, const ShadingFrame& from,
                                             const V3f& wo, float frame_probability,
                                             Transport transport) const {
  Rgb weight = drawn.delta.value / static_cast<float>(drawn.delta.p) / frame_probability;
  if (transport == Transport::radiance) {
    if (drawn.transmitted) weight /= from.bend * from.bend;
  } else if (!flat_) {
    // The eye, at wi, must see the surface with the same normal. The delta, converted from the
    // light's direction to the eye's, yields the ratio of cosines with n, and exactly cancels 1 /
    // bend^2.
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
  if (dark(side)) return std::nullopt;
  V3f n = eye_normal(wo, side);
  CoatFrame coat = CoatFrame::seen;
  const bool by_eye = transport == Transport::radiance || reciprocal();
  if (!by_eye) {
    n = normal(false, side);
    coat = CoatFrame::flat;
    if (two_frames(wo, side)) {
      // Some eyes see the surface with ns, others with ng: sample either.
      if (u_lobe < 0.5F) {
        n = front_normal(wo, side);
        coat = CoatFrame::own;
      }
      u_lobe = 2 * u_lobe - (u_lobe >= 0.5F ? 1.0F : 0.0F);
    }
  }
  const ShadingFrame from = shading_frame(n, wo, coat);
  const Choice c = choice(from);
  const std::optional<LobeSample> drawn = sample_lobe(from, c, wo, u_lobe, u);
  if (!drawn) return std::nullopt;
  const int way = passage(from.front, drawn->by_coat ? from.coat_n : n, drawn->wi);
  if (way != (drawn->transmitted ? -1 : 1)) return std::nullopt;
  if (drawn->delta.p > 0) {
    // Where both frames have this normal, each returns the lobe in full.
    const float share = by_eye ? 1.0F : frame_probability(wo, n);
    return finish_delta(*drawn, from, wo, share, transport);
  }

  const V3f& wi = drawn->wi;
  Scatter s;
  if (by_eye) {
    s = scatter<true, true>(from, &c, wo, wi);
    if (transport == Transport::importance && drawn->transmitted) s.f *= from.bend * from.bend;
  } else {
    s = {eval_any(wo, wi, transport), pdf_any(wo, wi, transport).value};
  }
  // Ward's density has a pole at grazing angles.
  if (!(s.pdf > 0) || std::isinf(s.pdf)) return std::nullopt;
  return BsdfSample{wi, s.f / s.pdf, Pdf<SolidAngle>(s.pdf), false, drawn->transmitted};
}

}  // namespace lacuna
