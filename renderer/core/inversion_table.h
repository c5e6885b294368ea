#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "renderer/core/density.h"

namespace lacuna {

/// A discrete distribution sampled by inversion, in integers only: larger numbers draw larger
/// indices, so that numbers that are spread evenly draw indices that are. An index has the
/// probability k / 2^32 if k of the 2^32 numbers return it, which is what is stated. Weights are
/// rounded to such probabilities; one above 0 is never rounded to 0. A cutpoint for each index
/// makes the expected time constant (Chen and Asau 1974).
class InversionTable {
 public:
  InversionTable() = default;
  /// Weights need not be normalised; at most 2^31. Throws std::invalid_argument on a negative or
  /// non-finite weight. If all are 0 the table is empty.
  explicit InversionTable(std::span<const double> weights);

  bool empty() const { return last_.empty(); }

  struct Draw {
    std::uint32_t index;
    std::uint32_t begin;  ///< of the numbers that return it
    std::uint64_t count;  ///< how many do
  };
  /// By 32 uniform bits. Requires !empty().
  Draw draw(std::uint32_t uniform) const {
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
  std::vector<std::uint32_t> last_;  // of the numbers that return an index or one before it
  std::vector<std::uint32_t> cutpoints_;
};

}  // namespace lacuna
