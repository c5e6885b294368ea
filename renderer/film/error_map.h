#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "renderer/film/flip.h"
#include "renderer/settings/error_metrics.h"

namespace lacuna {

/// The error of each pixel by a metric that needs a reference, top row first: the mean over the
/// channels of its terms (for `rmse` the square root of that mean), or HDR-FLIP. Throws
/// std::invalid_argument for other metrics, and for sizes that differ or are 0.
std::vector<float> error_map(ErrorMetric metric, const FlipPictures& pictures,
                             const ThreadPool* pool = nullptr);

/// The error that a picture of `map` shows as the brightest colour: 1 for FLIP, which has an upper
/// bound, else the 99th percentile.
double largest_shown_error(ErrorMetric metric, std::span<const float> map);

/// The sRGB codes of the colour scale "magma" of matplotlib at `t`, clipped to [0, 1]; NaN as 1.
std::array<std::uint8_t, 3> magma(double t);

/// The sRGB codes of a map, three for each pixel; `largest` > 0 is the brightest.
std::vector<std::uint8_t> magma_codes(std::span<const float> map, double largest);

}  // namespace lacuna
