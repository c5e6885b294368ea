#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "renderer/core/alias_table.h"
#include "renderer/settings/connections_settings.h"

namespace lacuna {

/// One discrete distribution combined from several over the same vertices (Noel 2015, 11.3):
/// sampling one of several distributions at random and then from it is sampling from their mixture.
class ResamplingTable {
 public:
  ResamplingTable() = default;

  /// `weights`: the weights of each distribution, >= 0, all spans of one length; a distribution
  /// whose weights are all 0 is left out. The result is positive wherever one of them is.
  ResamplingTable(std::span<const std::span<const double>> weights, Combination combination);

  static constexpr std::size_t bytes_each = AliasTable::bytes_each + 1;  ///< memory per vertex

  /// Nothing can be sampled.
  bool empty() const { return table_.empty(); }
  /// AliasTable::choose() and resolve().
  std::uint32_t choose(Rng& rng) const { return table_.choose(rng); }
  AliasTable::Draw resolve(std::uint32_t chosen, Rng& rng) const {
    return table_.resolve(chosen, rng);
  }
  /// The probability of sampling `i`.
  Pdf<Count> pmf(std::uint32_t i) const { return table_.pmf(i); }
  /// The distribution that gives `i` the highest probability.
  std::uint8_t distribution(std::uint32_t i) const { return distributions_[i]; }

 private:
  AliasTable table_;
  std::vector<std::uint8_t> distributions_;
};

}  // namespace lacuna
