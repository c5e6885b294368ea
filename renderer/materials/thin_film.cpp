#include "renderer/materials/thin_film.h"

#include <numbers>

#include "renderer/materials/specular.h"

namespace lacuna {
namespace {

constexpr float pi_f = std::numbers::pi_v<float>;

float square(float x) { return x * x; }
/// Reflectance at normal incidence between two indices of refraction.
float f0_between(float a, float b) { return square((a - b) / (a + b)); }
float schlick(float f0, float cos) { return f0 + (1 - f0) * schlick_weight(cos); }

/// A Gaussian of the sensitivity of the eye over the wave number: its Fourier transform is one, too
/// (Belcour and Barla 2017, sec. 5 and supplement; numbers of the extension's text).
struct Gaussian {
  float area, centre, variance;
  /// At phase 2 pi OPD, OPD in metres.
  float at(float phase, float shift) const {
    return area * std::sqrt(2 * pi_f * variance) * std::cos(centre * phase + shift) *
           std::exp(-variance * phase * phase);
  }
};
constexpr Gaussian in_x{5.4856e-13F, 1.6810e6F, 4.3278e9F},
    in_x2{9.7470e-14F, 2.2399e6F, 4.5282e9F}, in_y{4.4201e-13F, 1.7953e6F, 9.3046e9F},
    in_z{5.2481e-13F, 2.2084e6F, 6.6121e9F};
constexpr float unit_sensitivity = 1.0685e-7F;

/// The mean over a channel's wavelengths of cos(2 pi opd / wavelength + shift), as linear Rec. 709.
Rgb interference(float opd_nm, const V3f& shift) {
  const float phase = 2 * pi_f * opd_nm * 1e-9F;
  const float x = (in_x.at(phase, shift.x) + in_x2.at(phase, shift.x)) / unit_sensitivity;
  const float y = in_y.at(phase, shift.y) / unit_sensitivity;
  const float z = in_z.at(phase, shift.z) / unit_sensitivity;
  return {3.2404542F * x - 1.5371385F * y - 0.4985314F * z,
          -0.9692660F * x + 1.8760108F * y + 0.0415560F * z,
          0.0556434F * x - 0.2040259F * y + 1.0572252F * z};
}

}  // namespace

Rgb ThinFilm::reflectance(float cos, const Rgb& f0) const {
  // A film much thinner than light's waves is none: its index becomes that of air.
  const float t = std::min(1.0F, thickness / 0.03F);
  const float index = 1 + (ior - 1) * t * t * (3 - 2 * t);
  const float cos2_inside = 1 - (1 - cos * cos) / (index * index);
  if (cos2_inside <= 0) return {1, 1, 1};
  const float inside = std::sqrt(cos2_inside);
  const float r12 = schlick(f0_between(index, 1), cos);  // air and film
  const float t121 = 1 - r12;
  Rgb r23, phase;  // film and base; the phases of both reflections
  for (int c = 0; c < 3; ++c) {
    const float root = std::sqrt(std::min(f0[c], 0.9999F));
    const float base = (1 + root) / (1 - root);
    r23[c] = schlick(f0_between(base, index), inside);
    phase[c] = pi_f + (base < index ? pi_f : 0.0F);
  }
  const float opd = 2 * index * thickness * inside;
  // Airy's series (eq. 3): its mean, and the first two orders of interference.
  Rgb sum, amplitude, ratio;
  for (int c = 0; c < 3; ++c) {
    const float r123 = std::clamp(r12 * r23[c], 1e-5F, 0.9999F);
    const float rest = t121 * t121 * r23[c] / (1 - r123);
    sum[c] = r12 + rest;
    amplitude[c] = rest - t121;
    ratio[c] = std::sqrt(r123);
  }
  for (int order = 1; order <= 2; ++order) {
    const auto m = static_cast<float>(order);
    amplitude *= ratio;
    sum += amplitude * (2.0F * interference(m * opd, m * phase));
  }
  const auto bounded = [](float r) { return std::clamp(r, 0.0F, 1.0F); };
  return {bounded(sum.x), bounded(sum.y), bounded(sum.z)};
}

float ThinFilm::schlick_bound(const Rgb& f0) const {
  constexpr int angles = 8;
  float bound = 0;
  for (int i = 1; i <= angles; ++i) {
    const float cos = static_cast<float>(i) / angles;
    const float weight = schlick_weight(cos);
    bound = std::max(bound, (max_component(reflectance(cos, f0)) - weight) / (1 - weight));
  }
  return bound;
}

}  // namespace lacuna
