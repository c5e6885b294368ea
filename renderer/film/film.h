#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "renderer/film/image.h"
#include "renderer/film/squared_errors.h"

namespace lacuna {

/// Accumulates iterations, each an independent estimate of the picture: mean and sum of squared
/// deviations of each channel in double (Welford 1962), separately for even and odd iterations, so
/// that the two halves estimate the error without a reference.
class Film {
 public:
  Film() = default;
  Film(int width, int height);

  int width() const { return width_; }
  int height() const { return height_; }
  std::uint64_t iterations() const { return halves_[0].n + halves_[1].n; }

  /// Adds the estimate of iteration `iteration`; its parity chooses the half.
  void add(std::uint64_t iteration, const Image& estimate);

  /// Mean over all iterations, RGB interleaved, in double. All zero before the first.
  std::vector<double> mean() const;
  /// Mean of one half (0: even iterations, 1: odd).
  const std::vector<double>& half_mean(int half) const { return halves_[std::size_t(half)].mean; }
  std::uint64_t half_iterations(int half) const { return halves_[std::size_t(half)].n; }
  /// Variance of mean() itself: the unbiased variance of one iteration divided by their number.
  /// Zero with fewer than two iterations.
  std::vector<double> variance_of_mean() const;
  /// Of the iterations but the first of each half, which has no mean before it; a value's
  /// expectation is the variance of one iteration, averaged over pixels and channels.
  const SquaredErrors& squared_errors() const { return squared_errors_; }

  /// The state as bytes and back, for checkpoints. load() throws std::runtime_error on another
  /// size and on values that are not finite.
  void save(class ByteWriter& out) const;
  void load(class ByteReader& in);

 private:
  struct Half {
    std::uint64_t n = 0;
    std::vector<double> mean, m2;
  };
  int width_ = 0, height_ = 0;
  std::array<Half, 2> halves_;
  SquaredErrors squared_errors_;
};

}  // namespace lacuna
