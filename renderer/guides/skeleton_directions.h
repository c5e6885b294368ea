#pragma once

#include "analysis/skeleton/surface_lookup.h"
#include "renderer/guides/lobe_set.h"
#include "renderer/guides/tuning.h"
#include "renderer/settings/guide_settings.h"

namespace lacuna {

/// guide: skeleton. At the surfaces of a skeleton node, directions are sampled from lobes around
/// its importance points, which lie on the visible parts of the shortest paths to where light
/// arrives (Noel 2015, ch. 9). Uses the thesis' unfiltered skeleton.
class SkeletonDirections final : public GuidingDistribution {
 public:
  explicit SkeletonDirections(const SkeletonGuideSettings& settings) : settings_(settings) {}

  bool needs_space() const override { return true; }
  void prepare(const PrepareContext& context) override;
  void save(ByteWriter& out) const override { tuning_.save(out); }
  void load(ByteReader& in) override { tuning_.load(in); }
  std::vector<std::pair<std::string, double>> statistics() const override;

  GuidingCell cell(const Surface& s, const V3f& w) const override {
    const std::uint32_t node = lookup_->node(V3d(s.x), V3d(s.ng), V3d(w));
    if (node == no_node || lobes_[node].empty()) return {};
    return {tuning_.probability(node), node};
  }
  void prefetch(const Surface& s, const V3f& w) const override {
    lookup_->prefetch(V3d(s.x), V3d(s.ng), V3d(w));
  }
  std::optional<V3f> sample(const GuidedVertex& at, Rng::FinePoint u, Rng&) const override {
    return lobes_[at.cell.index].sample(at.x(), tuning_.strength(at.cell.index), u);
  }
  Pdf<SolidAngle> pdf(const GuidedVertex& at, const V3f& w) const override {
    return lobes_[at.cell.index].pdf(at.x(), w, tuning_.strength(at.cell.index));
  }

  bool idle() const override { return tuning_.idle(); }
  std::optional<std::uint64_t> due_pilot() const override { return tuning_.due_pilot(); }
  void begin_pilot() override { tuning_.begin_pilot(); }
  bool learns() const override { return tuning_.learns(); }
  std::unique_ptr<Accumulator> accumulator() const override {
    return std::make_unique<TuningAccumulator>();
  }
  void accumulate(const GuidingSample& sample, Accumulator& accumulator) const override;
  void record_noise(double variance, double by_bsdf, Accumulator& accumulator) const override {
    static_cast<TuningAccumulator&>(accumulator).tuning.noise.add(variance, by_bsdf);
  }
  void update(std::span<const std::unique_ptr<Accumulator>> accumulators, const ThreadPool&,
              double iterations) override {
    std::vector<const Tuning::Accumulator*> own;
    for (const auto& t : accumulators)
      own.push_back(&static_cast<const TuningAccumulator&>(*t).tuning);
    tuning_.update(own, iterations);
    tuning_.stop_if_useless();
  }

 private:
  struct TuningAccumulator final : Accumulator {
    Tuning::Accumulator tuning;
    double bytes() const override { return tuning.bytes(); }
  };

  SkeletonGuideSettings settings_;
  std::optional<SurfaceLookup> lookup_;
  std::vector<LobeSet> lobes_;  // of each node
  Tuning tuning_;
  std::size_t importance_nodes_ = 0;
};

}  // namespace lacuna
