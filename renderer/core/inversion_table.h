#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "renderer/core/density.h"

namespace lacuna {

/// A discrete distribution sampled by inversion, in integer arithmetic. The index increases with
/// the random number, so stratified numbers give stratified indices. If k of the 2^32 numbers
/// return an index, its probability is k / 2^32; pmf() returns exactly this. Weights are rounded to
/// such probabilities, positive ones never to 0. A cutpoint for each index makes the expected time
/// constant (Chen and Asau 1974).
class InversionTable {
 public:
  InversionTable() = default;
  /// At most 2^31 weights, which need not be normalised. Throws std::invalid_argument on a negative
  /// or non-finite weight. The table is empty if all weights are 0.
  explicit InversionTable(std::span<const double> weights);

  bool empty() const { return last_.empty(); }

  struct Sample {
    std::uint32_t index;
    std::uint32_t begin;  ///< the first number that returns `index`
    std::uint64_t count;  ///< of numbers that return it
  };
  /// Samples an index from 32 uniform bits. Requires !empty().
  Sample sample(std::uint32_t uniform) const {
    std::uint32_t i = cutpoints_[(uniform * std::uint64_t{last_.size()}) >> 32];
    while (last_[i] < uniform) ++i;
    return {i, i == first_ ? 0 : last_[i - 1] + 1, count(i)};
  }
  Pdf<Count> pmf(std::uint32_t i) const {
    return Pdf<Count>(i < first_ ? 0 : static_cast<float>(double(count(i)) * 0x1p-32));
  }

 private:
  std::uint64_t count(std::uint32_t i) const {
    return i == first_ ? std::uint64_t{last_[i]} + 1 : last_[i] - last_[i - 1];
  }

  std::uint32_t first_ = 0;          // the first index of weight above 0
  std::vector<std::uint32_t> last_;  // the last number that returns an index up to this one
  std::vector<std::uint32_t> cutpoints_;
};

}  // namespace lacuna
