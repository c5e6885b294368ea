#pragma once

#include "renderer/guides/learned_cells.h"
#include "renderer/path/guiding_distribution.h"
#include "renderer/settings/guide_settings.h"

namespace lacuna {

/// guide: sd_tree. Practical path guiding (Mueller, Gross and Novak 2017): a binary tree over the
/// scene's box; each leaf has a quadtree of directions with the light that paths gathered. It is
/// trained in rounds of 1, 2, 4, ... iterations: after each round, leaves with many vertices are
/// split, and the next round samples the directions of the previous one. Of the improvements of
/// Mueller 2019 it has the box filter over directions. All iterations, including the first, have
/// equal weight in the picture: the film is the mean of independent estimates.
class SdTree final : public GuidingDistribution {
 public:
  explicit SdTree(const SdTreeGuideSettings& settings) : settings_(settings) {}

  bool needs_space() const override { return false; }
  void prepare(const PrepareContext& context) override;
  void save(ByteWriter& out) const override;
  void load(ByteReader& in) override;
  std::vector<std::pair<std::string, double>> statistics() const override;

  GuidingCell cell(const Surface& s, const V3f&) const override {
    const std::uint32_t leaf = leaf_at(s.x);
    return {leaves_.directions(leaf).empty() ? 0.0F : 1.0F, leaf};
  }
  std::optional<V3f> sample(const GuidedVertex& at, Rng::FinePoint u, Rng&) const override {
    return leaves_.directions(at.cell.index).sample(u);
  }
  Pdf<SolidAngle> pdf(const GuidedVertex& at, const V3f& w) const override {
    return leaves_.directions(at.cell.index).pdf(w);
  }

  std::size_t cells() const override { return leaves_.size(); }
  AutoNumber probability() const override { return settings_.probability; }
  bool learns() const override { return true; }
  std::vector<std::uint32_t> update(const TrainingSamples& samples,
                                    const ThreadPool& pool) override;

 private:
  struct Node {
    std::array<std::uint32_t, 2> child{};  // 0: a leaf
    std::uint32_t leaf = 0;
  };
  using Leaves = LearnedCells<DirectionTree>;
  std::uint32_t leaf_at(const V3f& x) const;
  void divide(std::uint32_t node, int depth, double most, std::vector<std::uint32_t>& origins);

  SdTreeGuideSettings settings_;
  V3d low_{0.0};
  double side_ = 1;  // of the cube around the scene, scene units
  std::vector<Node> nodes_;
  Leaves leaves_;
};

}  // namespace lacuna
