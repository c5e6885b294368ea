#include "renderer/core/inversion_table.h"

#include <algorithm>
#include <cmath>

#include "renderer/core/weights.h"

namespace lacuna {

InversionTable::InversionTable(std::span<const double> weights) {
  const auto [largest, sum] = WeightSum(weights);
  if (largest == 0) return;

  // Ends of the intervals, of 2^32. Each weight above 0 then gets at least one number: a pass from
  // the left widens intervals, a pass from the right moves back those beyond the end.
  constexpr std::uint64_t all = std::uint64_t{1} << 32;
  const std::size_t n = weights.size();
  std::vector<std::uint64_t> ends(n);
  double before = 0;
  std::uint64_t end = 0;
  for (std::size_t i = 0; i < n; ++i) {
    before += weights[i] / largest;
    const auto rounded = static_cast<std::uint64_t>(std::round(before / sum * 0x1p32));
    end = weights[i] > 0 ? std::max(end + 1, rounded) : end;
    ends[i] = end;
  }
  std::uint64_t limit = all;
  for (std::size_t i = n; i-- > 0;) {
    ends[i] = std::min(ends[i], limit);
    if (weights[i] > 0) {
      if (limit == all) ends[i] = all;  // the last index takes the rounding error
      limit = ends[i] - 1;
    }
  }
  while (weights[first_] == 0) ++first_;
  last_.resize(n);
  std::uint64_t last_end = 0;
  for (std::size_t i = 0; i < n; ++i) {
    if (weights[i] > 0) last_end = ends[i];
    last_[i] = static_cast<std::uint32_t>(std::max<std::uint64_t>(1, last_end) - 1);
  }
  cutpoints_.resize(n);
  std::uint32_t at = first_;
  for (std::size_t k = 0; k < n; ++k) {
    const auto number = static_cast<std::uint32_t>(((k << 32) + n - 1) / n);
    while (last_[at] < number) ++at;
    cutpoints_[k] = at;
  }
}

}  // namespace lacuna
