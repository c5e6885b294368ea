#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "jobs/spec/auto_settings.h"
#include "renderer/film/film.h"

namespace lacuna {

/// A picture that a candidate has rendered so far.
struct CandidatePicture {
  const Film* film;
  bool biased;  ///< its settings are
};

/// What is known of its error; squared, the mean over pixels and channels.
struct PictureError {
  double noise = 0;  ///< falls as one over the time
  /// Of blocks of 16 x 16 pixels with less than half of the light that the mean of all pictures
  /// has: the squared difference. Rare bright paths are still to come, and the noise seen so far
  /// says nothing about them.
  double missing = 0;
  double bias = 0;  ///< of biased settings: the difference to the best unbiased picture without
                    ///< the noise of both; stays
};

/// The errors of independent pictures of one view, by `metric`. The noise of a picture follows from
/// its two halves. Before each has an iteration it follows from the distances d of the picture x to
/// the two nearest ones y and z, (d_xy + d_xz - d_yz) / 2 (the "three-cornered hat", Gray and Allan
/// 1974), and is at least a 16th of the shorter one. None where there are no two others, and of a
/// picture that is black where another is not. Relative errors are divided by r^2 + 0.01, as
/// ErrorMetric::relmse has it, with the larger of the mean of all pictures in a block of 16 x 16
/// pixels and their lower median in the pixel as r: an outlier of one picture must not hide itself.
std::vector<std::optional<PictureError>> picture_errors(std::span<const CandidatePicture> pictures,
                                                        RankingMetric metric);

/// What the error of the default counts beside those of others: after few iterations estimates are
/// not known better, and methods that learn have only begun to.
inline constexpr double default_advantage = 0.5;

/// The half of candidates, rounded up, with the least `errors`, in their order; one without an
/// error only where all of those with one stay. The best of those that are not `biased`, and the
/// first if it is the default, are always among two or more.
std::vector<std::size_t> better_half(std::span<const std::optional<double>> errors,
                                     const std::vector<bool>& biased, bool has_default);

}  // namespace lacuna
