#pragma once

#include <array>
#include <optional>
#include <vector>

#include "renderer/film/image.h"

namespace lacuna {

/// How much less than independent ones the evenly spread samples of a method err.
struct Spread {
  double left = 1;  ///< the variance of the mean of `count` estimates over that of independent ones
  double count = 1;  ///< at least 1
  double later = 0;  ///< exponent with which that falls from there on

  /// The same ratio for the mean of `n` estimates. From 32 to 4096 estimates of six scenes, `left`
  /// falls with an exponent from 0 (door, bdpt on cornell) to .5 (cornell-box).
  double left_of(double n) const;
};

/// Measures Spread. The estimates 0, 2, 4... and 1, 3, 5... are two independent sequences
/// (Sampler::sobol), so that the difference of their means tells the error that the mean of all
/// has.
class SpreadGauge {
 public:
  SpreadGauge() = default;
  SpreadGauge(int width, int height) : sums_{Image(width, height), Image(width, height)} {}

  /// Adds the next estimate.
  void add(const Image& estimate);
  std::uint64_t count() const { return count_; }

  /// `variance`: of one estimate, summed over pixels as the mean of three channels. None before
  /// each sequence has four estimates: with two each, a few bright paths decide.
  std::optional<Spread> spread(double variance) const;

  /// For checkpoints; load() into one of the same size.
  void save(class ByteWriter& out) const;
  void load(class ByteReader& in);

 private:
  /// Squared error of the mean of all, summed over pixels.
  double error() const;

  std::array<Image, 2> sums_;
  std::uint64_t count_ = 0;
  std::vector<double> errors_;  // error() of the first 8, 16, 32... estimates
};

}  // namespace lacuna
