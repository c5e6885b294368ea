#pragma once

#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "renderer/core/vec.h"

namespace lacuna {

/// Pairs of wavelength (nm, growing) and value, linear between them and 0 outside.
using Spectrum = std::vector<std::pair<double, double>>;

/// Its value at a wavelength.
double value_at(const Spectrum& spectrum, double nm);

/// X, Y and Z of the CIE to linear RGB of Rec. 709; components may be negative.
Rgb rgb_of_xyz(const V3d& xyz);

/// What a spectrum of value 1 everywhere becomes: the colour of equal energy, (1.205, .948, .909),
/// as for radiance; or white (each of X, Y, Z scaled), as reflectances are meant under daylight.
enum class EqualEnergy { coloured, white };

/// Linear RGB of Rec. 709 by the CIE's matching functions of 1931, each 5 nm, over the integral of
/// y: a spectrum of 1 has Y = 1. Components may be negative (saturated colours).
Rgb rgb_of_spectrum(const Spectrum& spectrum, EqualEnergy equal_energy);
/// The mean over 360 to 830 nm where the spectrum has values, as for an index of refraction.
double mean_of_spectrum(const Spectrum& spectrum);

/// Radiance of a black body per nm, W / (m^2 sr nm), as rgb_of_spectrum() gives it (coloured).
/// Negative components are 0.
Rgb blackbody_rgb(double kelvin);

/// A complex index of refraction, against vacuum.
struct MetalIndex {
  Rgb eta, k;
};
/// By the name of the element or compound in the tables of Mitsuba ("Au", "Cu", "TiN", "a-C"), in
/// RGB as Mitsuba 0.6 averages their spectra. None: no such metal.
std::optional<MetalIndex> metal_index(std::string_view name);

/// The index of refraction of a transparent material by its name ("bk7", "water", "air"), at 589
/// nm.
std::optional<double> dielectric_index(std::string_view name);

}  // namespace lacuna
