#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <mutex>
#include <utility>

#include "renderer/materials/mean_weights.h"

namespace lacuna {

/// A function of a lobe's width and of a direction's cosine, tabulated: rows over sqrt(alpha),
/// columns over the square root of the cosine, both equidistant on [0, 1] and interpolated
/// linearly. A row is computed when the first surface needs it; a scene has few different
/// roughnesses. Thread-safe.
class RoughnessTable {
 public:
  /// The value for a cosine in [0, 1] and a width `alpha` in [0, 1].
  using Function = std::function<float(float cos, float alpha)>;
  explicit RoughnessTable(Function function) : function_(std::move(function)) {}

  static constexpr int rows = 17, columns = MeanWeights::columns;
  /// The position of a width among the rows.
  static float row(float alpha) { return std::sqrt(alpha) * (rows - 1); }
  /// Computes the rows for `row` if missing; call before the functions below.
  void need(float row) {
    const std::size_t r = split(row, rows).first;
    std::call_once(made_[r], [&] { fill_row(r); });
    std::call_once(made_[r + 1], [&] { fill_row(r + 1); });
  }

  float at(float row, float cos) const {
    const auto [r, fr] = split(row, rows);
    const auto [c, fc] = split(std::sqrt(std::clamp(cos, 0.0F, 1.0F)) * (columns - 1), columns);
    const float low = values_[r][c] + fc * (values_[r][c + 1] - values_[r][c]);
    const float high = values_[r + 1][c] + fc * (values_[r + 1][c + 1] - values_[r + 1][c]);
    return low + fr * (high - low);
  }
  /// at() of a row, at all columns.
  void columns_at(float row, std::array<float, columns>& out) const {
    const auto [r, fr] = split(row, rows);
    for (std::size_t c = 0; c < columns; ++c) {
      out[c] = values_[r][c] + fr * (values_[r + 1][c] - values_[r][c]);
    }
  }
  /// The integral of at() times 2 cos over [0, 1].
  float hemisphere(float row) const {
    const auto [r, fr] = split(row, rows);
    return hemisphere_[r] + fr * (hemisphere_[r + 1] - hemisphere_[r]);
  }

 private:
  static std::pair<std::size_t, float> split(float x, int n) {
    const int i = std::min(static_cast<int>(x), n - 2);
    return {static_cast<std::size_t>(i), x - static_cast<float>(i)};
  }
  void fill_row(std::size_t r);

  Function function_;
  std::array<std::once_flag, rows> made_;
  std::array<std::array<float, columns>, rows> values_{};
  std::array<float, rows> hemisphere_{};
};

}  // namespace lacuna
