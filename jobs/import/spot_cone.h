#pragma once

#include <algorithm>
#include <cmath>

namespace lacuna {

/// The inner cone (radians) with which a spot of glTF, whose intensity falls off as the square of
/// a ramp in the cosine, has the flux 2 pi `flux` per unit of intensity. `cos_outer`: of its rim.
inline double spot_inner_cone(double flux, double cos_outer) {
  // flux = (1 - ci) + (ci - co) / 3
  return std::acos(std::clamp(1.5 * (1 - flux) - cos_outer / 2, cos_outer, 1.0));
}

}  // namespace lacuna
