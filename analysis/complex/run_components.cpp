#include "analysis/complex/run_components.h"

#include <algorithm>
#include <bit>

namespace lacuna {
namespace {

/// Whether any bit of [begin, end) is 1.
bool any_in(const std::vector<std::uint64_t>& bits, int begin, int end) {
  for (int x = begin; x < end;) {
    const int last = std::min(end, (x | 63) + 1);
    std::uint64_t w = bits[static_cast<std::size_t>(x >> 6)] >> (x & 63);
    if (last - x < 64) w &= (std::uint64_t{1} << (last - x)) - 1;
    if (w != 0) return true;
    x = last;
  }
  return false;
}

/// The first x in [begin, end) whose bit equals `value`; end if none.
int next(const std::vector<std::uint64_t>& bits, int begin, int end, bool value) {
  for (int x = begin; x < end;) {
    std::uint64_t w = bits[static_cast<std::size_t>(x >> 6)];
    if (!value) w = ~w;
    w >>= x & 63;
    if (w != 0) return std::min(end, x + std::countr_zero(w));
    x = (x | 63) + 1;
  }
  return end;
}

}  // namespace

RunComponents::RunComponents(Imath::V3i cells, const std::function<void(int, int, CellRow&)>& fill)
    : cells_(cells) {
  CellRow row(cells.x);
  first_.reserve(static_cast<std::size_t>(cells.y) * static_cast<std::size_t>(cells.z) + 1);
  first_.push_back(0);
  const auto rows_of_slice = static_cast<std::size_t>(cells.y);
  for (int z = 0; z < cells.z; ++z) {
    for (int y = 0; y < cells.y; ++y) {
      fill(y, z, row);
      add_runs(row, cells.x);
      const std::size_t here = first_.size() - 2;
      if (y > 0) join_rows(here, here - 1, row.link_y);
      if (z > 0) join_rows(here, here - rows_of_slice, row.link_z);
    }
  }
  label_.resize(runs_.size());
  for (std::uint32_t i = 0; i < runs_.size(); ++i) {
    const std::uint32_t r = sets_.end_of(i);  // the smallest of its component
    label_[i] = r == i ? count_++ : label_[r];
  }
}

void RunComponents::add_runs(const CellRow& row, int width) {
  for (int x = next(row.present, 0, width, true); x < width;) {
    // A run ends before a cell that is absent or not linked to the one before it.
    const int gap = next(row.present, x, width, false);
    const int end = std::min(gap, next(row.link_x, x + 1, width, false));
    runs_.push_back({x, end});
    sets_.add();
    x = end < gap ? end : next(row.present, end, width, true);
  }
  first_.push_back(static_cast<std::uint32_t>(runs_.size()));
}

void RunComponents::join_rows(std::size_t row, std::size_t other,
                              const std::vector<std::uint64_t>& link) {
  std::uint32_t a = first_[row], b = first_[other];
  while (a < first_[row + 1] && b < first_[other + 1]) {
    const int begin = std::max(runs_[a].begin, runs_[b].begin);
    const int end = std::min(runs_[a].end, runs_[b].end);
    if (begin < end && any_in(link, begin, end)) sets_.join(a, b);
    (runs_[a].end < runs_[b].end ? a : b) += 1;
  }
}

std::uint32_t RunComponents::of(Imath::V3i cell) const {
  const std::size_t row = static_cast<std::size_t>(cell.z) * static_cast<std::size_t>(cells_.y) +
                          static_cast<std::size_t>(cell.y);
  const auto begin = runs_.begin() + first_[row], end = runs_.begin() + first_[row + 1];
  const auto it =
      std::upper_bound(begin, end, cell.x, [](int x, const Run& r) { return x < r.begin; });
  return label_[static_cast<std::size_t>(it - runs_.begin()) - 1];
}

}  // namespace lacuna
