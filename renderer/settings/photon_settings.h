#pragma once

#include <array>

#include "base/settings/field.h"

namespace lacuna {

/// The unit of the radius within which photons are counted.
enum class RadiusUnit { pixels, scene, absolute };

template <>
struct EnumTable<RadiusUnit> {
  static constexpr std::array<EnumValue<RadiusUnit>, 3> values{{
      {RadiusUnit::pixels, "pixels", "sides of a pixel, at the median distance of the first hits"},
      {RadiusUnit::scene, "scene", "half the diagonal of the scene's box"},
      {RadiusUnit::absolute, "absolute", "units of the scene"},
  }};
};

/// The radius r_i of iteration i = 1, 2, ...: r_1 i^((alpha - 1) / 2) (Knaus and Zwicker 2011;
/// Georgiev et al. 2012, 5.4). It follows from the iteration's index alone.
struct RadiusSettings {
  double radius = 4;
  RadiusUnit radius_unit = RadiusUnit::pixels;
  double alpha = 2.0 / 3;

  /// Whether the radius, and with it the bias, vanishes.
  bool consistent() const { return alpha < 1; }
  bool operator==(const RadiusSettings&) const = default;
};

template <class V>
void describe_radius(V& v, RadiusSettings& s) {
  v("radius", s.radius,
    {.doc = "distance within which photons are counted, in the first iteration; at least 2^-18 of "
            "the scene's largest coordinate, the resolution of floats",
     .min = 0,
     .max = 1e15,
     .above_min = true});
  v("radius_unit", s.radius_unit, {.doc = "unit of `radius`"});
}

template <class V>
void describe_alpha(V& v, RadiusSettings& s) {
  v("alpha", s.alpha,
    {.doc = "how slowly the radius shrinks: in iteration i it is `radius` i^((alpha - 1) / 2). The "
            "variance falls as i^-alpha, the squared bias as i^(2 alpha - 2); 1: the radius is "
            "fixed, and the bias remains",
     .min = 0,
     .max = 1,
     .above_min = true});
}

/// The weight of a photon at distance d within the radius r.
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
