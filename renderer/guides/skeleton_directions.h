#pragma once

#include <array>

#include "analysis/skeleton/surface_lookup.h"
#include "renderer/guides/lobe_set.h"
#include "renderer/path/guiding_distribution.h"
#include "renderer/settings/guide_settings.h"
#include "renderer/settings/light_guide_settings.h"

namespace lacuna {

/// guide: skeleton, and light_guide: skeleton. At the surfaces of a skeleton node, directions are
/// sampled from lobes around its importance points, which lie on the visible parts of the shortest
/// paths to nodes where light arrives, or, for light paths, to nodes visible from the eye (Noel
/// 2015, ch. 9; 9.1 leaves the latter open). Uses the thesis' unfiltered skeleton.
///
/// If the strength of the lobes is learned (9.6), each node has a mixture of strengths, whose
/// weights are fitted by expectation maximisation to the light that its paths gathered.
class SkeletonDirections final : public GuidingDistribution {
 public:
  explicit SkeletonDirections(const SkeletonGuideSettings& settings)
      : strength_(settings.strength),
        probability_(settings.probability),
        aim_(settings.aim),
        rays_(settings.light_rays) {}
  explicit SkeletonDirections(const SkeletonLightGuideSettings& settings)
      : strength_{settings.strength},
        probability_{settings.probability},
        aim_(settings.aim),
        rays_(settings.eye_rays),
        to_eye_(true) {}

  bool needs_space() const override { return true; }
  void prepare(const PrepareContext& context) override;
  void save(ByteWriter& out) const override { out.put(light_); }
  void load(ByteReader& in) override;
  std::vector<std::pair<std::string, double>> statistics() const override;

  GuidingCell cell(const Surface& s, const V3f& w) const override {
    const std::uint32_t node = lookup_->node(V3d(s.x), V3d(s.ng), V3d(w));
    if (node == no_node || lobes_[node].empty()) return {};
    return {1, node};
  }
  void prefetch(const Surface& s, const V3f& w) const override {
    lookup_->prefetch(V3d(s.x), V3d(s.ng), V3d(w));
  }
  std::optional<V3f> sample(const GuidedVertex& at, Rng::FinePoint u, Rng&) const override;
  Pdf<SolidAngle> pdf(const GuidedVertex& at, const V3f& w) const override;

  std::size_t cells() const override { return lobes_.size(); }
  AutoNumber probability() const override { return probability_; }
  bool learns() const override { return strength_.is_auto(); }
  std::vector<std::uint32_t> update(const TrainingSamples& samples,
                                    const ThreadPool& pool) override;

 private:
  /// A value for each strength LobeSet::power(k).
  using Strengths = std::array<double, LobeSet::doublings>;
  using Densities = std::array<float, LobeSet::doublings>;
  /// The normalised mixture weights of a node's strengths.
  static Strengths weights(const Strengths& light);
  /// The density of a mixture, from the densities of its strengths.
  static double mixture(const Strengths& weights, const Densities& densities);
  float fixed() const { return static_cast<float>(*strength_.value); }

  AutoNumber strength_, probability_;
  ImportanceAim aim_;
  int rays_;
  bool to_eye_ = false;
  std::optional<SurfaceLookup> lookup_;
  std::vector<LobeSet> lobes_;  // of each node
  std::vector<Strengths> light_,
      weights_;  // of each node: the light gathered so far, and the weights from it
  std::size_t importance_nodes_ = 0;
};

}  // namespace lacuna
