#pragma once

#include "renderer/visibility/cached_visibility.h"
#include "renderer/visibility/guess_reliability.h"
#include "renderer/visibility/skeleton_node.h"
#include "renderer/visibility/test_probability.h"
#include "renderer/visibility/visibility_guess.h"

namespace lacuna {

/// visibility: probabilistic. With q the guessed visibility of a light, the estimate is q with
/// probability p, without a shadow ray, and (v - p q) / (1 - p) with probability 1 - p, where v is
/// the result of the shadow ray. Its mean is v for any q and p (Nabata et al., eq. 6). p is large
/// where the guess is reliable.
class ProbabilisticVisibility : public VisibilityBase {
 public:
  explicit ProbabilisticVisibility(const ProbabilisticVisibilitySettings& settings)
      : ProbabilisticVisibility(settings, guess_sources(settings)) {}
  ProbabilisticVisibility(const ProbabilisticVisibilitySettings& settings,
                          std::vector<std::unique_ptr<GuessSource>> sources);

  bool needs_space() const;
  void prepare(const PrepareContext& context);
  void save(ByteWriter& out) const {
    if (learns()) reliability_.save(out);
  }
  void load(ByteReader& in) {
    if (learns()) reliability_.load(in);
  }
  std::uint64_t groups() const;
  LightGroup group(const VplGeometry& light) const;
  std::vector<BlockRange> passes(const VplSet& lights) const;
  Counters begin(const LightPass& pass);
  void end() { reliability_.update(); }
  struct Tile;
  struct At {
    TestProbability chance;
    Rng rng;
    std::uint32_t cell;                    // of the point
    std::shared_ptr<Tile> tile = nullptr;  // set by share()
    std::uint32_t point = 0, place = 0;    // in the tile: the point, and its cell
  };
  At at(const ShadingPoint& point, const IterationContext& context) const;
  static std::uint32_t cell(const At& at) { return at.cell; }
  std::uint32_t cell(const VplGeometry& light) const {
    return clusters_ ? std::min(clusters_->of(light), clusters_->count()) : 0;
  }
  std::uint32_t cells() const { return static_cast<std::uint32_t>(cells_); }
  float rate(std::uint32_t cell, std::size_t block) const {
    return learns() ? reliability_.rate(pair(cell, block)) : 1;
  }
  void share(std::span<const ShadingPoint> points, std::span<At> states,
             const IterationContext& context) const;
  void decide(At& at, std::size_t block, const Terms& terms, VisibilityEstimate& d) const;
  struct Tested {
    std::uint32_t tally = 0;   // in the tile
    std::uint32_t weight = 0;  // GuessReliability::Tally::weights
  };
  static Tested tested(const At& at, int light);
  static void seen(At& at, Tested test);
  bool clamps_negative() const { return settings_.clamp_negative; }
  std::vector<std::pair<std::string, double>> statistics() const;

 private:
  bool learns() const { return settings_.learned_rates(); }
  std::size_t pair(std::uint32_t point_cell, std::size_t block) const {
    return std::size_t{point_cell} * cells_ + block_cells_[block];
  }

  ProbabilisticVisibilitySettings settings_;
  std::vector<std::unique_ptr<GuessSource>> sources_;
  CachePoints own_points_;                 // unless the guess has some
  const CachePoints* points_ = nullptr;    // measure the variance of contributions
  std::optional<ClusterLookup> clusters_;  // null: one cell
  std::size_t cells_ = 1;                  // of points, and of lights
  std::vector<std::uint32_t> block_cells_;
  mutable GuessReliability reliability_;  // tiles add their tests
  float other_rays_ = 0;
};

}  // namespace lacuna
