#include "renderer/many_lights/light_filter.h"

namespace lacuna {

LightFilter::LightFilter(const Image& image, const RandomLightsSettings& settings)
    : width_(image.width),
      height_(image.height),
      settings_(settings),
      pixels_(image.pixels.size()) {
  for (Pixel& p : pixels_) p.n = V3f(0.0F);
}

void LightFilter::add(const ShadingPoint& point, const V3d& light) {
  Pixel& p = pixels_[point.pixel];
  p.x = point.vertex->surface.x;
  p.n = point.vertex->side();
  p.reflected = point.vertex->throughput * point.vertex->bsdf->albedo();
  for (int k = 0; k < 3; ++k) {
    // Skip a channel whose mean reflectance is zero: it reflects hardly any light.
    p.light[k] += p.reflected[k] > 0 ? light[k] / double(p.reflected[k]) : 0;
  }
}

float LightFilter::weight(const Pixel& middle, const Pixel& other) const {
  const float cosine = middle.n.dot(other.n);
  if (!(cosine > 0)) return 0;
  const V3f d = other.x - middle.x;
  const float distance = d.length();
  const float slope = distance > 0 ? d.dot(middle.n) / distance : 0;
  const float off = slope / static_cast<float>(settings_.filter_slope);
  return std::pow(cosine, static_cast<float>(settings_.filter_normal)) *
         std::exp(-0.5F * off * off);
}

V3d LightFilter::at(V2i pixel) const {
  const auto index = [&](int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(x);
  };
  const Pixel& middle = pixels_[index(pixel.x, pixel.y)];
  if (middle.n == V3f(0.0F)) return {0, 0, 0};
  V3d sum(0, 0, 0);
  double weights = 0;
  const int r = settings_.filter_radius;
  for (int y = std::max(0, pixel.y - r); y <= std::min(height_ - 1, pixel.y + r); ++y) {
    for (int x = std::max(0, pixel.x - r); x <= std::min(width_ - 1, pixel.x + r); ++x) {
      const Pixel& other = pixels_[index(x, y)];
      const auto w = static_cast<double>(weight(middle, other));
      if (w == 0) continue;
      sum += other.light * w;
      weights += w;
    }
  }
  return weights > 0 ? V3d(middle.reflected) * (sum / weights) : V3d(0, 0, 0);
}

}  // namespace lacuna
