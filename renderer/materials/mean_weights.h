#pragma once

#include <array>

#include "analysis/geometry/simd.h"
#include "renderer/materials/layer.h"

namespace lacuna {

/// Layer::mean_weight() of one layer, for eight cosines at once.
class MeanWeights {
 public:
  static constexpr int columns = 33;  ///< equidistant in the square root of the cosine

  explicit MeanWeights(const Layer& layer);
  Float8 at(Float8 cos) const;

 private:
  bool smooth_;
  std::array<float, columns> v_{};
};

}  // namespace lacuna
