#include "renderer/materials/oren_nayar.h"

#include <algorithm>
#include <cmath>

#include "renderer/core/sampling.h"

namespace lacuna {

Rgb oren_nayar(const Rgb& albedo, float sigma, const V3f& n, const V3f& wo, const V3f& wi) {
  const float cos_o = std::clamp(dot(wo, n), 0.0F, 1.0F);
  const float cos_i = std::clamp(dot(wi, n), 0.0F, 1.0F);
  const float theta_o = std::acos(cos_o), theta_i = std::acos(cos_i);
  const float high = std::max(theta_o, theta_i), low = std::min(theta_o, theta_i);
  const V3f across_o = wo - cos_o * n, across_i = wi - cos_i * n;
  const float lengths2 = across_o.length2() * across_i.length2();
  const float cos_phi =
      lengths2 > 0 ? std::clamp(dot(across_o, across_i) / std::sqrt(lengths2), -1.0F, 1.0F) : 0.0F;

  const float s2 = sigma * sigma;
  const float c1 = 1 - 0.5F * s2 / (s2 + 0.33F);
  const float from_low = 2 * low * inv_pi;
  const float c2 = 0.45F * s2 / (s2 + 0.09F) *
                   (std::sin(high) - (cos_phi < 0 ? from_low * from_low * from_low : 0.0F));
  const float both = 4 * high * low * inv_pi * inv_pi;
  const float c3 = 0.125F * s2 / (s2 + 0.09F) * both * both;
  const float direct = c1 + cos_phi * c2 * std::tan(low) +
                       (1 - std::abs(cos_phi)) * c3 * std::tan(0.5F * (high + low));
  const float twice =
      std::max(0.0F, 0.17F * s2 / (s2 + 0.13F) * (1 - cos_phi * from_low * from_low));
  return albedo * (std::max(0.0F, direct) * Rgb(1, 1, 1) + twice * albedo);
}

}  // namespace lacuna
