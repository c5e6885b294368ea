#pragma once

#include <atomic>

#include "renderer/many_lights/cube_culling.h"
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
/// that are not culled are sampled at equal steps from a random start (systematic sampling). With
/// `interleave`, neighbouring pixels take different blocks, and without culling they share out the
/// lights; the pattern moves at random from iteration to iteration.
class VplSampler {
 public:
  /// The references must outlive this. The lights are divided into about `most_stretches`
  /// stretches. `cubes`: culls in place of the stretches' bounds; null: none.
  VplSampler(const VplContributions& terms, const RandomLightsSettings& settings,
             const CubeCulling* cubes = nullptr, std::size_t most_stretches = 1024);

  /// The lights of one block sampled for one shading point.
  struct Sample {
    std::size_t block;
    std::size_t point;     ///< index of the shading point
    std::uint64_t lights;  ///< mask
    float weight;          ///< 1 / probability
    auto operator<=>(const Sample&) const = default;
  };
  /// Samples lights for at most Lanes::size `points`; the result is sorted by block, then by point.
  /// Counts pairs for culled(). Thread-safe.
  std::vector<Sample> sample(std::span<const ShadingPoint> points, const IterationContext& context);

  /// Fraction of all pairs of a point and a light that sample() has culled so far.
  double culled() const;
  /// Number of tests of a group of lights, for a point or for a cube.
  std::uint64_t tests() const { return tests_; }

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
  /// Numbers sampled below `total`, which is not 0 if `count` is not: `count` of them, at equal
  /// steps.
  struct Steps {
    double first, step;
    std::uint64_t count, total;
    std::uint64_t number(std::uint64_t k) const {
      return std::min(static_cast<std::uint64_t>(first + static_cast<double>(k) * step), total - 1);
    }
    float weight() const { return static_cast<float>(step); }
  };
  Steps steps(std::uint64_t total, std::uint32_t pixel, const IterationContext& context) const;
  /// Samples lights of the given stretches for a point; returns the number of their lights.
  std::uint64_t sample_for(const ShadingPoint& at, std::size_t point,
                           std::span<const std::size_t> stretches, const IterationContext& context,
                           std::vector<Sample>& samples) const;
  /// The same of whole blocks, those of the pixel's offset in its pattern.
  std::uint64_t sample_blocks(const ShadingPoint& at, std::size_t point,
                              std::span<const std::size_t> stretches,
                              const IterationContext& context, std::vector<Sample>& samples) const;
  /// The same of the lights that the cube of the point keeps.
  std::uint64_t sample_in_cube(const ShadingPoint& at, std::size_t point,
                               const IterationContext& context, std::vector<Sample>& samples) const;
  /// Adds light `i` of a block, unless it is beyond the cutoff. `own`: the point's first sample.
  void add(const ShadingPoint& at, Sample sample, int i, std::size_t own,
           std::vector<Sample>& samples) const;
  std::uint64_t lights_of(std::size_t stretch) const {
    return before_[stretches_[stretch].end] - before_[stretches_[stretch].first];
  }

  const VplContributions& terms_;
  RandomLightsSettings settings_;
  const CubeCulling* cubes_;
  std::vector<Stretch> stretches_;
  std::vector<std::uint64_t> before_;  // number of lights before each block, and of all lights
  std::atomic<std::uint64_t> pairs_ = 0, left_ = 0, tests_ = 0;
};

}  // namespace lacuna
