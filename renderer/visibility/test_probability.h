#pragma once

#include "renderer/core/rng.h"
#include "renderer/many_lights/visibility_estimate.h"
#include "renderer/many_lights/vpl_contributions.h"
#include "renderer/settings/visibility_settings.h"

namespace lacuna {

/// The probability of testing a light with unoccluded contribution `t`: 1 - p_i of Nabata et al.,
/// which minimises variance times time (eq. 9, 10),
///
///   sqrt(A k / (sigma^2 - c A)),  A = t^2 var,  k = n_0 - 1,  c = 1,
/// with n_0 - 1 the time of a light without its test, in units of tests, and var the assumed
/// variance of its visibility; at least `least`. It reaches 1 at A = sigma^2 (4.1). Veach's
/// threshold, t sqrt(n) / sigma, is the case k = n, c = 0 (Veach 1997, 10.4.1). All terms are
/// divided by sigma, so the result does not depend on brightness. If lights are sampled, and
/// contributions divided by their sampling probability, this factor of both t and sigma cancels.
struct TestProbability {
  float k = 0;
  float c = 1;
  float least = 1;
  float over_sigma = 0;  ///< 1 / sigma; infinite if sigma is unknown: test every light

  /// `weight`: a factor of `t` that sigma does not contain.
  Float8 of(Float8 t, Float8 var, float weight = 1) const {
    const Float8 u = t * (over_sigma / weight);
    const Float8 a = u * u * var;
    const Float8 rest = 1 - c * a;
    // NaN, from 0 times infinity, compares false: test the light.
    const Float8 x = select(rest > 0, sqrt(a * k / rest), 1);
    return min(1, max(least, x));
  }
};

/// Samples the lights of a block to test. Probabilities are integers, so that the sampling
/// probability of each light equals exactly the divisor of its contribution.
struct TestSampler {
  static constexpr int bits = 20;
  static constexpr std::uint32_t one = 1U << bits;
  alignas(32) std::array<std::uint32_t, Lanes::size> v;

  /// Sets the probabilities of eight lights; 0 unless `lit` is above 0.
  void set(int group, Float8 probability, Float8 lit) {
    const Float8 key = keep_where(lit > 0, ceil(probability * float(one)));
    truncate(key).store_unaligned(v.data() + static_cast<std::ptrdiff_t>(8 * group));
  }
  float probability(int i) const { return float(v[static_cast<std::size_t>(i)]) / float(one); }

  /// `unit` / probability(i), for light `i` with probability above 0.
  std::uint32_t inverse(int i, std::uint64_t unit) const {
    return static_cast<std::uint32_t>(unit * one / v[static_cast<std::size_t>(i)]);
  }

  std::uint64_t sample(TestDraws draws, Rng& rng) const {
    return draws == TestDraws::systematic ? systematic(rng.next_u32()) : independent(rng);
  }
  /// Samples each light with its probability by one random number u: the lights whose intervals of
  /// the cumulative sum contain u, u + 1, ... The lights of a block are similar, so the samples are
  /// spread over the block.
  std::uint64_t systematic(std::uint32_t random) const {
    std::uint64_t sampled = 0;
    std::uint32_t sum = random >> (32 - bits);
    for (int i = 0; i < Lanes::size; ++i) {
      sum += v[static_cast<std::size_t>(i)];
      sampled |= std::uint64_t{sum >> bits} << i;
      sum &= one - 1;
    }
    return sampled;
  }
  /// Samples each light with its probability by its own random number.
  std::uint64_t independent(Rng& rng) const {
    std::uint64_t sampled = 0;
    for (int i = 0; i < Lanes::size; ++i) {
      const std::uint32_t p = v[static_cast<std::size_t>(i)];
      if (p > 0 && rng.next_u32() >> (32 - bits) < p) sampled |= std::uint64_t{1} << i;
    }
    return sampled;
  }
};

}  // namespace lacuna
