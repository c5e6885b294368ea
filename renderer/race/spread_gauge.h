#pragma once

#include <algorithm>
#include <array>
#include <optional>

#include "renderer/film/film.h"
#include "renderer/film/image.h"

namespace lacuna {

/// How much less than independent ones the evenly spread samples of a method err (Sampler::sobol).
/// The estimates 0, 2, 4... and 1, 3, 5... are two independent sequences, so that the difference of
/// their means tells the error that the mean of all has.
class SpreadGauge {
 public:
  SpreadGauge() = default;
  SpreadGauge(int width, int height) : sums_{Image(width, height), Image(width, height)} {}

  /// Adds the next estimate.
  void add(const Image& estimate) {
    Image& sum = sums_[count_++ % 2];
    for (std::size_t i = 0; i < sum.pixels.size(); ++i) sum.pixels[i] += estimate.pixels[i];
  }
  std::uint64_t count() const { return count_; }

  /// The part of the variance that is not spread: `variance`, of one estimate, summed over pixels
  /// as the mean of three channels, is a part that falls as 1 / n and one that falls as 1 / n^2,
  /// slower than that of smooth integrands and faster than that of edges. In [0, 1]; none before
  /// each sequence has four estimates: with two each, a few bright paths decide.
  std::optional<double> rough_part(double variance) const {
    const auto odd = double(count_ / 2), even = double(count_) - odd;
    if (odd < 4 || !(variance > 0)) return std::nullopt;
    double apart = 0;
    for (std::size_t i = 0; i < sums_[0].pixels.size(); ++i) {
      const Rgb d = sums_[0].pixels[i] / float(even) - sums_[1].pixels[i] / float(odd);
      apart += (double(d.x) * d.x + double(d.y) * d.y + double(d.z) * d.z) / 3;
    }
    const double left = apart * scale_from_halves(even, odd) * double(count_) / variance;
    const double most = 2 / double(count_);  // where all variance is spread
    return std::clamp((left - most) / (1 - most), 0.0, 1.0);
  }
  /// The variance of the mean of `n` estimates over that of independent ones, of that rough part.
  static double left_of(double rough_part, double n) {
    return rough_part + (1 - rough_part) / std::max(1.0, n / 2);
  }

  /// For checkpoints; load() into one of the same size.
  void save(class ByteWriter& out) const;
  void load(class ByteReader& in);

 private:
  std::array<Image, 2> sums_;
  std::uint64_t count_ = 0;
};

}  // namespace lacuna
