#include "analysis/space/squared_lines.h"

#include <algorithm>

#include "analysis/geometry/simd.h"

namespace lacuna {

namespace {

/// Up to this distance run() searches outwards, beyond it it takes the envelope. An estimate.
constexpr std::uint32_t search_limit = 160;

}  // namespace

SquaredLines::SquaredLines(int length)
    : length_(length),
      values_(static_cast<std::size_t>(length) * lanes),
      result_(values_.size()),
      line_(static_cast<std::size_t>(length) + 2),
      vertex_(line_.size()),
      begin_(line_.size()) {}

void SquaredLines::search_outwards() {
  static_assert(lanes == 16, "two vectors of eight");
  for (int i = 0; i < length_; ++i) {
    const auto rim = static_cast<std::uint32_t>(std::min(i + 1, length_ - i));
    const std::uint32_t* const here = at(i);
    const Int8 outside(static_cast<int>(rim * rim));
    Int8 low = min_unsigned(Int8::load_unaligned(here), outside);
    Int8 high = min_unsigned(Int8::load_unaligned(here + 8), outside);
    const std::uint32_t *before = here, *after = here;
    for (std::uint32_t k = 1; k < rim; ++k) {
      before -= lanes;
      after += lanes;
      const Int8 square(static_cast<int>(k * k));
      // No lane is farther than k: positions from here on cannot be nearer.
      if (all_equal(max_unsigned(max_unsigned(low, high), square), square)) break;
      const auto nearer = [&](std::ptrdiff_t lane) {
        return min_unsigned(Int8::load_unaligned(before + lane),
                            Int8::load_unaligned(after + lane));
      };
      low = min_unsigned(low, nearer(0) + square);
      high = min_unsigned(high, nearer(8) + square);
    }
    std::uint32_t* const to = &result_[static_cast<std::size_t>(i) * lanes];
    low.store_unaligned(to);
    high.store_unaligned(to + 8);
  }
  values_.swap(result_);
}

void SquaredLines::lower_envelope() {
  for (std::size_t lane = 0; lane < lanes; ++lane) lower_envelope(lane);
}

void SquaredLines::lower_envelope(std::size_t lane) {
  const int n = length_ + 2;  // positions 0 and n - 1 are outside
  line_.front() = 0;
  line_.back() = 0;
  for (int i = 0; i < length_; ++i) line_[static_cast<std::size_t>(i) + 1] = at(i)[lane];
  const auto height = [&](int x, int vertex) {
    const std::int64_t d = x - vertex;
    return d * d + line_[static_cast<std::size_t>(vertex)];
  };
  std::size_t q = 0;
  vertex_[0] = 0;
  begin_[0] = 0;
  // The parabola at 0 stays lowest at 0, so one always remains.
  for (int u = 1; u < n; ++u) {
    while (q > 0 && height(begin_[q], vertex_[q]) > height(begin_[q], u)) --q;
    const std::int64_t i = vertex_[q], j = u;
    const std::int64_t crossing =  // the last position where i's parabola is no higher than u's
        (j * j - i * i + line_[static_cast<std::size_t>(u)] -
         line_[static_cast<std::size_t>(vertex_[q])]) /
        (2 * (j - i));
    if (crossing + 1 < n) {
      ++q;
      vertex_[q] = u;
      begin_[q] = static_cast<int>(crossing) + 1;
    }
  }
  for (int x = n - 2; x >= 1; --x) {
    while (begin_[q] > x) --q;
    at(x - 1)[lane] = static_cast<std::uint32_t>(height(x, vertex_[q]));
  }
}

void SquaredLines::run() {
  std::uint32_t largest = 0;
  for (const std::uint32_t v : values_) largest = std::max(largest, v);
  const auto rim = static_cast<std::uint32_t>(length_ + 1) / 2;
  if (std::min(largest, rim * rim) <= search_limit * search_limit)
    search_outwards();
  else
    lower_envelope();
}

}  // namespace lacuna
