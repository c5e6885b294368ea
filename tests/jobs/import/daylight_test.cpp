#include "jobs/import/daylight.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace lacuna {
namespace {

constexpr double turn = 2 * std::numbers::pi;
constexpr double lumens = 683 * 106.856895;  // of 1 W / nm at all wavelengths

double degrees_from_zenith(const V3d& to_sun) { return std::acos(to_sun.y) * 360 / turn; }

/// Solid angle of a texel times luminance, over the picture.
double power_of(const LinearPicture& p) {
  double sum = 0;
  for (int y = 0; y < p.height; ++y) {
    const double band = std::cos(turn / 2 * y / p.height) - std::cos(turn / 2 * (y + 1) / p.height);
    for (int x = 0; x < p.width; ++x) sum += luminance(p.at(x, y)) * band * turn / p.width;
  }
  return sum;
}

TEST(Daylight, TheSunStandsWhereAlmanacsHaveIt) {
  // Greenwich at noon of the March equinox of 2012, which was within 7 hours: the latitude from
  // the zenith, in the south, 7.4 minutes before it culminates.
  PlaceAndTime t{.latitude = 51.4779,
                 .longitude = 0,
                 .timezone = 0,
                 .year = 2012,
                 .month = 3,
                 .day = 20,
                 .hours = 12};
  EXPECT_NEAR(degrees_from_zenith(direction_to_sun(t)), 51.4779, 0.2);
  EXPECT_NEAR(direction_to_sun(t).x, std::sin(7.4 / 1440 * turn), 0.003) << "still in the east";
  EXPECT_GT(direction_to_sun(t).z, 0) << "in the south";
  t.hours = 18.2;
  EXPECT_LT(direction_to_sun(t).x, -0.99) << "sets in the west";
  EXPECT_NEAR(degrees_from_zenith(direction_to_sun(t)), 90, 1.5);
  // Tokyo at the June solstice: 23.44 degrees of declination.
  t = {};
  t.month = 6;
  t.day = 21;
  double highest = 180;
  for (t.hours = 11; t.hours < 12.5; t.hours += 0.05) {
    highest = std::min(highest, degrees_from_zenith(direction_to_sun(t)));
  }
  EXPECT_NEAR(highest, 35.6894 - 23.44, 0.02);
}

TEST(Daylight, SunAndSkyAreAsBrightAsMeasured) {
  // The sun's disk is 1.6e9 cd / m^2 overhead, redder and darker when it is low.
  const double high = luminance(sun_radiance(0, 2)) * lumens;
  EXPECT_NEAR(high, 1.6e9, 0.25e9);
  const Rgb low = sun_radiance(80 * turn / 360, 3), noon = sun_radiance(0, 3);
  EXPECT_LT(luminance(low), 0.5 * luminance(noon));
  EXPECT_GT(low.x / low.z, 1.5 * noon.x / noon.z);
  // A clear sky gives 10 to 30 klx to the ground, and is blue away from the sun.
  const V3d to_sun(std::sqrt(0.5), std::sqrt(0.5), 0);
  double lux = 0;
  constexpr int steps = 64;
  for (int i = 0; i < steps; ++i) {
    for (int j = 0; j < steps; ++j) {
      const double s = std::sqrt((i + .5) / steps), phi = turn * (j + .5) / steps;
      const V3d w(s * std::cos(phi), std::sqrt(1 - s * s), s * std::sin(phi));
      lux += luminance(sky_radiance(w, to_sun, 3)) * lumens * turn / 2 / (steps * steps);
    }
  }
  EXPECT_GT(lux, 10e3);
  EXPECT_LT(lux, 30e3);
  const Rgb away = sky_radiance({-std::sqrt(0.5), std::sqrt(0.5), 0}, to_sun, 2.5);
  EXPECT_GT(away.z, 1.3F * away.x);
  EXPECT_EQ(sky_radiance({0, -1, 0}, to_sun, 3), Rgb(0));
}

TEST(Daylight, APictureHasThePowerOfTheSunWhereItStands) {
  Daylight d;
  d.sky_scale = 0;
  d.to_sun = V3d(0.6, 0.5, -0.3).normalized();
  const double power = luminance(sun_radiance(std::acos(d.to_sun.y), d.turbidity)) * turn *
                       (1 - std::cos(sun_radius));
  for (const double radius : {1.0, 8.0}) {
    d.radius_scale = radius;
    M44d turned;
    turned.rotate(V3d(0.3, -1.1, 0.7));
    for (const M44d& m : {M44d(), turned}) {
      const LinearPicture p = daylight_picture(d, m, 256);
      EXPECT_NEAR(power_of(p) / power, 1, 1e-4);
      V3d w;
      m.multDirMatrix(d.to_sun, w);
      const int x = static_cast<int>((.5 + std::atan2(w.x, -w.z) / turn) * p.width);
      const int y = static_cast<int>(std::acos(w.y) / turn * 2 * p.height);
      EXPECT_GT(luminance(p.at(x, y)), 0);
    }
  }
}

}  // namespace
}  // namespace lacuna
