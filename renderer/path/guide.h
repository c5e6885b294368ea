#pragma once

#include <memory>

#include "renderer/emitters/emitter_set.h"
#include "renderer/path/guiding_distribution.h"
#include "renderer/path/learned_probability.h"
#include "renderer/path/reflected_radiance.h"
#include "renderer/settings/departures.h"

namespace lacuna {

/// Samples the next direction of a path, and evaluates the density of any direction: one-sample MIS
/// of a GuidingDistribution and the BSDF (Noel 2015, 9.4). A direction is sampled from the
/// distribution with probability c of its guiding cell, else from the BSDF; its density is
///
///     p = c p_guide + (1 - c) p_bsdf,
///
/// which makes the weight the balance heuristic. c is a setting or LearnedProbability, at most .9;
/// the biased setting `guide_only` makes it 1, and the directions that the distribution does not
/// cover are then never sampled. Delta lobes are sampled by the BSDF alone.
///
/// Eye paths and light paths have one distribution each; without one, they sample the BSDF. pdf()
/// takes the transport, so each walk can evaluate the densities of the other. Only the distribution
/// of eye paths learns. The first edge of a light path is guided too, except from emitters without
/// area and from those that emit on both sides.
class Guide {
 public:
  /// Either distribution may be null: those paths follow the BSDF. `roulette`: of eye paths.
  explicit Guide(std::unique_ptr<GuidingDistribution> eye = nullptr,
                 std::unique_ptr<GuidingDistribution> light = nullptr,
                 GuidedRoulette roulette = GuidedRoulette::window);

  bool needs_space() const {
    return (eye_ && eye_->needs_space()) || (light_ && light_->needs_space());
  }
  void prepare(const PrepareContext& context);
  /// The learned state.
  void save(ByteWriter& out) const;
  /// Throws std::runtime_error for the state of another scene.
  void load(ByteReader& in);
  std::vector<std::pair<std::string, double>> statistics() const;

  /// Whether paths of this transport have a distribution.
  bool guides(Transport transport) const { return of(transport) != nullptr; }
  /// Whether such paths are kept in a window of their expected contribution (Roulette).
  bool windows(Transport transport) const {
    return guides(transport) && (transport == Transport::importance || windows_);
  }

  /// Whether update() needs training samples of the coming iteration.
  bool learns() const {
    return eye_ && (eye_->learns() || !fixed_probability_ || (windows_ && reflected_.learns()));
  }
  /// Call before each iteration: GuidingDistribution::begin().
  Counters begin(const IterationContext& context, int edges) {
    return eye_ ? eye_->begin(context, edges) : Counters{};
  }
  /// Whether the paths of the block of 8 x 8 pixels around `pixel` record training samples in this
  /// iteration. False if the guide does not learn. In a large picture only a fraction of the blocks
  /// does, so that an iteration records about most_samples. `edges`: the maximum of a path.
  bool learns_from(const V2i& pixel, const IterationContext& context, int edges) const;
  static constexpr double most_samples = 1 << 20;  ///< 72 MiB
  /// The first pass of an iteration. Call update() after each pass.
  LearningPass first_pass() const { return LearningPass::begin(learns() && share_ == 0); }
  /// Learns from the samples of `pass`: one part for each tile, in their order.
  void update(std::span<const TrainingSamples::Part> parts, const LearningPass& pass,
              const IterationContext& context, int edges);

  /// The luminance that an eye path is expected to gather at vertices after the connectible vertex
  /// `v`, over the luminance of its throughput at `v`; below 0 while nothing has been learned.
  float expected(const Vertex& v) const { return reflected_.at(v); }

  /// Prefetches what on_hit() reads. Requires the surface and wp of `v`.
  void prefetch(const Vertex& v) const {
    if (eye_) eye_->prefetch(v.surface, v.wp);
  }
  /// Looks up the guiding cell of `v` for eye paths, on the side of v.wp. The cell for light paths
  /// is looked up on demand: light paths are seldom guided, and each Vertex would have to store it.
  void on_hit(Vertex& v) const {
    if (eye_) v.guiding_cell = cell_at(v, v.wp, Transport::radiance);
  }

