#pragma once

#include "analysis/skeleton/surface_lookup.h"
#include "renderer/guides/cell_forest.h"
#include "renderer/guides/learned_cells.h"
#include "renderer/path/guiding_distribution.h"
#include "renderer/settings/guide_settings.h"

namespace lacuna {

/// guide: learned_skeleton. Directions are learned in cells of the empty space: its regions,
/// bounded by walls and narrow passages, split further by position and normal where vertices are
/// many (CellForest). A cell samples lobes fitted to the light gathered up to the last round
/// (AimedLobes). Initially they are aimed at the importance points of the skeleton node in the
/// middle of the region (Noel 2015, ch. 9).
class LearnedSkeleton final : public GuidingDistribution {
 public:
  explicit LearnedSkeleton(const LearnedSkeletonGuideSettings& settings) : settings_(settings) {}

  bool needs_space() const override { return true; }
  void prepare(const PrepareContext& context) override;
  void save(ByteWriter& out) const override;
  void load(ByteReader& in) override;
  std::vector<std::pair<std::string, double>> statistics() const override;

  GuidingCell cell(const Surface& s, const V3f& w) const override;
  void prefetch(const Surface& s, const V3f& w) const override {
    lookup_->prefetch(V3d(s.x), V3d(s.ng), V3d(w));
  }
  std::optional<V3f> sample(const GuidedVertex& at, Rng::FinePoint u, Rng&) const override {
    return cells_.directions(at.cell.index).sample(at.x(), u);
  }
  Pdf<SolidAngle> pdf(const GuidedVertex& at, const V3f& w) const override {
    return cells_.directions(at.cell.index).pdf(at.x(), w);
  }

  std::size_t cells() const override { return cells_.size(); }
  AutoNumber probability() const override { return settings_.probability; }
  bool learns() const override { return true; }
  std::vector<std::uint32_t> update(const TrainingSamples& samples,
                                    const ThreadPool& pool) override;

 private:
  std::vector<AimedLobes> first_lobes(const PrepareContext& context) const;
  CellForest::Key key(std::uint32_t region, const V3f& x, const V3f& n) const;

  LearnedSkeletonGuideSettings settings_;
  GridTransform transform_;
  const Grid3<std::uint32_t>* label_ = nullptr;
  std::optional<SurfaceLookup> lookup_;  // by label_
  std::vector<double> scale_;  // of each region: 1 / the radius of its largest ball, scene units
  CellForest forest_;
  std::vector<std::uint32_t> region_;        // of each cell
  std::vector<CellForest::Spread> spreads_;  // of each cell, in this round
  LearnedCells<AimedLobes> cells_;
};

}  // namespace lacuna
