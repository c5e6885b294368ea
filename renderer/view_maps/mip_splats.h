#pragma once

#include <algorithm>
#include <limits>
#include <span>
#include <vector>

#include "renderer/view_maps/paraboloid.h"

namespace lacuna {

/// Coarser levels of a dual paraboloid map (Kol et al. 2018, 3.2.4): a texel of level l > 0 is a
/// block of 2^l x 2^l texels of the map. A splat wider than a texel is drawn as one texel of the
/// level whose texels are as wide, and push() hands the distances down to the map. Both test the
/// depth: if only empty texels were filled, far nodes would shine through near ones.
class MipSplats {
 public:
  explicit MipSplats(const Paraboloid& map) : map_(map) {
    for (int side = map.size; side > 1;) {
      side = (side + 1) / 2;
      levels_.push_back({side, std::vector<float>(2 * square(side), nothing)});
    }
  }

  /// Draws a splat at `p`, `width` texels wide, into a coarser level, or at level 0 into `depths`.
  void splat(const Paraboloid::TexelCoord& p, float width, float distance,
             std::span<float> depths) {
    std::size_t level = 0;
    while (level < levels_.size() && static_cast<float>(1 << level) < width) ++level;
    const int texel = map_.texel(p);
    if (level == 0) return nearer(depths[static_cast<std::size_t>(texel)], distance);
    Level& to = levels_[level - 1];
    const int u = texel % map_.size >> level, v = texel / map_.size % map_.size >> level;
    nearer(to.depths[at(to.side, p.half, u, v)], distance);
    ++drawn_;
  }

  /// Hands all splats down to `depths` and clears the levels. Returns the number of texels read.
  std::size_t push(std::span<float> depths) {
    if (drawn_ == 0) return 0;
    drawn_ = 0;
    std::size_t read = 0;
    for (std::size_t l = levels_.size(); l-- > 0;) {
      Level& from = levels_[l];
      const int side = l > 0 ? levels_[l - 1].side : map_.size;
      const std::span<float> to = l > 0 ? std::span<float>(levels_[l - 1].depths) : depths;
      for (int row = 0; row < 2 * side; ++row) {
        const int half = row / side, v = row % side;
        for (int u = 0; u < side; ++u) {
          nearer(to[at(side, half, u, v)], from.depths[at(from.side, half, u / 2, v / 2)]);
        }
      }
      read += 2 * square(side);
      std::fill(from.depths.begin(), from.depths.end(), nothing);
    }
    return read;
  }

 private:
  struct Level {
    int side;  ///< of each half
    std::vector<float> depths;
  };
  static constexpr float nothing = std::numeric_limits<float>::infinity();
  static std::size_t square(int side) { return std::size_t(side) * std::size_t(side); }
  static std::size_t at(int side, int half, int u, int v) {
    return static_cast<std::size_t>((half * side + v) * side + u);
  }
  static void nearer(float& depth, float distance) { depth = std::min(depth, distance); }

  Paraboloid map_;
  std::vector<Level> levels_;  // from the finest, of half the map's resolution
  std::size_t drawn_ = 0;
};

}  // namespace lacuna
