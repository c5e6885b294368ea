#include "jobs/import/daylight.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "jobs/import/spectrum.h"

namespace lacuna {
namespace {

constexpr double pi = std::numbers::pi, degree = pi / 180;

/// Days since noon of 1 January 2000, universal time (Blanco-Muriel 2001, sec. 3).
double days_since_2000(const PlaceAndTime& t, double universal_hours) {
  const int m = (t.month - 14) / 12;
  const int day = 1461 * (t.year + 4800 + m) / 4 + 367 * (t.month - 2 - 12 * m) / 12 -
                  3 * ((t.year + 4900 + m) / 100) / 4 + t.day - 32075;
  return day - 0.5 + universal_hours / 24 - 2451545;
}

// Of the appendix: the sun's radiance outside of the atmosphere, W / (m^2 sr nm), and absorption
// by ozone (1 / cm), by mixed gases and by water vapour.
constexpr std::array<double, 38> solar{
    16559.0, 16233.7, 21127.5, 25888.2, 25829.1, 24232.3, 26760.5, 29658.3, 30545.4, 30057.5,
    30663.7, 28830.4, 28712.1, 27825.0, 27100.6, 27233.6, 26361.3, 25503.8, 25060.2, 25311.6,
    25355.9, 25134.2, 24631.5, 24173.2, 23685.3, 23212.1, 22827.7, 22339.8, 21970.2, 21526.7,
    21097.9, 20728.3, 20240.4, 19870.8, 19427.2, 19072.4, 18628.9, 18259.2};
const Spectrum ozone{
    {355, 0},    {445, .003}, {450, .003}, {455, .004}, {460, .006}, {465, .008}, {470, .009},
    {475, .012}, {480, .014}, {485, .017}, {490, .021}, {495, .025}, {500, .03},  {505, .035},
    {510, .04},  {515, .045}, {520, .048}, {525, .057}, {530, .063}, {535, .07},  {540, .075},
    {545, .08},  {550, .085}, {555, .095}, {560, .103}, {565, .11},  {570, .12},  {575, .122},
    {580, .12},  {585, .118}, {590, .115}, {595, .12},  {600, .125}, {605, .13},  {610, .12},
    {620, .105}, {630, .09},  {640, .079}, {650, .067}, {660, .057}, {670, .048}, {680, .036},
    {690, .028}, {700, .023}, {710, .018}, {720, .014}, {730, .011}, {740, .01},  {750, .009}};
const Spectrum water{{689, 0}, {690, .016}, {700, .024}, {710, .0125},
                     {720, 1}, {730, .87},  {740, .061}, {750, .001}};

/// Perez's distribution of luminance or chromaticity: the five coefficients are linear in the
/// turbidity.
struct Perez {
  std::array<std::array<double, 2>, 5> linear;

