#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "jobs/statistics/estimate.h"

namespace lacuna {

/// Tells the bias of independent pictures of one method from their variance: the products of the
/// errors of two different ones have the bias squared as their mean, and no variance in it. Also
/// finds a bias that the two halves of one run share, as of a cache that a run makes once.
class ReplicateBias {
 public:
  /// `reference`: interleaved RGB of `width` columns.
  ReplicateBias(std::vector<double> reference, int width);
  /// One more picture, of the reference's size.
  void add(std::span<const double> picture);

  std::size_t pictures() const { return n_; }
  /// Mean over pixels and channels of the bias squared, less the reference's own noise
  /// `reference_mse` if that is known; may be negative by chance. Its interval comes from the
  /// scatter of blocks of 16 x 16 pixels, which are taken to be independent. Nothing for less than
  /// two pictures.
  std::optional<Estimate> bias_squared(std::optional<double> reference_mse) const;

 private:
  std::vector<double> reference_, sum_, squares_;  // of the pictures' errors
  std::size_t width_, n_ = 0;
};

}  // namespace lacuna
