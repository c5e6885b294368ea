#include "renderer/materials/layer.h"

#include "renderer/materials/ggx.h"
#include "renderer/materials/roughness_table.h"

namespace lacuna {
namespace {

/// The mean of Schlick's weight over visible normals on a regular grid, each weighted by its
/// unshadowed fraction.
float mean_over_facets(float cos, float alpha) {
  if (alpha < ggx_min_alpha) return schlick_weight(cos);
  cos = std::max(cos, 1e-4F);
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

RoughnessTable& mean_weight_table() {
  static RoughnessTable result(mean_over_facets);
  return result;
}

/// Integral of Schlick's weight times 2 cos over [0, 1].
constexpr float smooth_hemisphere = 1.0F / 21;

}  // namespace

Layer::Layer(float f0, float f90, float alpha)
    : f0_(f0), f90_(f90), row_(alpha == 0 ? -1.0F : RoughnessTable::row(alpha)) {
  if (row_ >= 0) mean_weight_table().need(row_);
  const float mean =
      let_through(row_ < 0 ? smooth_hemisphere : mean_weight_table().hemisphere(row_));
  norm_ = mean > 0 ? 1 / mean : 0;
}

MeanWeights::MeanWeights(const Layer& layer) : smooth_(layer.row_ < 0) {
  if (!smooth_) mean_weight_table().columns_at(layer.row_, v_);
}

Float8 MeanWeights::at(Float8 cos) const {
  if (smooth_) return schlick_weight(cos);
  const Float8 x = sqrt(min(Float8(1), max(Float8(0), cos))) * float(columns - 1);
  const Int8 column = min(truncate(x), Int8(columns - 2));
  const Float8 low = gather(v_.data(), column), high = gather(v_.data() + 1, column);
  return low + (x - to_float(column)) * (high - low);
}

float Layer::mean_weight(float cos) const {
  return row_ < 0 ? schlick_weight(cos) : mean_weight_table().at(row_, cos);
}

}  // namespace lacuna
