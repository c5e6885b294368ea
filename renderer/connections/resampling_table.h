#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "renderer/core/alias_table.h"
#include "renderer/settings/connections_settings.h"

namespace lacuna {

/// One discrete distribution made of several over the same things (Noel 2015, 11.3): drawing one
/// of several distributions, then from it, is drawing from one.
class ResamplingTable {
 public:
  ResamplingTable() = default;

  /// `weights`: of each distribution its weights, >= 0, all spans of one length; a distribution
  /// whose weights are all 0 takes no part. The result is positive wherever one of them is.
  ResamplingTable(std::span<const std::span<const double>> weights, Combination combination);

  static constexpr std::size_t bytes_each = AliasTable::bytes_each + 1;  ///< of memory, a thing

  /// Nothing can be drawn.
  bool empty() const { return table_.empty(); }
  /// AliasTable::choose() and resolve().
  std::uint32_t choose(Rng& rng) const { return table_.choose(rng); }
  AliasTable::Draw resolve(std::uint32_t chosen, Rng& rng) const {
    return table_.resolve(chosen, rng);
  }
  /// The probability that a draw returns `i`.
  Pdf<Count> pmf(std::uint32_t i) const { return table_.pmf(i); }
  /// Which of the distributions gives `i` most.
  std::uint8_t owner(std::uint32_t i) const { return owners_[i]; }

 private:
  AliasTable table_;
  std::vector<std::uint8_t> owners_;
};

}  // namespace lacuna
