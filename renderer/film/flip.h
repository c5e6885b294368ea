#pragma once

#include <span>
#include <vector>

#include "base/parallel/thread_pool.h"

namespace lacuna {

// FLIP, the difference that a person sees who alternates between two pictures: LDR-FLIP (Andersson
// et al. 2020, "FLIP: A Difference Evaluator for Alternating Images") and HDR-FLIP (Andersson et
// al. 2021, "Visualizing Errors in Rendered High Dynamic Range Images"). The observer is 0.7 m from
// a monitor of 0.7 m and 3840 pixels, as by default in the papers: 67.02 pixels a degree.

/// The exposures of HDR-FLIP: `count` of them, evenly spaced from `start` to `stop`, in stops.
struct FlipExposures {
  double start = 0, stop = 0;
  int count = 1;

  double at(int i) const { return count > 1 ? start + i * (stop - start) / (count - 1) : start; }
};

/// The exposures for a reference (2021, section 4): ACES maps the largest luminance to 0.85 at the
/// start and the median to 0.85 at the stop; about one exposure a stop, at least two. The median is
/// that of the luminances above 0: otherwise a picture that is mostly black would have no stop. A
/// black reference: one exposure, 0.
FlipExposures flip_exposures(std::span<const double> reference);

/// Two pictures of one size.
struct FlipPictures {
  std::span<const double> estimate, reference;  ///< interleaved linear RGB, top row first
  int width = 0, height = 0;
};

/// LDR-FLIP of each pixel, in [0, 1], of the pictures times `exposure`, clipped to [0, 1]. They are
/// not rounded to codes of 8 bits. NaN where a value in reach of the filters is NaN. The same bits
/// with and without a pool. Throws std::invalid_argument for sizes that differ or are 0.
std::vector<float> ldr_flip(const FlipPictures& pictures, double exposure,
                            const ThreadPool* pool = nullptr);

/// HDR-FLIP of each pixel: the largest LDR-FLIP over `exposures` of the pictures tone-mapped with
/// ACES. Negative values count as 0. Otherwise as ldr_flip().
std::vector<float> hdr_flip(const FlipPictures& pictures, const FlipExposures& exposures,
                            const ThreadPool* pool = nullptr);

/// The mean over a map's pixels.
double flip_mean(std::span<const float> map);

}  // namespace lacuna
