#include "jobs/import/spectrum.h"

#include <gtest/gtest.h>

#include <cmath>

#include "jobs/import/cie_1931.h"

namespace lacuna {
namespace {

void expect_rgb(const Rgb& found, const Rgb& expected, double relative) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], expected[c], relative * std::abs(expected[c]));
}

/// The tabulated integrals of the three functions, 106.857, are those of equal energy.
TEST(ImportedSpectrum, MatchingFunctionsHaveEqualIntegrals) {
  V3d sum(0, 0, 0);
  for (const V3d& m : cie_1931) sum += m * cie_1931_step;
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum[c], 106.857, .001);
}

TEST(ImportedSpectrum, EqualEnergyIsColouredOrWhite) {
  const Spectrum flat{{300, 2}, {900, 2}};
  expect_rgb(rgb_of_spectrum(flat, EqualEnergy::coloured), {2.4096F, 1.8966F, 1.8179F}, 5e-4);
  expect_rgb(rgb_of_spectrum(flat, EqualEnergy::white), {2, 2, 2}, 5e-4);
}

TEST(ImportedSpectrum, IsLinearBetweenItsPointsAndZeroOutside) {
  const Spectrum ramp{{450, 0}, {550, 1}, {650, 0}};
  Spectrum fine;
  for (int nm = 450; nm <= 650; ++nm) fine.emplace_back(nm, 1 - std::abs(nm - 550) / 100.0);
  expect_rgb(rgb_of_spectrum(ramp, EqualEnergy::coloured),
             rgb_of_spectrum(fine, EqualEnergy::coloured), 1e-6);
  const Rgb infrared = rgb_of_spectrum({{800, 5}, {900, 5}}, EqualEnergy::coloured);
  EXPECT_EQ(infrared, Rgb(0, 0, 0));
}

/// Luminance of a black body, by the closed forms of physics: at 6500 K the chromaticity is
/// (.3135, .3237) (Wyszecki and Stiles, table 1(3.11.)).
TEST(ImportedSpectrum, BlackBodyHasPlancksColour) {
  const Rgb rgb = blackbody_rgb(6500);
  // Back to XYZ by the inverse of the matrix (sRGB, IEC 61966-2-1).
  const double x = .412453 * rgb.x + .357580 * rgb.y + .180423 * rgb.z,
               y = .212671 * rgb.x + .715160 * rgb.y + .072169 * rgb.z,
               z = .019334 * rgb.x + .119193 * rgb.y + .950227 * rgb.z;
  EXPECT_NEAR(x / (x + y + z), .3135, 2e-4);
  EXPECT_NEAR(y / (x + y + z), .3237, 2e-4);
  // Planck's law at 555 nm, near which the observer's mean of it lies.
  const double l = 555e-9, c2 = 1.438776877e-2,
               planck = 1.191042972e-16 / (std::pow(l, 5) * std::expm1(c2 / (l * 6500))) * 1e-9;
  EXPECT_NEAR(y / planck, 1, .02);
  EXPECT_EQ(blackbody_rgb(1000).z, 0);  // outside of the gamut
}

TEST(ImportedSpectrum, MetalsAndGlassesByName) {
  const auto gold = metal_index("Au");
  ASSERT_TRUE(gold);
  EXPECT_EQ(gold->eta, Rgb(.143124F, .374956F, 1.442476F));
  EXPECT_TRUE(metal_index("Cu_palik"));
  EXPECT_FALSE(metal_index("Unobtainium"));
  EXPECT_EQ(dielectric_index("bk7"), 1.5046);
  EXPECT_EQ(dielectric_index("diamond"), 2.419);
  EXPECT_FALSE(dielectric_index("soup"));
  EXPECT_NEAR(mean_of_spectrum({{400, 1}, {500, 3}}), 2, 1e-12);
}

}  // namespace
}  // namespace lacuna
