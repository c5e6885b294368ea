#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

namespace lacuna {

// The colours of FLIP (Andersson et al. 2020, section 4.1). All loops over pixels call these, so
// they hold nothing that a compiler cannot turn into SIMD.

struct FlipColour {
  float x, y, z;
};

namespace flip_colour {

/// White of D65, in CIE XYZ.
inline constexpr float white_x = 0.950428545F, white_z = 1.088900371F;

/// Linear RGB of Rec. 709 to XYZ over that of white.
inline FlipColour relative_xyz(float r, float g, float b) {
  return {(0.412386563F * r + 0.357591491F * g + 0.180450491F * b) / white_x,
          0.212636822F * r + 0.715182982F * g + 0.072180196F * b,
          (0.019330620F * r + 0.119197164F * g + 0.950372587F * b) / white_z};
}
/// Its inverse.
inline FlipColour linear_rgb(const FlipColour& relative) {
  const float x = relative.x * white_x, y = relative.y, z = relative.z * white_z;
  return {3.241003275F * x - 1.537398934F * y - 0.498615861F * z,
          -0.969224334F * x + 1.875930071F * y + 0.041554224F * z,
          0.055639423F * x - 0.204011202F * y + 1.057148933F * z};
}

/// The cube root of a value in [0, 1.1], to three units in the last place: a first guess from the
/// exponent, and three steps of Newton.
inline float cube_root(float v) {
  const auto bits = static_cast<float>(std::bit_cast<std::int32_t>(v)) / 3;
  float r = std::bit_cast<float>(static_cast<std::int32_t>(bits) + 709921077);
  for (int i = 0; i < 3; ++i) r = (2 * r + v / (r * r)) / 3;
  return r;
}

/// CIE L*a*b* of XYZ over that of white, with the chroma times L* / 100 (Hunt effect).
inline FlipColour hunt_lab(const FlipColour& relative) {
  const auto f = [](float v) {
    constexpr float delta = 6.0F / 29;
    const float root = cube_root(std::max(v, delta * delta * delta));
    return v > delta * delta * delta ? root : v / (3 * delta * delta) + 4.0F / 29;
  };
  const float fx = f(relative.x), fy = f(relative.y), fz = f(relative.z);
  const float lightness = 116 * fy - 16;
  return {lightness, 0.01F * lightness * 500 * (fx - fy), 0.01F * lightness * 200 * (fy - fz)};
}

/// The hybrid distance of two colours (HyAB, Abasi et al. 2020).
inline float hyab(const FlipColour& p, const FlipColour& q) {
  const float a = p.y - q.y, b = p.z - q.z;
  return std::abs(p.x - q.x) + std::sqrt(a * a + b * b);
}

/// The approximation of ACES by Narkowicz, (p0 x^2 + p1 x) / (q0 x^2 + q1 x + q2), without its
/// factor of exposure (2021, section 4.2).
inline constexpr double aces_p0 = 0.36 * 2.51, aces_p1 = 0.6 * 0.03, aces_q0 = 0.36 * 2.43,
                        aces_q1 = 0.6 * 0.59, aces_q2 = 0.14;
inline float aces(float x) {
  x = std::min(std::max(x, 0.0F), 1e4F);  // from 12 on it is above 1
  const float y = (static_cast<float>(aces_p0) * x + static_cast<float>(aces_p1)) * x /
                  ((static_cast<float>(aces_q0) * x + static_cast<float>(aces_q1)) * x +
                   static_cast<float>(aces_q2));
  return std::min(y, 1.0F);
}

}  // namespace flip_colour

}  // namespace lacuna
