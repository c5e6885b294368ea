#include "renderer/geometry/instance.h"

#include <algorithm>
#include <cmath>

namespace lacuna {

Instance::Instance(const M44d& to_scene, std::uint32_t which) : prototype(which) {
  M44d linear;
  double squares = 0;
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) {
      axes[static_cast<std::size_t>(i)][k] = static_cast<float>(to_scene[i][k]);
      linear[k][i] = to_scene[i][k];
      squares += to_scene[i][k] * to_scene[i][k];
    }
    at[i] = static_cast<float>(to_scene[3][i]);
  }
  stretch = static_cast<float>(std::sqrt(squares));
  const M44d inverse = linear.inverse();
  double largest = 0;
  for (int i = 0; i < 3; ++i) {
    double sum = 0;
    for (int j = 0; j < 3; ++j) {
      for (int k = 0; k < 3; ++k) sum += std::abs(linear[i][j]) * std::abs(inverse[j][k]);
    }
    largest = std::max(largest, sum);
  }
  condition = static_cast<float>(largest);
}

V3d Instance::exact_point(const V3d& p) const {
  return V3d(axes[0]) * p.x + V3d(axes[1]) * p.y + V3d(axes[2]) * p.z + V3d(at);
}

Bounds Instance::bounds(const Bounds& local) const {
  return local.with_corners_moved([this](const V3d& p) { return exact_point(p); });
}

}  // namespace lacuna
