#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "jobs/sweep/estimate.h"

namespace lacuna {

/// Separates the bias of independent pictures of one method from their variance: the product of the
/// errors of two different pictures has the squared bias as its mean, without variance. Also
/// detects a bias that the two halves of one run share, such as that of a cache built once per run.
class ReplicateBias {
 public:
  /// `reference`: interleaved RGB of `width` columns.
  ReplicateBias(std::vector<double> reference, int width);
  /// Adds a picture of the reference's size.
  void add(std::span<const double> picture);

  std::size_t pictures() const { return n_; }
  /// Mean of the squared bias over pixels and channels, minus the reference's own noise
  /// `reference_mse` if known; may be negative by chance. Its interval follows from the scatter of
  /// blocks of 16 x 16 pixels, which are assumed to be independent. None for fewer than two
  /// pictures.
  std::optional<Estimate> bias_squared(std::optional<double> reference_mse) const;

 private:
  std::vector<double> reference_, sum_, squares_;  // of the pictures' errors
  std::size_t width_, n_ = 0;
};

}  // namespace lacuna
