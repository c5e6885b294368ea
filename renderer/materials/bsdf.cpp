#include "renderer/materials/bsdf.h"

#include "renderer/materials/facet_probabilities.h"
#include "renderer/materials/oren_nayar.h"

namespace lacuna {
namespace {

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
  if (lobes_->kind != Lobes::Kind::layered) return lobes_->diffuse;
  const auto& further = lobes_->further;
  const Rgb through = further ? further->diffuse_through : Rgb(0, 0, 0);
  const Rgb base = lobes_->interface.r0 +
                   lobes_->layer.let_through(0.0F) * (lobes_->diffuse + through) +
                   lobes_->interface.glass_color;
  if (!further) return base;
  const float coat = further->covers.coat.reflectance(1);
  const Rgb white(1, 1, 1);
  // Sheen is seen at grazing angles: half of it stands for all directions.
  const Rgb sheen = 0.5F * further->covers.sheen.color();
  const Rgb covered = coat * white + (1 - coat) * (sheen + (white - sheen) * base);
  if (!further->coating) return further->scale * covered;
  const Coating& c = *further->coating;
  const float passes = c.let_through(1);
  const Rgb absorption = c.absorption_at(1);
  return further->scale *
         (c.reflectance(1) + (passes * passes) * absorption * absorption * covered);
}

V3f Bsdf::coat_normal(const V3f& w, CoatFrame frame) const {
  const float side = dot(w, ng_);
  const V3f ng = side < 0 ? -ng_ : ng_;
  const V3f& own = *lobes_->further->coat_normal;
  const V3f n = dot(own, ng) < 0 ? -own : own;
  if (frame == CoatFrame::flat || !(dot(w, n) > 0)) return ng;
  return frame == CoatFrame::seen && !(dot(reflect(w, n), ng) > 0) ? ng : n;
}

Bsdf::ShadingFrame Bsdf::shading_frame(const V3f& n, const V3f& wo, CoatFrame coat) const {
  const bool front = dot(wo, ng_) > 0;
  const Interface& i = lobes_->interface;
  ShadingFrame result{n, front, dot(wo, n), i.eta(front), i.bend(front)};
  if (lobes_->facets_compete()) result.mean_weight = lobes_->layer.mean_weight(result.cos_o);
  if (lobes_->further) {
    result.through = let_through(wo, result.cos_o);
    result.coat_n = own_coat_normal() ? coat_normal(wo, coat) : n;
  }
  return result;
}

int Bsdf::passage(bool front, const V3f& n, const V3f& wi) const {
  const float side_i = dot(wi, ng_);
  const float cos_i = dot(wi, n);
  const float same = front ? side_i : -side_i;
  if (same > 0 && cos_i > 0) return 1;
  return same < 0 && cos_i < 0 ? -1 : 0;
}

template <bool want_f, bool want_pdf>
void Bsdf::reflected(const ShadingFrame& from, const Choice* c, const V3f& wo, const V3f& wi,
                     Scatter& s) const {
  const float cos_i = dot(wi, from.n);
  if (lobes_->has_diffuse()) {
    if constexpr (want_f) {
      const float scale =
          lobes_->layer.scale(lobes_->layer.let_through(from.mean_weight),
                              lobes_->layer.let_through(lobes_->layer.mean_weight(cos_i)));
      s.f = lobes_->diffuse * (scale * cos_i * inv_pi);
      if (lobes_->further && lobes_->further->sigma > 0) {
        s.f = oren_nayar(lobes_->diffuse, lobes_->further->sigma, from.n, wo, wi) *
              (scale * cos_i * inv_pi);
      }
    }
    if constexpr (want_pdf) s.pdf = static_cast<float>(c->diffuse) * cos_i * inv_pi;
  }
  const V3f h = wo + wi;
  const float length = std::sqrt(h.length2());
  if (lobes_->interface.smooth() || length < cos_rounding) return;
  const V3f m = h * (1 / length);
  const Facets all = facets(from.n);
  const float d = all.d(m, wo);
  Interface::Split split;
  if (want_f || lobes_->facets_transmit()) split = lobes_->interface.split(0.5F * length, from.eta);
  if constexpr (want_f) s.f += split.reflected * (d * all.g2_over_4cos(wo, from.cos_o, wi, cos_i));
  if constexpr (want_pdf) {
    // Visible normals; dm / dwi = 1 / (4 wo.m).
    const FacetProbabilities coin =
        lobes_->facets_transmit() ? FacetProbabilities(split) : FacetProbabilities();
    s.pdf += static_cast<float>(c->facets * coin.reflect) * 0.25F *
             all.sampled_over_d(wo, from.cos_o, m) * d;
  }
}

template <bool want_f, bool want_pdf>
void Bsdf::transmitted(const ShadingFrame& from, const Choice* c, const V3f& wo, const V3f& wi,
                       Scatter& s) const {
  if (lobes_->further && !is_black(lobes_->further->diffuse_through)) {
    const float cos_i = -dot(wi, from.n);
    if constexpr (want_f) {
      const float scale =
          lobes_->layer.scale(lobes_->layer.let_through(from.mean_weight),
                              lobes_->layer.let_through(lobes_->layer.mean_weight(cos_i)));
      // Reciprocal between two media: f / n_o^2 is the same for both directions, and a share of the
      // flux from outside. From inside, less leaves by as much as total reflection would return.
      const float share = std::min(1.0F, 1 / (from.bend * from.bend));
      s.f = lobes_->further->diffuse_through * (scale * cos_i * inv_pi * share);
    }
    if constexpr (want_pdf) s.pdf = static_cast<float>(c->through) * cos_i * inv_pi;
  }
  if (lobes_->interface.smooth() || !lobes_->facets_transmit()) return;
  if (lobes_->interface.thin) {
    mirrored<want_f, want_pdf>(from, c, wo, wi, s);
  } else {
    refracted<want_f, want_pdf>(from, c, wo, wi, s);
  }
}

/// A thin wall: what is reflected to the mirror image of wi passes to wi instead.
template <bool want_f, bool want_pdf>
void Bsdf::mirrored(const ShadingFrame& from, const Choice* c, const V3f& wo, const V3f& wi,
                    Scatter& s) const {
  const float cos_i = -dot(wi, from.n);
  const V3f h = wo + (wi + (2 * cos_i) * from.n);
  const float length = std::sqrt(h.length2());
  if (length < cos_rounding) return;
  const Facets all = facets(from.n);
  const float d = all.d(h * (1 / length), wo);
  const Interface::Split split = lobes_->interface.split(0.5F * length, from.eta);
  if constexpr (want_f) {
    s.f += split.transmitted * (d * all.g2_over_4cos(wo, from.cos_o, wi, cos_i));
  }
  if constexpr (want_pdf) {
    s.pdf += static_cast<float>(c->facets * FacetProbabilities(split).transmit) * 0.25F *
             all.g1_over_cos(wo, from.cos_o) * d;
  }
}

template <bool want_f, bool want_pdf>
void Bsdf::refracted(const ShadingFrame& from, const Choice* c, const V3f& wo, const V3f& wi,
                     Scatter& s) const {
  const auto facet = RefractingFacet::find(from.n, wo, wi, from.eta);
  if (!facet) return;
  const float ior = lobes_->interface.ior;
  const Rgb share = lobes_->interface.split(facet->cos_outside, std::max(ior, 1 / ior)).transmitted;
  const float cos_i = -dot(wi, from.n);
  const Facets all = facets(from.n);
  const float common = all.d(facet->m, wo) * all.g1_over_cos(wo, from.cos_o) * facet->cos_o *
                       -facet->cos_i * facet->jacobian;
  // Walter et al. 2007, eq. 21, times the light's cosine; n_o^2 / (...)^2 is the jacobian, which
  // includes the 1 / eta^2 of radiance.
  if constexpr (want_f) {
    s.f += share * (lobes_->interface.exact() ? all.shadowed(common, wo, from.cos_o, wi, cos_i)
                                              : common * all.g1_over_cos(wi, cos_i) * cos_i);
  }
  if constexpr (want_pdf) {
    // dm / dwi = eta^2 |wi.m| / (...)^2 (Walter et al. 2007, eq. 17).
    const FacetProbabilities coin(lobes_->interface.split(facet->cos_o, from.eta).reflected, share);
    s.pdf += static_cast<float>(c->facets * coin.transmit) * common * from.eta * from.eta;
  }
}

template <bool want_f, bool want_pdf>
void Bsdf::cover(const ShadingFrame& from, const Choice* c, const V3f& wo, const V3f& wi,
                 Scatter& s) const {
  const float cos = dot(wi, from.n), cos_i = std::abs(cos);
  const Covers& covers = lobes_->further->covers;
  const Covers::Through o = from.through, i = let_through(wi, cos_i);
  const bool lobes = cos > 0 && (lobes_->interface.thin || from.front);
  const V3f h = wo + wi;
  const float length = std::sqrt(h.length2());
  const V3f m = length < cos_rounding ? from.n : h * (1 / length);
  if constexpr (want_f) s.f *= std::min(o.sheen, i.sheen);
  if (lobes && covers.sheen.any()) {
    if constexpr (want_f) {
      s.f += covers.sheen.eval(from.cos_o, cos_i, cross(m, from.n).length2());
    }
    if constexpr (want_pdf) s.pdf += static_cast<float>(c->sheen) * 0.5F * inv_pi;
  }
  if constexpr (want_f) s.f *= std::min(o.coat, i.coat);
}

template <bool want_f, bool want_pdf>
void Bsdf::coat_lobe(const ShadingFrame& from, const Choice* c, const V3f& wo, const V3f& wi,
                     Scatter& s) const {
  const Coat& coat = lobes_->further->covers.coat;
  if (!coat.any() || coat.smooth() || !(lobes_->interface.thin || from.front)) return;
  const V3f h = wo + wi;
  const float length = std::sqrt(h.length2());
  if (passage(from.front, from.coat_n, wi) <= 0 || length < cos_rounding) return;
  const Facets facets(from.coat_n, coat.alpha);
  const float d = facets.d(h * (1 / length), wo);
  const float cos_o = dot(wo, from.coat_n);
  if constexpr (want_f) {
    s.f += Rgb(coat.reflectance(0.5F * length) * d *
               facets.g2_over_4cos(wo, cos_o, wi, dot(wi, from.coat_n)));
  }
  if constexpr (want_pdf) {
    s.pdf += static_cast<float>(c->coat) * 0.25F * facets.g1_over_cos(wo, cos_o) * d;
  }
}

template <bool want_f, bool want_pdf>
Bsdf::Scatter Bsdf::scatter(const ShadingFrame& from, const Choice* c, const V3f& wo,
                            const V3f& wi) const {
  Scatter s;
  const int side = passage(from.front, from.n, wi);
  if (coated()) {
    if (side > 0) s = coated_scatter<want_f, want_pdf>(from, c, wo, wi);
    return s;
  }
  if (side > 0) reflected<want_f, want_pdf>(from, c, wo, wi, s);
  if (side < 0) transmitted<want_f, want_pdf>(from, c, wo, wi, s);
  if (lobes_->further) {
    if (side != 0 && lobes_->further->covers.any()) cover<want_f, want_pdf>(from, c, wo, wi, s);
    coat_lobe<want_f, want_pdf>(from, c, wo, wi, s);
    if constexpr (want_f) s.f *= lobes_->further->scale;
  }
  return s;
}
// For bsdf_sample.cpp and bsdf_coating.cpp.
template Bsdf::Scatter Bsdf::scatter<true, true>(const ShadingFrame&, const Choice*, const V3f&,
                                                 const V3f&) const;
template Bsdf::Scatter Bsdf::scatter<true, false>(const ShadingFrame&, const Choice*, const V3f&,
                                                  const V3f&) const;
template Bsdf::Scatter Bsdf::scatter<false, true>(const ShadingFrame&, const Choice*, const V3f&,
                                                  const V3f&) const;

Rgb Bsdf::eval_any(const V3f& wo, const V3f& wi, Transport transport) const {
  const float side = dot(wo, ng_);
  const float side_i = dot(wi, ng_);
  if (dark(side) || side_i == 0) return Rgb(0, 0, 0);
  if (transport == Transport::radiance || reciprocal()) {
    const ShadingFrame from = shading_frame(eye_normal(wo, side), wo);
    const Rgb f = scatter<true, false>(from, nullptr, wo, wi).f;
    // Reciprocal for ns = ng: importance is not scaled by 1 / eta^2.
    const bool unscale = transport == Transport::importance && (side > 0) != (side_i > 0);
    return unscale ? f * (from.bend * from.bend) : f;
  }
  if (std::abs(side) < cos_rounding) return Rgb(0, 0, 0);
  const ShadingFrame from = shading_frame(eye_normal(wi, side_i), wi);
  return scatter<true, false>(from, nullptr, wi, wo).f * std::abs(side_i / side);
}

Bsdf::Evaluated Bsdf::evaluate_any(const V3f& wo, const V3f& wi, Transport transport) const {
  if (transport != Transport::radiance && !reciprocal()) {
    return {eval_any(wo, wi, transport), pdf_any(wo, wi, transport)};
  }
  const float side = dot(wo, ng_);
  if (dark(side)) return {};
  const V3f n = eye_normal(wo, side);
  const bool front = side > 0;
  // Early out before the lobes' terms: half of all directions lie behind an opaque surface.
  if (!transmits() && passage(front, n, wi) <= 0 && !own_coat_normal()) return {};
  const ShadingFrame from = shading_frame(n, wo);
  const Choice c = choice(from);
  Scatter s = scatter<true, true>(from, &c, wo, wi);
  const bool crosses = front != (dot(wi, ng_) > 0);
  if (transport == Transport::importance && crosses) s.f *= from.bend * from.bend;
  return {s.f, Pdf<SolidAngle>(s.pdf)};
}

std::optional<LambertLobe> Bsdf::lambert_lobe(const V3f& from) const {
  if (lobes_->kind != Lobes::Kind::lambert) return std::nullopt;
  const float side = dot(from, ng_);
  const V3f ng = side < 0 ? -ng_ : ng_;
  if (flat_) return LambertLobe{lobes_->diffuse * inv_pi, ng, ng, 1};
  const V3f ns = side < 0 ? -ns_ : ns_;
  if (std::abs(side) < cos_rounding) return LambertLobe{Rgb(0, 0, 0), ng, ns, 1};
  return LambertLobe{lobes_->diffuse * inv_pi, ng, ns,
                     std::max(0.0F, dot(from, ns)) / std::abs(side)};
}

Pdf<SolidAngle> Bsdf::pdf_any(const V3f& wo, const V3f& wi, Transport transport) const {
  const float side = dot(wo, ng_);
  if (dark(side)) return {};
  const auto density = [&](const V3f& n, CoatFrame coat) {
    const ShadingFrame from = shading_frame(n, wo, coat);
    const Choice c = choice(from);
    return scatter<false, true>(from, &c, wo, wi).pdf;
  };
  if (transport == Transport::radiance || reciprocal()) {
    return Pdf<SolidAngle>(density(eye_normal(wo, side), CoatFrame::seen));
  }
  const float by_ng = density(normal(false, side), CoatFrame::flat);
  if (!two_frames(wo, side)) return Pdf<SolidAngle>(by_ng);
  return Pdf<SolidAngle>(0.5F * (density(front_normal(wo, side), CoatFrame::own) + by_ng));
}

}  // namespace lacuna