  double at(double cos_zenith, double cos_sun, double turbidity) const {
    const auto c = [&](std::size_t i) { return linear[i][0] * turbidity + linear[i][1]; };
    const double sun = std::acos(std::clamp(cos_sun, -1.0, 1.0));
    return (1 + c(0) * std::exp(c(1) / std::max(cos_zenith, 0.01))) *
           (1 + c(2) * std::exp(c(3) * sun) + c(4) * cos_sun * cos_sun);
  }
};
constexpr Perez luminance_of_sky{
    {{{.1787, -1.4630}, {-.3554, .4275}, {-.0227, 5.3251}, {.1206, -2.5771}, {-.0670, .3703}}}};
constexpr Perez x_of_sky{
    {{{-.0193, -.2592}, {-.0665, .0008}, {-.0004, .2125}, {-.0641, -.8989}, {-.0033, .0452}}}};
constexpr Perez y_of_sky{
    {{{-.0167, -.2608}, {-.0950, .0092}, {-.0079, .2102}, {-.0441, -1.6537}, {-.0109, .0529}}}};

/// The chromaticity of the zenith: rows are powers of the turbidity from 2 to 0, columns those of
/// the sun's angle from the zenith from 3 to 0.
using ZenithMatrix = std::array<std::array<double, 4>, 3>;
constexpr ZenithMatrix zenith_x{{{.00166, -.00375, .00209, 0},
                                 {-.02903, .06377, -.03202, .00394},
                                 {.11693, -.21196, .06052, .25886}}};
constexpr ZenithMatrix zenith_y{{{.00275, -.00610, .00317, 0},
                                 {-.04214, .08970, -.04153, .00516},
                                 {.15346, -.26756, .06670, .26688}}};

double chromaticity(const ZenithMatrix& m, double t, double sun) {
  const auto row = [&](std::size_t i) {
    return ((m[i][0] * sun + m[i][1]) * sun + m[i][2]) * sun + m[i][3];
  };
  return (row(0) * t + row(1)) * t + row(2);
}

/// Of the zenith, cd / m^2.
double zenith_luminance(double t, double sun) {
  const double chi = (4.0 / 9 - t / 120) * (pi - 2 * sun);
  return 1000 * ((4.0453 * t - 4.9710) * std::tan(chi) - .2155 * t + 2.4192);
}

Rgb without_negatives(const Rgb& c) {
  return {std::max(0.0F, c.x), std::max(0.0F, c.y), std::max(0.0F, c.z)};
}

/// Adds the sun's disk by points on a spiral over it, each with an equal part of its power.
void add_sun(const Daylight& d, const M44d& to_world, LinearPicture& picture) {
  const double golden = pi * (3 - std::sqrt(5.0));  // the angle of Vogel's spiral
  const Rgb radiance = sun_radiance(std::acos(std::clamp(d.to_sun.y, -1.0, 1.0)), d.turbidity);
  const double flux = d.sun_scale * 2 * pi * (1 - std::cos(sun_radius));
  const double least_cos = std::cos(std::min(sun_radius * d.radius_scale, pi));
  constexpr double per_texel = 64, fewest = 4096;
  const int points = static_cast<int>(
      std::max(fewest, per_texel * (1 - least_cos) / 2 * picture.width * picture.height));
  const V3d aside =
      d.to_sun.cross(std::abs(d.to_sun.y) < .9 ? V3d(0, 1, 0) : V3d(1, 0, 0)).normalized();
  const V3d across = d.to_sun.cross(aside);
  for (int i = 0; i < points; ++i) {
    const double c = 1 - (1 - least_cos) * (i + .5) / points, s = std::sqrt(1 - c * c);
    V3d w;
    to_world.multDirMatrix(
        d.to_sun * c + (aside * std::cos(i * golden) + across * std::sin(i * golden)) * s, w);
    w.normalize();
    const double u = .5 + std::atan2(w.x, -w.z) / (2 * pi);
    const double theta = std::acos(std::clamp(w.y, -1.0, 1.0));
    const int x = std::clamp(static_cast<int>(u * picture.width), 0, picture.width - 1);
    const int y = std::clamp(static_cast<int>(theta / pi * picture.height), 0, picture.height - 1);
    const double texel =
        2 * pi / picture.width *
        (std::cos(pi * y / picture.height) - std::cos(pi * (y + 1) / picture.height));
    picture.pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width) +
                   static_cast<std::size_t>(x)] +=
        radiance * static_cast<float>(flux / points / texel);
  }
}

}  // namespace

