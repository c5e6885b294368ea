#pragma once

#include <span>

namespace lacuna {

/// Compares two pictures by the means of square blocks, which average noise out and preserve
/// systematic differences.
struct BlockStatistics {
  int blocks = 0;  ///< whole blocks; the remaining pixels are ignored
  double largest_relative =
      0;           ///< largest |mean a - mean b| / mean b of a block, over RGB together
  double rms = 0;  ///< root of the mean of (mean a - mean b)^2 over blocks and channels
  int worst_x = 0, worst_y = 0;  ///< upper left pixel of that block
  /// Statistics of z = (mean a - mean b) / sqrt(variance of the means) over all blocks and
  /// channels. For pure noise: mean 0, standard deviation 1, 5 % of |z| above 1.96.
  double z_mean = 0, z_deviation = 0, z_beyond = 0;
};

/// Two pictures of `width` x `height` pixels, interleaved RGB.
struct PicturePair {
  std::span<const double> a, b;
  std::span<const double> variance;  ///< of a - b; empty: unknown
  int width = 0, height = 0;
};

/// `size`: side of a block in pixels, at most that of the pictures. Without a variance, z is not
/// computed.
BlockStatistics block_statistics(const PicturePair& pair, int size);

}  // namespace lacuna
