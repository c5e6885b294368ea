#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "renderer/core/density.h"
#include "renderer/core/rng.h"

namespace lacuna {

/// A discrete distribution sampled in constant time (Walker 1977, in Vose's form), in integer
/// arithmetic. If n of the 2^64 equally probable pairs of random numbers return an index, its
/// probability is n / 2^64; resolve() and pmf() return exactly this, rounded to float. Weights are
/// rounded to multiples of 2^-32 of a bin, positive ones never to 0.
class AliasTable {
 public:
  AliasTable() = default;
  /// Weights need not be normalised. Throws std::invalid_argument on a negative or non-finite
  /// weight. The table is empty if all weights are 0.
  explicit AliasTable(std::span<const double> weights);

  bool empty() const { return bins_.empty(); }
  std::size_t size() const { return bins_.size(); }
  /// Samples an index from two random numbers.
  std::uint32_t sample(Rng& rng) const { return resolve(choose(rng), rng).index; }

  /// An index and its probability.
  struct Sample {
    std::uint32_t index;
    Pdf<Count> pmf;
  };
  /// sample() in two steps: choose() prefetches the bin, resolve() reads it.
  std::uint32_t choose(Rng& rng) const { return choose(rng.next_u32()); }
  /// choose() from 32 uniform bits.
  std::uint32_t choose(std::uint32_t uniform) const {
    const auto i = static_cast<std::uint32_t>((std::uint64_t{uniform} * bins_.size()) >> 32);
    __builtin_prefetch(&bins_[i]);
    return i;
  }
  Sample resolve(std::uint32_t chosen, Rng& rng) const { return resolve(chosen, rng.next_u32()); }
  /// resolve() from 32 uniform bits.
  Sample resolve(std::uint32_t chosen, std::uint32_t uniform) const {
    const Bin& b = bins_[chosen];
    if (uniform < b.threshold) return {chosen, Pdf<Count>(b.pmf)};
    return {b.alias, Pdf<Count>(b.alias_pmf)};
  }
  /// sample() from `point`: the upper half of x selects the bin, point.u_select resolves it.
  /// Afterwards x is the position within the bin, again uniform to n 2^-32 for each index.
  std::uint32_t sample(Rng::FinePoint& point) const {
    const std::uint32_t i = choose(static_cast<std::uint32_t>(point.x >> 32));
    point.x *= bins_.size();
    return resolve(i, point.u_select).index;
  }
  /// sample() from one number `u`, uniform in [0, 1). Afterwards `u` is the position within the
  /// part of the bin, again uniform, with fewer bits by those that selected the index.
  Sample sample(double& u) const {
    const double at = u * static_cast<double>(bins_.size());
    const auto i = std::min(static_cast<std::uint32_t>(at), static_cast<std::uint32_t>(size() - 1));
    const Bin& b = bins_[i];
    const double rest = at - i, split = b.threshold * 0x1p-32;
    if (rest < split) {
      u = rest / split;
      return {i, Pdf<Count>(b.pmf)};
    }
    u = (rest - split) / (1 - split);
    return {b.alias, Pdf<Count>(b.alias_pmf)};
  }
  /// Prefetches what pmf() reads.
  void prefetch(std::uint32_t i) const { __builtin_prefetch(&bins_[i]); }
  Pdf<Count> pmf(std::uint32_t i) const { return Pdf<Count>(bins_[i].pmf); }

 private:
  void set_probabilities();

  struct Bin {
    std::uint32_t threshold;  // of 2^32; below it: this index, else `alias`
    std::uint32_t alias;
    float pmf;
    float alias_pmf;  // stored here too, so that a sample reads one bin
  };

 public:
  static constexpr std::size_t bytes_each = sizeof(Bin);  ///< memory per index

 private:
  std::vector<Bin> bins_;
};

}  // namespace lacuna
