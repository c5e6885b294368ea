#include "renderer/film/exact_sums.h"

#include "renderer/film/saved_values.h"

namespace lacuna {

bool ExactSums::add(const ExactSums& other) {
  bool exact = true;
  for (std::size_t i = 0; i < size(); ++i) {
    PairSum sum = (*this)[i];
    exact = add_to(sum, other[i]) == 0 && exact;
    high_[i] = sum.high;
    low_[i] = sum.low;
  }
  return exact;
}

void ExactSums::save(ByteWriter& out) const {
  out.put(high_);
  out.put(low_);
}

void ExactSums::load(ByteReader& in, const std::string& what) {
  std::vector<double> high = get_finite(in, size(), what);
  std::vector<double> low = get_finite(in, size(), what);
  for (std::size_t i = 0; i < high.size(); ++i) {
    if (high[i] + low[i] != high[i]) {
      throw std::runtime_error("saved " + what + " has sums that are not rounded");
    }
  }
  high_ = std::move(high);
  low_ = std::move(low);
}

}  // namespace lacuna
