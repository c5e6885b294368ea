#pragma once

#include <array>

#include "base/settings/field.h"

namespace lacuna {

/// The unit of the radius within which photons count.
enum class RadiusUnit { pixels, scene, absolute };

template <>
struct EnumTable<RadiusUnit> {
  static constexpr std::array<EnumValue<RadiusUnit>, 3> values{{
      {RadiusUnit::pixels, "pixels",
       "sides of a pixel, at the median distance of what the camera sees first"},
      {RadiusUnit::scene, "scene", "half the diagonal of the scene's box"},
      {RadiusUnit::absolute, "absolute", "units of the scene"},
  }};
};

/// The radius r_i of iteration i = 1, 2, ...: r_1 i^((alpha - 1) / 2) (Knaus and Zwicker 2011;
/// Georgiev et al. 2012, 5.4). It needs no memory: an iteration knows it from its number.
struct RadiusSettings {
  double radius = 4;
  RadiusUnit radius_unit = RadiusUnit::pixels;
  double alpha = 2.0 / 3;

  /// The radius, and with it the bias, vanishes.
  bool consistent() const { return alpha < 1; }
  bool operator==(const RadiusSettings&) const = default;
};

template <class V>
void describe_radius(V& v, RadiusSettings& s) {
  v("radius", s.radius,
    {.doc = "distance within which photons count, in the first iteration; never below 2^-18 of the "
            "scene's largest coordinate, where floats no longer tell points apart",
     .min = 0,
     .max = 1e15,
     .above_min = true});
  v("radius_unit", s.radius_unit, {.doc = "unit of `radius`"});
}

template <class V>
void describe_alpha(V& v, RadiusSettings& s) {
  v("alpha", s.alpha,
    {.doc = "how slowly the radius shrinks: that of iteration i is `radius` i^((alpha - 1) / 2). "
            "The variance falls as i^-alpha, the squared bias as i^(2 alpha - 2); 1: the radius is "
            "fixed, and the bias stays",
     .min = 0,
     .max = 1,
     .above_min = true});
}

/// How photons within the radius r count by their distance d.
enum class PhotonKernel { constant, cone, epanechnikov };

template <>
struct EnumTable<PhotonKernel> {
  static constexpr std::array<EnumValue<PhotonKernel>, 3> values{{
      {PhotonKernel::constant, "constant", "all alike"},
      {PhotonKernel::cone, "cone", "as 1 - d / r (Jensen 1996)"},
      {PhotonKernel::epanechnikov, "epanechnikov", "as 1 - d^2 / r^2"},
  }};
};

}  // namespace lacuna
