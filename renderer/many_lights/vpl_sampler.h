#pragma once

#include <atomic>

#include "renderer/many_lights/vpl_contributions.h"
#include "renderer/path/contexts.h"
#include "renderer/settings/gather_settings.h"

namespace lacuna {

/// Samples a few virtual lights for each shading point (Kol et al. 2018, 5.1). All lights that may
/// illuminate the point have equal probability; contributions are divided by it, so the estimate is
/// unbiased.
///
/// Blocks contain lights of similar position and normal. A stretch of consecutive blocks with
/// common bounds corresponds to a coarse node in the paper's hierarchy. The lights of the stretches
/// that are not culled are sampled at equal steps from a random start (systematic sampling).
class VplSampler {
 public:
  /// `terms` must outlive this. The lights are divided into about `most_stretches` stretches.
  VplSampler(const VplContributions& terms, const RandomLightsSettings& settings,
             std::size_t most_stretches = 1024);

  /// The lights of one block sampled for one shading point.
  struct Sample {
    std::size_t block;
    std::size_t point;     ///< index of the shading point
    std::uint64_t lights;  ///< mask
    float weight;          ///< 1 / probability
  };
  /// Samples lights for at most Lanes::size `points`; the result is sorted by block, then by point.
  /// Counts pairs for culled(). Thread-safe.
  std::vector<Sample> sample(std::span<const ShadingPoint> points, const IterationContext& context);

  /// Fraction of all pairs of a point and a light that sample() has culled so far.
  double culled() const;

 private:
  struct Stretch {
    std::size_t first, end;  // blocks
    bool bounded;            // false: its lights may illuminate any point
    BlockBounds bounds;
  };
  /// A mask: bit i is set if a light of the stretch may illuminate point i.
  std::uint64_t may_illuminate(const Stretch& s, const PointLanes& points) const;
  bool is_near(const V3f& x, std::size_t block, int i) const;
  float cutoff() const { return static_cast<float>(settings_.cutoff); }
  /// Samples lights of the given stretches for the point at x; returns the number of their lights.
  std::uint64_t sample_for(const V3f& x, std::size_t point, std::span<const std::size_t> stretches,
                           Rng rng, std::vector<Sample>& samples) const;
  std::uint64_t lights_of(std::size_t stretch) const {
    return before_[stretches_[stretch].end] - before_[stretches_[stretch].first];
  }

  const VplContributions& terms_;
  RandomLightsSettings settings_;
  std::vector<Stretch> stretches_;
  std::vector<std::uint64_t> before_;  // number of lights before each block, and of all lights
  std::atomic<std::uint64_t> pairs_ = 0, left_ = 0;
};

}  // namespace lacuna
