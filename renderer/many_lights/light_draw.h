#pragma once

#include <atomic>

#include "renderer/many_lights/vpl_contributions.h"
#include "renderer/path/contexts.h"
#include "renderer/settings/gather_settings.h"

namespace lacuna {

/// Draws a few of all virtual lights for each shading point (Kol et al. 2018, 5.1), all that may
/// shine on it with one probability. Unbiased: what is drawn counts by its inverse.
///
/// Lights lie in blocks by the way they face and by place, and a stretch of blocks with bounds
/// around it stands for a coarse node of the paper's hierarchy over them. Of the stretches that are
/// left the lights are drawn at equal steps from a random start, so far apart.
class LightDraw {
 public:
  /// `terms` outlives it. About as many stretches as `most_stretches` are made of the lights.
  LightDraw(const VplContributions& terms, const RandomLightsSettings& settings,
            std::size_t most_stretches = 1024);

  /// Lights of a block for a shading point.
  struct Drawn {
    std::size_t block;
    std::size_t point;  ///< its place among those given
    std::uint64_t lights;
    float weight;  ///< that each counts with
  };
  /// For `points`, of which there are at most Lanes::size, by block and then by point.
  std::vector<Drawn> draw(std::span<const ShadingPoint> points,
                          const IterationContext& context) const;

  /// Of all pairs of a point and a light, those that were culled, as a share.
  double culled() const;

 private:
  struct Stretch {
    std::size_t first, end;  // blocks
    bool bounded;            // else anything in it may shine anywhere
    BlockBounds bounds;
  };
  /// Bit i: a light of the stretch may shine on point i.
  std::uint64_t may_shine(const Stretch& s, const PointLanes& points) const;
  bool is_near(const V3f& x, std::size_t block, int i) const;
  float cutoff() const { return static_cast<float>(settings_.cutoff); }
  /// Of the lights of those stretches for the point at x; tells how many they are.
  std::uint64_t draw_for(const V3f& x, std::size_t point, std::span<const std::size_t> stretches,
                         Rng rng, std::vector<Drawn>& drawn) const;
  std::uint64_t lights_of(std::size_t stretch) const {
    return before_[stretches_[stretch].end] - before_[stretches_[stretch].first];
  }

  const VplContributions& terms_;
  RandomLightsSettings settings_;
  std::vector<Stretch> stretches_;
  std::vector<std::uint64_t> before_;  // of each block the lights before it, and of all
  mutable std::atomic<std::uint64_t> pairs_ = 0, left_ = 0;
};

}  // namespace lacuna
