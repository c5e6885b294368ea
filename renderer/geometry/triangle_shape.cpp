#include "renderer/geometry/triangle_shape.h"

#include <algorithm>
#include <cmath>

namespace lacuna {

TriangleShape::TriangleShape(const Mesh& mesh, std::uint32_t triangle) {
  const auto& t = mesh.triangles[triangle];
  for (std::size_t k = 0; k < 3; ++k) corners[k] = mesh.positions[t[k]];
  const V3d n = normal();
  const double twice_area = n.length();
  ng = V3f(n.normalized());
  V3d sides;
  double along = 0;
  for (int i = 0; i < 3; ++i) {
    const auto [low, high] = std::minmax({corners[0][i], corners[1][i], corners[2][i]});
    sides[i] = double(high) - double(low);
    along += std::abs(double(ng[i])) * sides[i];
  }
  if (twice_area > 0) along += sides.x * sides.y * sides.z / twice_area;
  plane_error = static_cast<float>(0x1p-23 * along);
}

}  // namespace lacuna
