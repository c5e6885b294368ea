#pragma once

#include <algorithm>

#include "renderer/guides/guiding_distribution.h"
#include "renderer/guides/reflected_radiance.h"
#include "renderer/path/bsdf_guide.h"

namespace lacuna {

/// One-sample MIS of a GuidingDistribution and the BSDF (Noel 2015, 9.4). On the paths it guides,
/// those from the eye unless told otherwise, a direction is sampled from the distribution with
/// probability c of its guiding cell, else from the BSDF; its density is c p_guide + (1 - c)
/// p_bsdf, which makes the weight the balance heuristic. Delta lobes are sampled by the BSDF alone;
/// where c is 1 they are lost, and so is what the distribution misses.
/// Paths of the other transport follow the BSDF. pdf() takes the transport, so each walk can
/// evaluate the densities of the other.
class MixedGuide {
 public:
  explicit MixedGuide(std::unique_ptr<GuidingDistribution> directions,
                      Transport guided = Transport::radiance)
      : directions_(std::move(directions)), guided_(guided) {}

  bool needs_space() const { return directions_->needs_space(); }
  void prepare(const PrepareContext& context) {
    const Bounds& box = context.scene.bounds();
    reflected_ = ReflectedRadiance(box.low, box.size());
    directions_->prepare(context);
  }
  void save(ByteWriter& out) const {
    directions_->save(out);
    reflected_.save(out);
  }
  void load(ByteReader& in) {
    directions_->load(in);
    reflected_.load(in);
    idle_ = directions_->idle();
  }
  std::vector<std::pair<std::string, double>> statistics() const {
    return directions_->statistics();
  }

  static constexpr bool has_expected = true;
  float expected(const Vertex& v) const { return reflected_.at(v); }

  struct Accumulator {
    std::unique_ptr<GuidingDistribution::Accumulator> directions;  // null: they do not learn
    ReflectedRadiance::Accumulator reflected;
  };
  /// It samples the BSDF alone and learns nothing: the same as BsdfGuide.
  bool idle() const { return idle_; }
  bool learns() const { return !idle_ && (directions_->learns() || reflected_.learns()); }
  Accumulator accumulator() const {
    return {directions_->learns() ? directions_->accumulator() : nullptr, {}};
  }
  void accumulate(const GuidingSample& sample, Accumulator& accumulator) const {
    if (accumulator.directions) directions_->accumulate(sample, *accumulator.directions);
  }
  void record(const Vertex& v, double value, Accumulator& accumulator) const {
    if (reflected_.learns()) reflected_.record(v, value, accumulator.reflected);
  }
  /// The variance of one sample of a pixel, estimated from one pair of pixels.
  void record_noise(double variance, Accumulator& accumulator) const {
    if (accumulator.directions) directions_->record_noise(variance, *accumulator.directions);
  }
  void update(std::span<Accumulator> accumulators, const ThreadPool& pool, double iterations) {
    if (directions_->learns()) {
      std::vector<std::unique_ptr<GuidingDistribution::Accumulator>> directions;
      for (Accumulator& a : accumulators) directions.push_back(std::move(a.directions));
      directions_->update(directions, pool, iterations);
      idle_ = directions_->idle();
    }
    if (reflected_.learns()) {
      std::vector<const ReflectedRadiance::Accumulator*> reflected;
      for (const Accumulator& a : accumulators) reflected.push_back(&a.reflected);
      reflected_.update(reflected, iterations);
    }
  }

  std::optional<std::uint64_t> due_pilot() const { return directions_->due_pilot(); }
  void begin_pilot() { directions_->begin_pilot(); }

  /// Looks up the guiding cell of `v`, on the side of v.wp.
  void on_hit(Vertex& v) const {
    const bool looked_up = !idle_ && v.bsdf->connectible();
    v.guiding_cell = looked_up ? directions_->cell(v.surface, v.wp) : GuidingCell{};
  }

  std::optional<BsdfSample> sample(const Vertex& v, Rng& rng, Transport transport) const {
    const float c = v.guiding_cell.probability;
    if (transport != guided_ || c == 0) return bsdf_.sample(v, rng, transport);
    // One point chooses and places, so that the points of both stay evenly spread.
    Rng::FinePoint u = fine_point(rng);
    if (choose(u.x, double(c))) {
      const std::optional<V3f> w =
          directions_->sample({v.surface, *v.bsdf, v.wp, v.guiding_cell}, u, rng);
      if (!w) return std::nullopt;
      const Rgb f = v.bsdf->eval(v.wp, *w, transport);
      // A direction below the surface scatters nothing; it counts as a failed sample.
      if (is_black(f)) return std::nullopt;
      const Pdf<SolidAngle> bsdf = bsdf_.pdf(v, v.wp, *w, transport);
      const Pdf<SolidAngle> p = mixed(v, v.wp, v.guiding_cell, *w, bsdf);
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
    const Pdf<SolidAngle> p = mixed(v, v.wp, v.guiding_cell, s->wi, s->pdf);
    s->pdf_ratio = p / s->pdf;
    s->weight /= s->pdf_ratio;
    s->pdf = p;
    return s;
  }

  /// Density of `wi` for a walk of the given transport that arrived at `v` from `wo`.
  Pdf<SolidAngle> pdf(const Vertex& v, const V3f& wo, const V3f& wi, Transport transport) const {
    const Pdf<SolidAngle> bsdf = bsdf_.pdf(v, wo, wi, transport);
    if (transport != guided_ || idle_) return bsdf;
    const bool this_side = (dot(wo, v.surface.ng) < 0) == (dot(v.wp, v.surface.ng) < 0);
    return mixed(v, wo, this_side ? v.guiding_cell : directions_->cell(v.surface, wo), wi, bsdf);
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
  Pdf<SolidAngle> mixed(const Vertex& v, const V3f& wo, const GuidingCell& cell, const V3f& wi,
                        Pdf<SolidAngle> bsdf) const {
    const float c = cell.probability;
    if (c == 0) return bsdf;
    return c * directions_->pdf({v.surface, *v.bsdf, wo, cell}, wi) + (1 - c) * bsdf;
  }

  std::unique_ptr<GuidingDistribution> directions_;
  Transport guided_;
  ReflectedRadiance reflected_;
  BsdfGuide bsdf_;
  bool idle_ = false;
};
static_assert(Guide<MixedGuide>);

}  // namespace lacuna
