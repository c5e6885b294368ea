#pragma once

#include <numbers>

#include "jobs/import/linear_picture.h"
#include "renderer/core/vec.h"

namespace lacuna {

/// A place on earth and a local time, without daylight saving.
struct PlaceAndTime {
  double latitude = 35.6894, longitude = 139.6917;  ///< degrees, to the north and to the east
  double timezone = 9;                              ///< hours ahead of universal time
  int year = 2010, month = 7, day = 10;
  double hours = 15;  ///< of the day
};

// Coordinates of daylight: +y is up, +x is east, -z is north.

/// The unit direction to the sun (Blanco-Muriel et al. 2001, "Computing the Solar Vector"; within
/// half an arc minute from 1999 to 2015). It may point below the horizon.
V3d direction_to_sun(const PlaceAndTime& when);

/// Radiance of the sun's disk at an angle from the zenith (radians) through an atmosphere of that
/// turbidity (Preetham, Shirley and Smits 1999, app. A.1), W / (m^2 sr nm), as rgb_of_spectrum()
/// gives it.
Rgb sun_radiance(double from_zenith, double turbidity);

/// Radiance of a clear sky in the same unit; both directions are unit (Preetham, Shirley and Smits
/// 1999, app. A.2). Black below the horizon.
Rgb sky_radiance(const V3d& direction, const V3d& to_sun, double turbidity);

/// Radians: half the angle under which the sun is seen.
inline constexpr double sun_radius = 0.5358 / 2 * std::numbers::pi / 180;

/// A sky, a sun, or both.
struct Daylight {
  V3d to_sun{0, 1, 0};
  double turbidity = 3;  ///< [1, 10]
  double sky_scale = 1, sun_scale = 1;
  double radius_scale = 1;  ///< of the sun, whose power stays; above 0
};

/// `daylight`, turned by `to_world`, as an equirectangular picture whose middle shows -z of the
/// world, its left -x, and its top +y: one of a job with rotation 0.
LinearPicture daylight_picture(const Daylight& daylight, const M44d& to_world, int width);

}  // namespace lacuna
