#pragma once

#include "analysis/skeleton/surface_lookup.h"
#include "renderer/guides/guiding_distribution.h"
#include "renderer/guides/lobe_set.h"
#include "renderer/settings/light_guide_settings.h"

namespace lacuna {

/// light_guide: skeleton. SkeletonDirections with both ends exchanged: at the surfaces of a node,
/// the directions of light paths are sampled from lobes on the shortest paths to what the eye sees.
/// The thesis leaves it open (Noel 2015, 9.1).
class SkeletonToEye final : public GuidingDistribution {
 public:
  explicit SkeletonToEye(const SkeletonLightGuideSettings& settings) : settings_(settings) {}

  bool needs_space() const override { return true; }
  void prepare(const PrepareContext& context) override;
  std::vector<std::pair<std::string, double>> statistics() const override;

  GuidingCell cell(const Surface& s, const V3f& w) const override {
    const std::uint32_t node = lookup_->node(V3d(s.x), V3d(s.ng), V3d(w));
    if (node == no_node || lobes_[node].empty()) return {};
    return {static_cast<float>(settings_.probability), node};
  }
  std::optional<V3f> sample(const GuidedVertex& at, Rng::FinePoint u, Rng&) const override {
    return lobes_[at.cell.index].sample(at.x(), strength(), u);
  }
  Pdf<SolidAngle> pdf(const GuidedVertex& at, const V3f& w) const override {
    return lobes_[at.cell.index].pdf(at.x(), w, strength());
  }

 private:
  float strength() const { return static_cast<float>(settings_.strength); }

  SkeletonLightGuideSettings settings_;
  std::optional<SurfaceLookup> lookup_;
  std::vector<LobeSet> lobes_;  // of each node
  std::size_t seen_nodes_ = 0;
};

}  // namespace lacuna
