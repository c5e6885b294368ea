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
  bool biased;  ///< by its settings
};

/// The estimated error of a picture; squared, mean over pixels and channels.
struct PictureError {
  double noise = 0;  ///< proportional to 1 / time
  /// The squared difference of blocks of 16 x 16 pixels with less than half of the light of the
  /// mean of all pictures. They lack rare bright paths, which the noise so far does not reflect.
  double missing = 0;
  double bias = 0;  ///< of biased settings: the squared difference to the best unbiased picture,
                    ///< less the noise of both; constant in time
};

/// The errors of independent pictures of one view, by `metric`. The noise of a picture follows from
/// its two halves. Before each half has an iteration, it follows from the distances d of the
/// picture x to the two nearest ones y and z, (d_xy + d_xz - d_yz) / 2 (the "three-cornered hat",
/// Gray and Allan 1974), and is at least a 16th of the shorter distance. None if there are no two
/// others, or if a picture is black and another is not. Relative errors are divided by r^2 + 0.01,
/// as in ErrorMetric::relmse, where r is the larger of the mean of all pictures in a block of 16 x
/// 16 pixels and their lower median in the pixel: an outlier of one picture must not hide itself.
std::vector<std::optional<PictureError>> picture_errors(std::span<const CandidatePicture> pictures,
                                                        RankingMetric metric);

/// Factor on the error of the default candidate: after few iterations estimates are not more
/// accurate, and learning methods have only begun to learn.
inline constexpr double default_advantage = 0.5;

/// The half of the candidates, rounded up, with the smallest `errors`, in their order; candidates
/// without an error rank last. If two or more remain, they include the best unbiased one and, if
/// `has_default`, the first.
std::vector<std::size_t> better_half(std::span<const std::optional<double>> errors,
                                     const std::vector<bool>& biased, bool has_default);

}  // namespace lacuna
