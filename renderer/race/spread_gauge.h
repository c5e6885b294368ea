#pragma once

#include <array>
#include <optional>
#include <vector>

#include "renderer/film/image.h"

namespace lacuna {

/// How much less than independent ones the evenly spread samples of a method err.
struct Spread {
  /// The variance of the mean of `count` estimates over that of independent ones.
  double left = 1;
  double count = 1;  ///< at least 1
  double later = 0;  ///< exponent with which `left` falls from there on

  /// `left` is brought into [1 / count, 1]. A straight line in logarithms from one estimate on
  /// falls too fast later: `later` is half of its slope. From 32 to 4096 estimates of six scenes
  /// the exponent is from 0 (door, bdpt on cornell) to .5 (cornell-box).
  static Spread of(double left, double count);
  /// `before` of `count_before` estimates has fallen to `now` of `count`: half of that slope
  /// counts, because it is noisy. From 64 to 4096 estimates the mean of both foresees the error to
  /// 1.5 for path tracing on cornell-box, area, atrium and door, and for bidirectional path tracing
  /// on cornell and atrium; to 1.6 for path tracing on cornell, to 2.6 on open under a sky.
  void steepen(double before, double count_before, double now);
  /// The same ratio for the mean of `n` estimates.
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
