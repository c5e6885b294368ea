#include "renderer/geometry/triangle_shape.h"

#include <algorithm>
#include <cmath>

namespace lacuna {

namespace {

std::array<V3f, 3> corners_of(const Mesh& mesh, std::uint32_t triangle) {
  std::array<V3f, 3> corners;
  for (std::size_t k = 0; k < 3; ++k) corners[k] = mesh.positions[mesh.triangles[triangle][k]];
  return corners;
}

}  // namespace

TriangleShape::TriangleShape(const Mesh& mesh, std::uint32_t triangle)
    : TriangleShape(corners_of(mesh, triangle)) {}

TriangleShape::TriangleShape(const TriangleShape& shape, const Instance& instance)
    : TriangleShape({instance.point(shape.corners[0]), instance.point(shape.corners[1]),
                     instance.point(shape.corners[2])}) {
  plane_error = shape.plane_error * instance.stretch + instance.ray_error;
}

V2f TriangleShape::barycentric(const V3f& x) const {
  const V3d n = normal(), step = V3d(x) - V3d(corners[0]);
  const V3d scaled = n / n.length2();
  return {static_cast<float>(step.cross(edge(2)).dot(scaled)),
          static_cast<float>(edge(1).cross(step).dot(scaled))};
}

TriangleShape::TriangleShape(const std::array<V3f, 3>& at) : corners(at) {
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
