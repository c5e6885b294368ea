#include "renderer/materials/roughness_table.h"

namespace lacuna {

void RoughnessTable::fill_row(std::size_t r) {
  const float roughness = static_cast<float>(r) / (rows - 1);
  for (std::size_t c = 0; c < columns; ++c) {
    const float x = static_cast<float>(c) / (columns - 1);
    values_[r][c] = function_(x * x, roughness * roughness);
  }
  // Exact integral of the interpolant times 2 cos d cos = 4 x^3 dx, so that what is scaled by its
  // inverse conserves energy.
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

}  // namespace lacuna
