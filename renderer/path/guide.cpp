#include "renderer/path/guide.h"

#include <algorithm>
#include <cmath>

namespace lacuna {

namespace {

/// A FinePoint from three random numbers, as many as sampling the BSDF takes, so that later numbers
/// keep their dimensions in a low-discrepancy sequence. The low 32 bits of `x` are those of
/// `u_select`, scrambled.
Rng::FinePoint fine_point(Rng& rng) {
  const auto [choice, point] = rng.next_choice_and_point();
  const auto bits = static_cast<std::uint64_t>(choice * 0x1p48);
  const auto whole = [](float unit, std::uint64_t rest) {
    return static_cast<std::uint32_t>(unit * 0x1p24F) << 8 |
           static_cast<std::uint32_t>(rest & 0xff);
  };
  const auto u_select = static_cast<std::uint32_t>(bits >> 16);
  const std::uint32_t low = u_select * 0x9e3779b9U;
  return {std::uint64_t{whole(point.x, bits >> 8)} << 32 | low, whole(point.y, bits), u_select};
}

/// True with probability `c`, by `u`, uniform of 2^64. Afterwards `u` is rescaled to be uniform.
bool choose(std::uint64_t& u, double c) {
  const double at = static_cast<double>(u) * 0x1p-64;
  const bool chosen = at < c || c >= 1;
  const double left = chosen ? at / c : (at - c) / (1 - c);
  u = static_cast<std::uint64_t>(std::min(left, 1 - 0x1p-53) * 0x1p64);
  return chosen;
}

}  // namespace

Guide::Guide(std::unique_ptr<GuidingDistribution> eye, std::unique_ptr<GuidingDistribution> light,
             GuidedRoulette roulette)
    : eye_(std::move(eye)), light_(std::move(light)), windows_(roulette == GuidedRoulette::window) {
  if (eye_) fixed_probability_ = eye_->probability().value;
  if (light_) fixed_light_probability_ = light_->probability().value;
}

void Guide::prepare(const PrepareContext& context) {
  if (eye_) {
    const Bounds& box = context.scene.bounds();
    reflected_ = ReflectedRadiance(box.low, box.size());
    eye_->prepare(context);
    if (!fixed_probability_) probability_ = LearnedProbability(eye_->cells());
  }
  if (light_) light_->prepare(context);
}

void Guide::save(ByteWriter& out) const {
  if (!eye_) return;
  eye_->save(out);
  probability_.save(out);
  reflected_.save(out);
  out.put(share_);
}

void Guide::load(ByteReader& in) {
  if (!eye_) return;
  eye_->load(in);
  probability_.load(in, fixed_probability_ ? 0 : eye_->cells());
  reflected_.load(in);
  share_ = in.get<double>();
  if (!(share_ >= 0)) throw std::runtime_error("saved share of training samples is not valid");
}

std::vector<std::pair<std::string, double>> Guide::statistics() const {
  std::vector<std::pair<std::string, double>> all;
  if (eye_) {
    all = eye_->statistics();
    all.emplace_back("mean_probability", fixed_probability_.value_or(probability_.mean()));
  }
  if (!light_) return all;
  for (const auto& [name, value] : light_->statistics()) {
    all.emplace_back("light_guide_" + name, value);
  }
  return all;
}

/// The number of blocks of which one records training samples in this iteration, >= 1.
double Guide::share(const IterationContext& context, int edges) const {
  if (share_ > 0) return share_;
  const double pixels = double(context.camera.width()) * double(context.camera.height());
  return std::ceil(std::max(1.0, pixels * double(edges) / most_samples));
}

bool Guide::learns_from(const V2i& pixel, const IterationContext& context, int edges) const {
  if (!learns()) return false;
  const auto group = static_cast<std::uint64_t>(pixel.x / 8 + pixel.y / 8);  // diagonal stripes
  const auto apart = static_cast<std::uint64_t>(share(context, edges));
  return (group + context.iteration) % apart == 0;
}

void Guide::update(std::span<const TrainingSamples::Part> parts, const LearningPass& pass,
                   const IterationContext& context, int edges) {
  const WorkSection section(context.pool, "guide");
  const TrainingSamples samples(parts, eye_->cells(), context.pool, pass.share());
  if (pass.end == LearningPass::parts) {
    const double all = double(samples.size()) / pass.share();
    share_ = std::ceil(std::max(1.0, share(context, edges) * all / most_samples));
  }
  if (samples.size() == 0) return;
  if (windows_ && reflected_.learns()) reflected_.update(samples);
  if (!fixed_probability_) probability_.update(samples, context.pool);
  const std::vector<std::uint32_t> origins = eye_->update(samples, context.pool);
  if (!fixed_probability_) probability_.divide(origins);
}

float Guide::probability_of(std::uint32_t cell, Transport transport) const {
  const auto& fixed =
      transport == Transport::radiance ? fixed_probability_ : fixed_light_probability_;
  return fixed ? static_cast<float>(*fixed) : probability_[cell];
}

/// The cell of `v` as seen from `wo`, with the probability of sampling it.
GuidingCell Guide::cell_at(const Vertex& v, const V3f& wo, Transport transport) const {
  if (!v.bsdf->connectible()) return {};
  GuidingCell cell = of(transport)->cell(v.surface, wo);
  if (cell.probability > 0) cell.probability *= probability_of(cell.index, transport);
  return cell;
}

/// The same, from the vertex if it stores the cell of this side.
GuidingCell Guide::cell_of(const Vertex& v, const V3f& wo, Transport transport) const {
  const bool this_side = (dot(wo, v.surface.ng) < 0) == (dot(v.wp, v.surface.ng) < 0);
  if (transport == Transport::radiance && this_side) return v.guiding_cell;
  return cell_at(v, wo, transport);
}

std::optional<BsdfSample> Guide::sample_mixture(const Vertex& v, Rng& rng,
                                                Transport transport) const {
  const GuidingCell cell = cell_of(v, v.wp, transport);
  const float c = cell.probability;
  if (c == 0) return sample_bsdf(v, rng, transport);
  const GuidedVertex at{v.surface, *v.bsdf, v.wp, cell};
  // One point selects the distribution and samples from it, so that both stay stratified.
  Rng::FinePoint u = fine_point(rng);
  if (choose(u.x, double(c))) {
    const std::optional<V3f> w = of(transport)->sample(at, u, rng);
    if (!w) return std::nullopt;
    const Rgb f = v.bsdf->eval(v.wp, *w, transport);
    // A direction below the surface scatters nothing; it counts as a failed sample.
    if (is_black(f)) return std::nullopt;
    const Pdf<SolidAngle> bsdf = v.bsdf->pdf(v.wp, *w, transport);
    const Pdf<SolidAngle> p = mixed(at, *w, transport, bsdf);
    if (!p.positive()) return std::nullopt;
    const bool transmitted = dot(*w, v.surface.ng) * dot(v.wp, v.surface.ng) < 0;
    const float pdf_ratio = bsdf.positive() ? p / bsdf : 1;
    return BsdfSample{*w, f / p.value, p, false, transmitted, pdf_ratio};
  }
  std::optional<BsdfSample> s =
      v.bsdf->sample(v.wp, double(u.u_select) * 0x1p-32, u.point(), transport);
  if (!s) return s;
  if (s->delta) {
    s->weight /= 1 - c;
    s->pdf_ratio = 1 - c;
    return s;
  }
  const Pdf<SolidAngle> p = mixed(at, s->wi, transport, s->pdf);
  s->pdf_ratio = p / s->pdf;
  s->weight /= s->pdf_ratio;
  s->pdf = p;
  return s;
}

Pdf<SolidAngle> Guide::mixed(const GuidedVertex& at, const V3f& wi, Transport transport,
                             Pdf<SolidAngle> bsdf) const {
  const float c = at.cell.probability;
  if (c == 0) return bsdf;
  return c * of(transport)->pdf(at, wi) + (1 - c) * bsdf;
}

std::optional<LightLeSample> Guide::sample_Le(const EmitterSet& lights, const EmitterPoint& e,
                                              Rng& rng) const {
  if (!guides(e)) return lights.sample_Le(e, rng);
  Vertex v;
  make_white(e, v);
  const std::optional<BsdfSample> s = sample(v, rng, Transport::importance);
  if (!s || !e.pdf.positive()) return std::nullopt;
  const Rgb emitted = e.towards(s->wi);
  if (is_black(emitted)) return std::nullopt;
  return LightLeSample{{offset_origin(e.x, e.ng, e.offset, s->wi), s->wi},
                       s->pdf,
                       emitted * s->weight * (pi / e.pdf.value)};
}

Pdf<SolidAngle> Guide::pdf_Le(const EmitterPoint& e, const V3f& w) const {
  if (!guides(e)) return e.pdf_Le(w);
  Vertex v;
  make_white(e, v);
  return pdf(v, e.ng, w, Transport::importance);
}

void Guide::make_white(const EmitterPoint& e, Vertex& v) const {
  v.kind = Vertex::Kind::surface;
  v.surface.x = e.x;
  v.surface.ng = v.surface.ns = v.wp = e.ng;
  v.surface.offset = e.offset;
  v.bsdf.emplace(white_, e.ng, e.ng);
}

}  // namespace lacuna
