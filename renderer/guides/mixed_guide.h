#pragma once

#include <algorithm>

#include "renderer/emitters/emitter_set.h"
#include "renderer/guides/guiding_distribution.h"
#include "renderer/guides/reflected_radiance.h"
#include "renderer/path/bsdf_guide.h"

namespace lacuna {

/// One-sample MIS of a GuidingDistribution and the BSDF (Noel 2015, 9.4). A direction is sampled
/// from the distribution with probability c of its guiding cell, else from the BSDF; its density is
/// c p_guide + (1 - c) p_bsdf, which makes the weight the balance heuristic. Delta lobes are
/// sampled by the BSDF alone; where c is 1 they are lost, and so is what the distribution misses.
/// Paths from the eye and paths from the lights have a distribution each, or none, and follow the
/// BSDF. pdf() takes the transport, so each walk can evaluate the densities of the other. Only the
/// distribution of eye paths learns.
///
/// Light paths are guided from their first edge on, but for emitters without area and those that
/// emit on both sides.
class MixedGuide {
 public:
  /// Either may be null: those paths follow the BSDF.
  explicit MixedGuide(std::unique_ptr<GuidingDistribution> eye,
                      std::unique_ptr<GuidingDistribution> light = nullptr)
      : eye_(std::move(eye)), light_(std::move(light)), idle_(eye_ == nullptr) {}

  bool needs_space() const {
    return (eye_ && eye_->needs_space()) || (light_ && light_->needs_space());
  }
  void prepare(const PrepareContext& context) {
    const Bounds& box = context.scene.bounds();
    reflected_ = ReflectedRadiance(box.low, box.size());
    if (eye_) eye_->prepare(context);
    if (light_) light_->prepare(context);
  }
  void save(ByteWriter& out) const {
    if (!eye_) return;
    eye_->save(out);
    reflected_.save(out);
  }
  void load(ByteReader& in) {
    if (!eye_) return;
    eye_->load(in);
    reflected_.load(in);
    idle_ = eye_->idle();
  }
  std::vector<std::pair<std::string, double>> statistics() const {
    std::vector<std::pair<std::string, double>> all;
    if (eye_) all = eye_->statistics();
    if (!light_) return all;
    for (const auto& [name, value] : light_->statistics()) {
      all.emplace_back("light_guide_" + name, value);
    }
    return all;
  }

  static constexpr bool has_expected = true;
  float expected(const Vertex& v) const { return reflected_.at(v); }

  struct Accumulator {
    std::unique_ptr<GuidingDistribution::Accumulator> directions;  // null: they do not learn
    ReflectedRadiance::Accumulator reflected;
    double bytes() const { return reflected.bytes() + (directions ? directions->bytes() : 0); }
  };
  /// Whether paths of this transport do not follow the BSDF alone.
  bool guides(Transport transport) const { return of(transport) != nullptr; }
  bool learns() const { return !idle_ && (eye_->learns() || reflected_.learns()); }
  Accumulator accumulator() const {
    return {eye_ && eye_->learns() ? eye_->accumulator() : nullptr, {}};
  }
  void accumulate(const GuidingSample& sample, Accumulator& accumulator) const {
    if (accumulator.directions) eye_->accumulate(sample, *accumulator.directions);
  }
  void record(const Vertex& v, double value, Accumulator& accumulator) const {
    if (reflected_.learns()) reflected_.record(v, value, accumulator.reflected);
  }
  /// The variance of one sample of a pixel, estimated from one pair of pixels, and what it would be
  /// if paths followed the BSDF.
  void record_noise(double variance, double by_bsdf, Accumulator& accumulator) const {
    if (accumulator.directions) eye_->record_noise(variance, by_bsdf, *accumulator.directions);
  }
  void update(std::span<Accumulator> accumulators, const ThreadPool& pool, double iterations) {
    if (eye_ && eye_->learns()) {
      std::vector<std::unique_ptr<GuidingDistribution::Accumulator>> directions;
      for (Accumulator& a : accumulators) directions.push_back(std::move(a.directions));
      eye_->update(directions, pool, iterations);
      idle_ = eye_->idle();
    }
    if (reflected_.learns()) {
      std::vector<const ReflectedRadiance::Accumulator*> reflected;
      for (const Accumulator& a : accumulators) reflected.push_back(&a.reflected);
      reflected_.update(reflected, iterations);
    }
  }

  std::optional<std::uint64_t> due_pilot() const { return eye_ ? eye_->due_pilot() : std::nullopt; }
  void begin_pilot() { eye_->begin_pilot(); }  ///< requires due_pilot()

  /// Prefetches what on_hit() reads of `v`, whose surface and wp are known.
  void prefetch(const Vertex& v) const {
    if (!idle_) eye_->prefetch(v.surface, v.wp);
  }
  /// Looks up the guiding cell of `v` for eye paths, on the side of v.wp. That for light paths is
  /// looked up where it is needed: all paths would carry it, few are guided so.
  void on_hit(Vertex& v) const {
    if (idle_) return;  // nothing reads it
    v.guiding_cell = v.bsdf->connectible() ? eye_->cell(v.surface, v.wp) : GuidingCell{};
  }

