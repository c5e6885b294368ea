#include "jobs/import/spectrum.h"

#include <algorithm>
#include <cmath>

#include "jobs/import/cie_1931.h"

namespace lacuna {
namespace {

/// X, Y and Z of f(wavelength), over the integral of y. Each interval of the table is integrated
/// with the matching functions linear in it, at 1 nm.
template <class F>
V3d xyz_of(F&& f) {
  V3d sum(0, 0, 0);
  double y = 0;
  constexpr int steps = static_cast<int>(cie_1931_step);
  for (std::size_t i = 0; i + 1 < cie_1931.size(); ++i) {
    for (int s = 0; s < steps; ++s) {
      const double t = (s + .5) / steps,
                   nm = cie_1931_from + cie_1931_step * (static_cast<double>(i) + t);
      const V3d matching = cie_1931[i] * (1 - t) + cie_1931[i + 1] * t;
      sum += matching * f(nm);
      y += matching.y;
    }
  }
  return sum / y;
}

/// Planck's law per nm.
double planck(double nm, double kelvin) {
  constexpr double c = 299792458, h = 6.62607015e-34, k = 1.380649e-23;  // SI, exact since 2019
  const double l = nm * 1e-9;
  return 2 * h * c * c / (std::pow(l, 5) * std::expm1(h * c / (l * k * kelvin))) * 1e-9;
}

}  // namespace

// ITU-R BT.709-6 with white D65, in the digits of Mitsuba.
Rgb rgb_of_xyz(const V3d& c) {
  return Rgb(V3f(V3d(3.240479 * c.x - 1.537150 * c.y - 0.498535 * c.z,
                     -0.969256 * c.x + 1.875991 * c.y + 0.041556 * c.z,
                     0.055648 * c.x - 0.204043 * c.y + 1.057311 * c.z)));
}

double value_at(const Spectrum& spectrum, double nm) {
  const auto above = std::lower_bound(spectrum.begin(), spectrum.end(), nm,
                                      [](const auto& s, double at) { return s.first < at; });
  if (above == spectrum.end()) return 0;
  if (above->first == nm) return above->second;
  if (above == spectrum.begin()) return 0;
  const auto below = above - 1;
  const double t = (nm - below->first) / (above->first - below->first);
  return below->second + t * (above->second - below->second);
}

Rgb rgb_of_spectrum(const Spectrum& spectrum, EqualEnergy equal_energy) {
  V3d xyz = xyz_of([&](double nm) { return value_at(spectrum, nm); });
  if (equal_energy == EqualEnergy::white) {
    const V3d flat = xyz_of([](double) { return 1.0; }), d65(.950456, 1, 1.089058);
    xyz = {xyz.x / flat.x * d65.x, xyz.y, xyz.z / flat.z * d65.z};
  }
  return rgb_of_xyz(xyz);
}

double mean_of_spectrum(const Spectrum& spectrum) {
  double sum = 0;
  int count = 0;
  for (int nm = 360; nm <= 830; ++nm) {
    if (spectrum.empty() || nm < spectrum.front().first || nm > spectrum.back().first) continue;
    sum += value_at(spectrum, nm);
    ++count;
  }
  if (count > 0) return sum / count;
  for (const auto& s : spectrum) sum += s.second;
  return spectrum.empty() ? 0 : sum / static_cast<double>(spectrum.size());
}

Rgb blackbody_rgb(double kelvin) {
  const Rgb rgb = rgb_of_xyz(xyz_of([&](double nm) { return planck(nm, kelvin); }));
  return {std::max(0.0F, rgb.x), std::max(0.0F, rgb.y), std::max(0.0F, rgb.z)};
}

}  // namespace lacuna
