#pragma once

#include "analysis/skeleton/surface_lookup.h"
#include "renderer/guides/cell_forest.h"
#include "renderer/guides/learned_cells.h"
#include "renderer/guides/lobe_set.h"
#include "renderer/guides/tuning.h"
#include "renderer/settings/guide_settings.h"

namespace lacuna {

/// guide: learned_skeleton. Directions are learned in cells of the empty space: its regions, which
/// walls and narrow passages bound, divided further by place and normal where paths are many
/// (CellForest). Each cell chooses, by the second moment of what its paths give, between the lobes
/// of the skeleton's nodes (SkeletonDirections), lobes fitted to the light that was found up to the
/// last round (AimedLobes), and the BSDF alone. Before anything is learned, the skeleton's are
/// sampled.
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
    if (const auto at = lookup_->prefetch(V3d(s.x), V3d(s.ng), V3d(w))) {
      __builtin_prefetch(&(*node_map_)[*at]);
    }
  }
  std::optional<V3f> sample(const GuidedVertex& at, Rng::FinePoint u, Rng&) const override;
  Pdf<SolidAngle> pdf(const GuidedVertex& at, const V3f& w) const override;

  bool idle() const override { return tuning_.idle(); }
  std::optional<std::uint64_t> due_pilot() const override { return tuning_.due_pilot(); }
  void begin_pilot() override { tuning_.begin_pilot(); }
  bool learns() const override { return true; }
  std::unique_ptr<Accumulator> accumulator() const override;
  void accumulate(const GuidingSample& sample, Accumulator& accumulator) const override;
  void record_noise(double variance, double by_bsdf, Accumulator& accumulator) const override;
  void update(std::span<const std::unique_ptr<Accumulator>> accumulators, const ThreadPool& pool,
              double iterations) override;

 private:
  using Cells = LearnedCells<AimedLobes>;
  struct SampleAccumulator;

  /// What a cell samples: the skeleton's lobes with one of the strengths, or the learned ones,
  /// which come last.
  static std::vector<float> distributions();
  bool samples_learned(std::uint32_t cell) const;
  Tuning new_tuning(std::size_t cells) const;
  CellForest::Key key(std::uint32_t region, const V3f& x, const V3f& n) const;

  LearnedSkeletonGuideSettings settings_;
  GridTransform transform_;
  const Grid3<std::uint32_t>*label_ = nullptr, *node_map_ = nullptr;
  std::optional<SurfaceLookup> lookup_;  // of label_
  std::vector<double> scale_;   // of each region: 1 / the radius of its largest ball in scene units
  std::vector<LobeSet> lobes_;  // of each node
  CellForest forest_;
  std::vector<std::uint32_t> region_;        // of each cell
  std::vector<CellForest::Spread> spreads_;  // of each cell, in this round
  Cells cells_;
  Tuning tuning_;  // of each cell
};

}  // namespace lacuna
