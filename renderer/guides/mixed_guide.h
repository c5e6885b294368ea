#pragma once

#include "renderer/guides/guiding_distribution.h"
#include "renderer/path/bsdf_guide.h"

namespace lacuna {

/// One-sample combination of a distribution of directions with the BSDF (Noel 2015, 9.4): of paths
/// from the eye a direction comes from the former with the probability that its site names, and its
/// density is that of both together, so the balance heuristic is in the weight. Delta lobes are the
/// BSDF's alone. Paths from lights follow the BSDF: how either walk goes on is the guide's answer
/// for the transport that it is asked for, so each knows the other's densities.
class MixedGuide {
 public:
  explicit MixedGuide(std::unique_ptr<GuidingDistribution> directions)
      : directions_(std::move(directions)) {}

  bool needs_space() const { return directions_->needs_space(); }
  void prepare(const PrepareContext& context) { directions_->prepare(context); }
  void save(ByteWriter& out) const { directions_->save(out); }
  void load(ByteReader& in) { directions_->load(in); }
  std::vector<std::pair<std::string, double>> statistics() const {
    return directions_->statistics();
  }

  using Tally = std::unique_ptr<GuidingDistribution::Tally>;
  bool learns() const { return directions_->learns(); }
  Tally tally() const { return directions_->tally(); }
  void learn(const GuidingSample& what, Tally& tally) const { directions_->learn(what, *tally); }
  void end(std::span<const Tally> tallies, const ThreadPool& pool) {
    directions_->end(tallies, pool);
  }

  /// Looks up what directions and densities at `v`, as seen from v.wp, need.
  void arrive(Vertex& v) const {
    v.site = v.bsdf->connectible() ? directions_->site(v.surface, v.wp) : GuidingCell{};
  }

  std::optional<BsdfSample> sample(const Vertex& v, Rng& rng, Transport transport) const {
    const float c = v.site.probability;
    if (transport == Transport::importance || c == 0) return bsdf_.sample(v, rng, transport);
    if (rng.decide(c)) {
      const std::optional<V3f> w = directions_->sample({v.surface, *v.bsdf, v.wp, v.site}, rng);
      if (!w) return std::nullopt;
      const Rgb f = v.bsdf->eval(v.wp, *w, transport);
      // Light from below the surface is not scattered; the density of such draws counts all the
      // same.
      if (is_black(f)) return std::nullopt;
      const Pdf<SolidAngle> bsdf = bsdf_.pdf(v, v.wp, *w, transport);
      const Pdf<SolidAngle> p = mixed(v, v.wp, v.site, *w, bsdf);
      if (!p.positive()) return std::nullopt;
      const bool transmitted = dot(*w, v.surface.ng) * dot(v.wp, v.surface.ng) < 0;
      const float pdf_ratio = bsdf.positive() ? p / bsdf : 1;
      return BsdfSample{*w, f / p.value, p, false, transmitted, pdf_ratio};
    }
    std::optional<BsdfSample> s = bsdf_.sample(v, rng, transport);
    if (!s) return s;
    if (s->delta) {
      s->weight /= 1 - c;
      s->pdf_ratio = 1 - c;
      return s;
    }
    const Pdf<SolidAngle> p = mixed(v, v.wp, v.site, s->wi, s->pdf);
    s->pdf_ratio = p / s->pdf;
    s->weight /= s->pdf_ratio;
    s->pdf = p;
    return s;
  }

  /// Density of `wi` for a walk of kind `transport` that arrived at `v` from `wo`.
  Pdf<SolidAngle> pdf(const Vertex& v, const V3f& wo, const V3f& wi, Transport transport) const {
    const Pdf<SolidAngle> bsdf = bsdf_.pdf(v, wo, wi, transport);
    if (transport == Transport::importance) return bsdf;
    const bool this_side = (dot(wo, v.surface.ng) < 0) == (dot(v.wp, v.surface.ng) < 0);
    return mixed(v, wo, this_side ? v.site : directions_->site(v.surface, wo), wi, bsdf);
  }

 private:
  Pdf<SolidAngle> mixed(const Vertex& v, const V3f& wo, const GuidingCell& site, const V3f& wi,
                        Pdf<SolidAngle> bsdf) const {
    const float c = site.probability;
    if (c == 0) return bsdf;
    return c * directions_->pdf({v.surface, *v.bsdf, wo, site}, wi) + (1 - c) * bsdf;
  }

  std::unique_ptr<GuidingDistribution> directions_;
  BsdfGuide bsdf_;
};
static_assert(Guide<MixedGuide>);

}  // namespace lacuna
