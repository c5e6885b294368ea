#include "analysis/space/squared_lines.h"

#include <algorithm>

namespace lacuna {

namespace {

/// Up to this distance searching outwards is faster than the envelope, measured.
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
  for (int i = 0; i < length_; ++i) {
    std::uint32_t best[lanes];
    const auto rim = static_cast<std::uint32_t>(std::min(i + 1, length_ - i));
    const std::uint32_t* here = at(i);
    for (int l = 0; l < lanes; ++l) best[l] = std::min(here[l], rim * rim);
    for (std::uint32_t k = 1; k < rim; ++k) {
      const std::uint32_t square = k * k;
      const std::uint32_t* before = here - k * lanes;
      const std::uint32_t* after = here + k * lanes;
      std::uint32_t farther = 0;  // lanes that a position beyond can still serve
      for (int l = 0; l < lanes; ++l) {
        best[l] = std::min(best[l], std::min(before[l], after[l]) + square);
        farther |= static_cast<std::uint32_t>(best[l] > square);
      }
      if (farther == 0) break;
    }
    std::copy(best, best + lanes, &result_[static_cast<std::size_t>(i) * lanes]);
  }
  values_.swap(result_);
}

void SquaredLines::lower_envelope() {
  for (std::size_t lane = 0; lane < lanes; ++lane) lower_envelope(lane);
}

void SquaredLines::lower_envelope(std::size_t lane) {
  const int n = length_ + 2;  // position 0 is outside, and so is n - 1
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
  // The vertex at 0 is lowest at 0 for good, so one parabola always stays.
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
