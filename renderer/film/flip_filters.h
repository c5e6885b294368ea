#pragma once

#include <numbers>
#include <vector>

namespace lacuna {

/// Pixels a degree of FLIP's default observer (Andersson et al. 2020, section 4).
inline constexpr double flip_pixels_per_degree = 0.7 * (3840 / 0.7) * std::numbers::pi / 180;

/// A filter of one dimension: weights of the pixels from -radius to radius.
struct FlipKernel {
  int radius = 0;
  std::vector<float> weights;  ///< 2 radius + 1
};

/// The filters of FLIP as products of filters of one dimension.
struct FlipFilters {
  // Contrast sensitivity of the opponent channels (2020, section 4.1.1): achromatic, red-green,
  // and blue-yellow, which is a sum of two products. Each sums to 1.
  FlipKernel achromatic, red_green, blue_yellow[2];
  float blue_yellow_share[2] = {0, 0};  ///< weights of its two products
  // Feature detectors (2020, section 4.2): first and second derivatives of a Gaussian, whose
  // positive weights sum to 1 and whose negative weights to -1, and the Gaussian across them.
  FlipKernel edge, point, across;
  int reach = 0;  ///< the largest radius
};

/// Made once, at the first call.
const FlipFilters& flip_filters();

}  // namespace lacuna