  std::optional<BsdfSample> sample(const Vertex& v, Rng& rng, Transport transport) const {
    const GuidingDistribution* const guiding = of(transport);
    const GuidingCell cell = guiding == nullptr ? GuidingCell{} : cell_of(v, v.wp, transport);
    const float c = cell.probability;
    if (c == 0) return bsdf_.sample(v, rng, transport);
    const GuidingDistribution& directions = *guiding;
    // One point chooses and places, so that the points of both stay evenly spread.
    Rng::FinePoint u = fine_point(rng);
    if (choose(u.x, double(c))) {
      const std::optional<V3f> w = directions.sample({v.surface, *v.bsdf, v.wp, cell}, u, rng);
      if (!w) return std::nullopt;
      const Rgb f = v.bsdf->eval(v.wp, *w, transport);
      // A direction below the surface scatters nothing; it counts as a failed sample.
      if (is_black(f)) return std::nullopt;
      const Pdf<SolidAngle> bsdf = bsdf_.pdf(v, v.wp, *w, transport);
      const Pdf<SolidAngle> p = mixed(directions, {v.surface, *v.bsdf, v.wp, cell}, *w, bsdf);
      if (!p.positive()) return std::nullopt;
      const bool transmitted = dot(*w, v.surface.ng) * dot(v.wp, v.surface.ng) < 0;
      const float pdf_ratio = bsdf.positive() ? p / bsdf : 1;
      return BsdfSample{*w, f / p.value, p, false, transmitted, pdf_ratio};
    }
    std::optional<BsdfSample> s =
        v.bsdf->sample(v.wp, double(u.besides) * 0x1p-32, u.point(), transport);
    if (!s) return s;
    if (s->delta) {
      s->weight /= 1 - c;
      s->pdf_ratio = 1 - c;
      return s;
    }
    const Pdf<SolidAngle> p = mixed(directions, {v.surface, *v.bsdf, v.wp, cell}, s->wi, s->pdf);
    s->pdf_ratio = p / s->pdf;
    s->weight /= s->pdf_ratio;
    s->pdf = p;
    return s;
  }

  /// Density of `wi` for a walk of the given transport that arrived at `v` from `wo`.
  Pdf<SolidAngle> pdf(const Vertex& v, const V3f& wo, const V3f& wi, Transport transport) const {
    return pdf(v, wo, wi, transport, bsdf_.pdf(v, wo, wi, transport));
  }
  Pdf<SolidAngle> pdf(const Vertex& v, const V3f& wo, const V3f& wi, Transport transport,
                      Pdf<SolidAngle> bsdf) const {
    const GuidingDistribution* const directions = of(transport);
    if (directions == nullptr) return bsdf;
    return mixed(*directions, {v.surface, *v.bsdf, wo, cell_of(v, wo, transport)}, wi, bsdf);
  }

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
    return Leaving{{offset_origin(e.x, e.ng, e.offset, s->wi), s->wi},
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
  /// From as many numbers as the BSDF takes, so that those of what follows stay evenly spread. The
  /// bits of `x` beyond the first 32 are those of `besides`, scrambled.
  static Rng::FinePoint fine_point(Rng& rng) {
    const auto [choice, point] = rng.next_choice_and_point();
    const auto bits = static_cast<std::uint64_t>(choice * 0x1p48);
    const auto whole = [](float unit, std::uint64_t rest) {
      return static_cast<std::uint32_t>(unit * 0x1p24F) << 8 |
             static_cast<std::uint32_t>(rest & 0xff);
    };
    const auto besides = static_cast<std::uint32_t>(bits >> 16);
    const std::uint32_t low = besides * 0x9e3779b9U;
    return {std::uint64_t{whole(point.x, bits >> 8)} << 32 | low, whole(point.y, bits), besides};
  }
  /// True with probability `c`, by uniform `u` of 2^64, which gets what is left.
  static bool choose(std::uint64_t& u, double c) {
    const double at = static_cast<double>(u) * 0x1p-64;
    const bool chosen = at < c || c >= 1;
    const double left = chosen ? at / c : (at - c) / (1 - c);
    u = static_cast<std::uint64_t>(std::min(left, 1 - 0x1p-53) * 0x1p64);
    return chosen;
  }
  /// The distribution of paths of this transport; null: they follow the BSDF.
  const GuidingDistribution* of(Transport transport) const {
    if (transport == Transport::importance) return light_.get();
    return idle_ ? nullptr : eye_.get();
  }
  /// The cell of `v` as seen from `wo`, for paths of this transport. Requires of(transport).
  GuidingCell cell_of(const Vertex& v, const V3f& wo, Transport transport) const {
    if (transport == Transport::importance) {
      return v.bsdf->connectible() ? light_->cell(v.surface, wo) : GuidingCell{};
    }
    const bool this_side = (dot(wo, v.surface.ng) < 0) == (dot(v.wp, v.surface.ng) < 0);
    return this_side ? v.guiding_cell : eye_->cell(v.surface, wo);
  }
  static Pdf<SolidAngle> mixed(const GuidingDistribution& directions, const GuidedVertex& at,
                               const V3f& wi, Pdf<SolidAngle> bsdf) {
    const float c = at.cell.probability;
    if (c == 0) return bsdf;
    return c * directions.pdf(at, wi) + (1 - c) * bsdf;
  }

  bool guides(const EmitterPoint& e) const {
    return light_ && e.kind == EmitterPoint::Kind::area && !e.both_sides;
  }
  void make_white(const EmitterPoint& e, Vertex& v) const {
    v.kind = Vertex::Kind::surface;
    v.surface.x = e.x;
    v.surface.ng = v.surface.ns = v.wp = e.ng;
    v.surface.offset = e.offset;
    v.bsdf.emplace(white_, e.ng, e.ng);
  }

  std::unique_ptr<GuidingDistribution> eye_, light_;
  ReflectedRadiance reflected_;
  BsdfGuide bsdf_;
  Lobes white_{SurfaceParams{.f0 = Rgb(0, 0, 0), .f90 = 0}};
  bool idle_;
};
static_assert(Guide<MixedGuide>);

}  // namespace lacuna
