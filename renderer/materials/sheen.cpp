#include "renderer/materials/sheen.h"

#include "renderer/core/sampling.h"
#include "renderer/materials/roughness_table.h"

namespace lacuna {
namespace {

/// The fit of Smith's function for Charlie's distribution (Estevez and Kulla 2017, sec. 3): log
/// Lambda at a cosine <= .5.
float log_lambda(float cos, float alpha) {
  const float t = (1 - alpha) * (1 - alpha);
  const auto mix = [t](float smooth, float rough) { return t * smooth + (1 - t) * rough; };
  const float a = mix(21.5473F, 25.3245F), b = mix(3.82987F, 3.32435F);
  const float c = mix(0.19823F, 0.16801F), d = mix(-1.97760F, -1.27393F);
  const float e = mix(-4.32054F, -4.85967F);
  return a / (1 + b * std::pow(cos, c)) + d * cos + e;
}

float lambda(float cos, float alpha) {
  if (cos < 0.5F) return std::exp(log_lambda(cos, alpha));
  return std::exp(2 * log_lambda(0.5F, alpha) - log_lambda(std::max(0.0F, 1 - cos), alpha));
}

/// D V cos_i.
float charlie(float cos_o, float cos_i, float sin2, float alpha) {
  const float inv = 1 / alpha;
  const float d = (2 + inv) * std::pow(std::max(sin2, 0.0F), 0.5F * inv) * (0.5F * inv_pi);
  return d / ((1 + lambda(cos_o, alpha) + lambda(cos_i, alpha)) * 4 * cos_o);
}

/// The integral of charlie() over the hemisphere, by the midpoint rule.
float albedo_of(float cos_o, float alpha) {
  alpha = std::max(alpha, sheen_min_alpha);
  cos_o = std::max(cos_o, 1e-3F);
  constexpr int n = 48;
  const float sin_o = std::sqrt(1 - cos_o * cos_o);
  double sum = 0;
  for (int i = 0; i < n; ++i) {
    const float cos_i = (static_cast<float>(i) + 0.5F) / n;
    const float sin_i = std::sqrt(1 - cos_i * cos_i);
    for (int j = 0; j < n; ++j) {
      const float phi = pi * (static_cast<float>(j) + 0.5F) / n;
      const float z = cos_o + cos_i;
      const float h2 = 2 + 2 * (cos_o * cos_i + sin_o * sin_i * std::cos(phi));
      sum += double(charlie(cos_o, cos_i, 1 - z * z / std::max(h2, z * z), alpha));
    }
  }
  return static_cast<float>(sum * 2 * double(pi) / (n * n));
}

RoughnessTable& albedo_table() {
  static RoughnessTable result(albedo_of);
  return result;
}

}  // namespace

Sheen::Sheen(const Rgb& color, float alpha)
    : color_(color), alpha_(std::max(alpha, sheen_min_alpha)) {
  if (is_black(color)) return;
  row_ = RoughnessTable::row(alpha_);
  albedo_table().need(row_);
}

float Sheen::albedo(float cos) const { return std::min(1.0F, albedo_table().at(row_, cos)); }

Rgb Sheen::eval(float cos_o, float cos_i, float sin2) const {
  const float most = std::max(albedo_table().at(row_, cos_o), albedo_table().at(row_, cos_i));
  return color_ * (charlie(cos_o, cos_i, sin2, alpha_) / std::max(1.0F, most));
}

}  // namespace lacuna