V3d direction_to_sun(const PlaceAndTime& t) {
  const double hours = t.hours - t.timezone, days = days_since_2000(t, hours);
  const double omega = 2.1429 - .0010394594 * days;
  const double mean = 4.8950630 + .017202791698 * days, anomaly = 6.2400600 + .0172019699 * days;
  const double longitude = mean + .03341607 * std::sin(anomaly) +
                           .00034894 * std::sin(2 * anomaly) - .0001134 -
                           .0000203 * std::sin(omega);
  const double obliquity = .4090928 - 6.2140e-9 * days + .0000396 * std::cos(omega);
  const double ascension =
      std::atan2(std::cos(obliquity) * std::sin(longitude), std::cos(longitude));
  const double declination = std::asin(std::sin(obliquity) * std::sin(longitude));
  const double sidereal = 6.6974243242 + .0657098283 * days + hours;
  const double hour_angle = (sidereal * 15 + t.longitude) * degree - ascension;
  const double latitude = t.latitude * degree;
  double zenith = std::acos(std::cos(latitude) * std::cos(hour_angle) * std::cos(declination) +
                            std::sin(declination) * std::sin(latitude));
  const double azimuth =
      std::atan2(-std::sin(hour_angle), std::tan(declination) * std::cos(latitude) -
                                            std::sin(latitude) * std::cos(hour_angle));
  constexpr double earth_radius = 6371.01, sun_distance = 149597890;  // km
  zenith += earth_radius / sun_distance * std::sin(zenith);           // parallax
  return {std::sin(azimuth) * std::sin(zenith), std::cos(zenith),
          -std::cos(azimuth) * std::sin(zenith)};
}

Rgb sun_radiance(double from_zenith, double turbidity) {
  const double beta = .04608365822050 * turbidity - .04586025928522;
  const double mass =
      1 / (std::cos(from_zenith) + .15 * std::pow(93.885 - from_zenith / degree, -1.253));
  Spectrum arriving;
  for (std::size_t i = 0; i < solar.size(); ++i) {
    const double nm = 380 + 10 * static_cast<double>(i), um = nm / 1000;
    constexpr double ozone_cm = .35, vapour_cm = 2;
    const double vapour = value_at(water, nm) * vapour_cm * mass;
    const double depth = mass * .008735 * std::pow(um, -4.08) +  // Rayleigh
                         mass * beta * std::pow(um, -1.3) +      // aerosols
                         mass * value_at(ozone, nm) * ozone_cm +
                         .2385 * vapour / std::pow(1 + 20.07 * vapour, .45);
    arriving.emplace_back(nm, solar[i] * std::exp(-depth));
  }
  return without_negatives(rgb_of_spectrum(arriving, EqualEnergy::coloured));
}

Rgb sky_radiance(const V3d& direction, const V3d& to_sun, double turbidity) {
  if (direction.y <= 0) return Rgb(0);
  const double sun = std::acos(std::clamp(to_sun.y, 0.0, 1.0));
  const auto relative = [&](const Perez& p) {
    return p.at(direction.y, direction.dot(to_sun), turbidity) / p.at(1, std::cos(sun), turbidity);
  };
  const double x = chromaticity(zenith_x, turbidity, sun) * relative(x_of_sky);
  const double y = chromaticity(zenith_y, turbidity, sun) * relative(y_of_sky);
  const double luminance = zenith_luminance(turbidity, sun) * relative(luminance_of_sky);
  // A radiance of 1 W / (m^2 sr nm) at all wavelengths: 683 lm/W times the integral of y.
  constexpr double unit = 683 * 106.856895;
  const double scale = std::max(0.0, luminance) / unit / y;
  return without_negatives(rgb_of_xyz({scale * x, scale * y, scale * (1 - x - y)}));
}

LinearPicture daylight_picture(const Daylight& d, const M44d& to_world, int width) {
  LinearPicture out{width, width / 2, {}};
  const M44d to_sky = to_world.inverse();
  for (int y = 0; y < out.height; ++y) {
    for (int x = 0; x < out.width; ++x) {
      const double phi = 2 * pi * ((x + .5) / out.width - .5), theta = pi * (y + .5) / out.height;
      V3d w;
      to_sky.multDirMatrix(
          V3d(std::sin(theta) * std::sin(phi), std::cos(theta), -std::sin(theta) * std::cos(phi)),
          w);
      out.pixels.push_back(sky_radiance(w.normalized(), d.to_sun, d.turbidity) *
                           static_cast<float>(d.sky_scale));
    }
  }
  if (d.sun_scale > 0) add_sun(d, to_world, out);
  return out;
}

}  // namespace lacuna
