#include "renderer/materials/layer.h"

#include <array>
#include <mutex>

#include "renderer/materials/ggx.h"
#include "renderer/materials/mean_weights.h"

namespace lacuna {
namespace {

/// Means of Schlick's weight: rows over sqrt(alpha), columns over the cosine, both equidistant on
/// [0, 1].
class Table {
 public:
  /// Computes the rows for `row` if missing; call before at() and hemisphere(). Thread-safe.
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
  template <std::size_t n>
  void columns_at(float row, std::array<float, n>& out) const {
    static_assert(n == columns);
    const auto [r, fr] = split(row, rows);
    for (std::size_t c = 0; c < n; ++c) {
      out[c] = values_[r][c] + fr * (values_[r + 1][c] - values_[r][c]);
    }
  }
  float hemisphere(float row) const {
    const auto [r, fr] = split(row, rows);
    return hemisphere_[r] + fr * (hemisphere_[r + 1] - hemisphere_[r]);
  }
  static float row(float alpha) { return std::sqrt(alpha) * (rows - 1); }

 private:
  static constexpr int rows = 17, columns = MeanWeights::columns;

  static std::pair<std::size_t, float> split(float x, int n) {
    const int i = std::min(static_cast<int>(x), n - 2);
    return {static_cast<std::size_t>(i), x - static_cast<float>(i)};
  }

  void fill_row(std::size_t r) {
    const float roughness = static_cast<float>(r) / (rows - 1);
    const float alpha = roughness * roughness;
    for (std::size_t c = 0; c < columns; ++c) {
      const float x = static_cast<float>(c) / (columns - 1);
      const float cos = x * x;
      values_[r][c] =
          alpha < ggx_min_alpha ? schlick_weight(cos) : mean(std::max(cos, 1e-4F), alpha);
    }
    // Exact integral of the interpolant times 2 cos d cos = 4 x^3 dx, so that the base conserves
    // energy.
    double sum = 0;
    for (std::size_t c = 0; c + 1 < columns; ++c) {
      const double x0 = static_cast<double>(c) / (columns - 1);
      const double x1 = static_cast<double>(c + 1) / (columns - 1);
      const double slope = (values_[r][c + 1] - values_[r][c]) / (x1 - x0);
      const double at_0 = values_[r][c] - slope * x0;
      sum += at_0 * (std::pow(x1, 4) - std::pow(x0, 4)) +
             0.8 * slope * (std::pow(x1, 5) - std::pow(x0, 5));
    }
    hemisphere_[r] = static_cast<float>(sum);
  }

  /// The mean over visible normals on a regular grid, each weighted by its unshadowed fraction.
  static float mean(float cos, float alpha) {
    constexpr int n = 24;
    const V3f wo(std::sqrt(1 - cos * cos), 0, cos);
    double weighted = 0, total = 0;
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) {
        const V2f u((static_cast<float>(i) + 0.5F) / n, (static_cast<float>(j) + 0.5F) / n);
        const V3f m = ggx_sample_visible(wo, alpha, u);
        const float cos_i = reflect(wo, m).z;
        if (cos_i <= 0) continue;
        const double g = ggx_g2_over_4cos(cos, cos_i, alpha);
        weighted += g * schlick_weight(dot(wo, m));
        total += g;
      }
    }
    return static_cast<float>(weighted / total);
  }

  std::array<std::once_flag, rows> made_;
  std::array<std::array<float, columns>, rows> values_{};
  std::array<float, rows> hemisphere_{};
};

/// A row is computed when the first surface needs it, in half a millisecond; a scene has few
/// different roughnesses.
Table& table() {
  static Table result;
  return result;
}

/// Integral of Schlick's weight times 2 cos over [0, 1].
constexpr float smooth_hemisphere = 1.0F / 21;

}  // namespace

Layer::Layer(float f0, float f90, float alpha)
    : f0_(f0), f90_(f90), row_(alpha == 0 ? -1.0F : Table::row(alpha)) {
  if (row_ >= 0) table().need(row_);
  const float mean = let_through(row_ < 0 ? smooth_hemisphere : table().hemisphere(row_));
  norm_ = mean > 0 ? 1 / mean : 0;
}

MeanWeights::MeanWeights(const Layer& layer) : smooth_(layer.row_ < 0) {
  if (!smooth_) table().columns_at(layer.row_, v_);
}

Float8 MeanWeights::at(Float8 cos) const {
  if (smooth_) return schlick_weight(cos);
  const Float8 x = sqrt(min(Float8(1), max(Float8(0), cos))) * float(columns - 1);
  const Int8 column = min(truncate(x), Int8(columns - 2));
  const Float8 low = gather(v_.data(), column), high = gather(v_.data() + 1, column);
  return low + (x - to_float(column)) * (high - low);
}

float Layer::mean_weight(float cos) const {
  return row_ < 0 ? schlick_weight(cos) : table().at(row_, cos);
}

}  // namespace lacuna
