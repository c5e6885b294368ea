#pragma once

#include "renderer/core/rng.h"
#include "renderer/many_lights/visibility_estimate.h"
#include "renderer/many_lights/vpl_contributions.h"

namespace lacuna {

/// With which probability a light is tested that gives `t` if it is seen: 1 - p_i of Nabata et al.,
/// where variance times time is least (eq. 9, 10),
///
///   sqrt(A k / (sigma^2 - c A)),  A = t^2 var,  k = n_0 - 1,  c = 1,
///
/// with n_0 - 1 the time, in tests, that a light takes besides its test, and var the variance its
/// visibility is taken to have; at least `least`. It is 1 where A reaches sigma^2 (4.1). Veach's
/// threshold, t sqrt(n) / sigma, is the same with k = n, c = 0 (Veach 1997, 10.4.1). Scaled by
/// sigma throughout, so that any brightness is as good as another.
struct TestProbability {
  float k = 0;
  float c = 1;
  float least = 1;
  float over_sigma = 0;  ///< 1 / sigma; infinite where nothing is known: all are tested

  Float8 of(Float8 t, Float8 var) const {
    const Float8 u = t * over_sigma;
    const Float8 a = u * u * var;
    const Float8 rest = 1 - c * a;
    // What is no number, 0 times infinity, compares false: tested.
    const Float8 x = select(rest > 0, sqrt(a * k / rest), 1);
    return min(1, max(least, x));
  }
};

/// Probabilities as integers, so that every light is drawn with exactly the one it is divided by.
struct SystematicSampler {
  static constexpr int bits = 20;
  static constexpr std::uint32_t one = 1U << bits;
  alignas(32) std::array<std::uint32_t, Lanes::size> v;

  /// The probabilities of eight lights; 0 where `lit` is not above 0.
  void set(int group, Float8 probability, Float8 lit) {
    const Float8 key = keep_where(lit > 0, ceil(probability * float(one)));
    truncate(key).store_unaligned(v.data() + static_cast<std::ptrdiff_t>(8 * group));
  }
  float probability(int i) const { return float(v[static_cast<std::size_t>(i)]) / float(one); }

  /// Draws each light with its probability, all with one random number: those whose stretch of the
  /// summed probabilities holds u, u + 1, ... Lights of a block are alike, and so are spread over
  /// it (systematic sampling).
  std::uint64_t draw(std::uint32_t random) const {
    std::uint64_t drawn = 0;
    std::uint32_t sum = random >> (32 - bits);
    for (int i = 0; i < Lanes::size; ++i) {
      sum += v[static_cast<std::size_t>(i)];
      drawn |= std::uint64_t{sum >> bits} << i;
      sum &= one - 1;
    }
    return drawn;
  }
};

}  // namespace lacuna