  /// Samples a direction, with its weight f |cos| / p and its density; none if the sample fails.
  std::optional<BsdfSample> sample(const Vertex& v, Rng& rng, Transport transport) const {
    if (of(transport) == nullptr) return sample_bsdf(v, rng, transport);
    return sample_mixture(v, rng, transport);
  }
  /// Density with which sample() returns unit `wi`, for a walk of the given transport that arrived
  /// at `v` from unit `wo`. MIS weights need it for any `wo`, not only for v.wp. Its integral over
  /// the sphere is 1 less the probability of failure. If c < 1, it is above 0 wherever the BSDF's
  /// is.
  Pdf<SolidAngle> pdf(const Vertex& v, const V3f& wo, const V3f& wi, Transport transport) const {
    return pdf(v, wo, wi, transport, v.bsdf->pdf(wo, wi, transport));
  }
  /// The same, given the density of `wi` by the BSDF.
  Pdf<SolidAngle> pdf(const Vertex& v, const V3f& wo, const V3f& wi, Transport transport,
                      Pdf<SolidAngle> bsdf) const {
    if (of(transport) == nullptr) return bsdf;
    return mixed({v.surface, *v.bsdf, wo, cell_of(v, wo, transport)}, wi, transport, bsdf);
  }

  /// Samples the first edge of a light path from the point `e` on one of `lights`. A guided emitter
  /// is treated as a white Lambertian surface that light reaches along its normal: its radiance
  /// times |cos| is pi times what that surface scatters.
  std::optional<LightLeSample> sample_Le(const EmitterSet& lights, const EmitterPoint& e,
                                         Rng& rng) const;
  /// Density of unit `w` in sample_Le() from `e`; in the measure of EmitterPoint::pdf_Le().
  Pdf<SolidAngle> pdf_Le(const EmitterPoint& e, const V3f& w) const;

 private:
  /// The distribution of paths of this transport; null: they follow the BSDF.
  const GuidingDistribution* of(Transport transport) const {
    return transport == Transport::importance ? light_.get() : eye_.get();
  }
  double share(const IterationContext& context, int edges) const;
  float probability_of(std::uint32_t cell, Transport transport) const;
  GuidingCell cell_at(const Vertex& v, const V3f& wo, Transport transport) const;
  GuidingCell cell_of(const Vertex& v, const V3f& wo, Transport transport) const;
  Pdf<SolidAngle> mixed(const GuidedVertex& at, const V3f& wi, Transport transport,
                        Pdf<SolidAngle> bsdf) const;
  static std::optional<BsdfSample> sample_bsdf(const Vertex& v, Rng& rng, Transport transport) {
    const auto [u_lobe, u] = rng.next_choice_and_point();
    return v.bsdf->sample(v.wp, u_lobe, u, transport);
  }
  std::optional<BsdfSample> sample_mixture(const Vertex& v, Rng& rng, Transport transport) const;

  bool guides(const EmitterPoint& e) const {
    return light_ && e.kind == EmitterPoint::Kind::area && !e.both_sides;
  }
  void make_white(const EmitterPoint& e, Vertex& v) const;

  std::unique_ptr<GuidingDistribution> eye_, light_;
  std::optional<double> fixed_probability_, fixed_light_probability_;
  LearnedProbability probability_;  // of eye_, unless it is fixed
  bool windows_;                    // of eye paths
  ReflectedRadiance reflected_;     // for the window
  double share_ = 0;  // one block of `share_` records samples; 0: no iteration has ended yet
  Lobes white_{SurfaceParams{.f0 = Rgb(0, 0, 0), .f90 = 0}};
};

}  // namespace lacuna
