#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "renderer/core/alias_table.h"
#include "renderer/settings/connections_settings.h"

namespace lacuna {

/// A discrete distribution combined from several over the same vertices (Noel 2015, 11.3):
/// selecting one of them at random and sampling it is equivalent to sampling their mixture.
class ResamplingTable {
 public:
  ResamplingTable() = default;

  /// `weights`: the weights of each distribution, >= 0, all spans of equal length; distributions
  /// whose weights are all 0 are ignored. A vertex has a positive probability if some distribution
  /// gives it one.
  ResamplingTable(std::span<const std::span<const double>> weights, Combination combination);

  static constexpr std::size_t bytes_each = AliasTable::bytes_each + 1;  ///< memory per vertex

  /// Whether nothing can be sampled.
  bool empty() const { return table_.empty(); }
  /// AliasTable::choose() and resolve().
  std::uint32_t choose(Rng& rng) const { return table_.choose(rng); }
  AliasTable::Sample resolve(std::uint32_t chosen, Rng& rng) const {
    return table_.resolve(chosen, rng);
  }
  /// The probability of sampling `i`.
  Pdf<Count> pmf(std::uint32_t i) const { return table_.pmf(i); }
  /// The distribution with the highest probability of `i`.
  std::uint8_t distribution(std::uint32_t i) const { return distributions_[i]; }

 private:
  AliasTable table_;
  std::vector<std::uint8_t> distributions_;
};

}  // namespace lacuna
