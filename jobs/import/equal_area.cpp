#include "jobs/import/equal_area.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lacuna {

V2d equal_area_square(const V3d& direction) {
  const double x = std::abs(direction.x), y = std::abs(direction.y), z = std::abs(direction.z);
  // Within one octant: the distance from the pole keeps areas, the angle runs along an edge.
  const double r = std::sqrt(std::max(1 - z, 0.0));
  const double along = x + y > 0 ? std::atan2(y, x) * 2 / std::numbers::pi : 0;
  double v = along * r, u = r - v;
  if (direction.z < 0) {  // the lower hemisphere is folded outwards
    std::swap(u, v);
    u = 1 - u;
    v = 1 - v;
  }
  return {(std::copysign(u, direction.x) + 1) / 2, (std::copysign(v, direction.y) + 1) / 2};
}

}  // namespace lacuna
