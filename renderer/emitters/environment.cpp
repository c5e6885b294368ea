#include "renderer/emitters/environment.h"

#include <numbers>

#include "renderer/core/sampling.h"

namespace lacuna {

Environment::Environment(int width, int height, std::vector<float> rgb, float scale, float rotation)
    : width_(width),
      height_(height),
      rgb_(std::move(rgb)),
      scale_(scale),
      cos_rotation_(std::cos(rotation)),
      sin_rotation_(std::sin(rotation)) {
  // The mean of a bilinear interpolant over a texel weights the texel and its neighbours by (1/8,
  // 6/8, 1/8) along each axis.
  constexpr std::array<double, 3> kernel{0.125, 0.75, 0.125};
  std::vector<double> weights(static_cast<std::size_t>(width));
  std::vector<double> of_rows;
  texels_.reserve(static_cast<std::size_t>(height));
  for (int y = 0; y < height; ++y) {
    double sum = 0;
    for (int x = 0; x < width; ++x) {
      double mean = 0;
      for (std::size_t j = 0; j < kernel.size(); ++j) {
        for (std::size_t i = 0; i < kernel.size(); ++i) {
          mean +=
              kernel[i] * kernel[j] *
              double(luminance(texel(x + static_cast<int>(i) - 1, y + static_cast<int>(j) - 1)));
        }
      }
      sum += weights[static_cast<std::size_t>(x)] = mean;
    }
    texels_.emplace_back(weights);
    of_rows.push_back(sum * texel_solid_angle(y));
    integral_ += of_rows.back();
  }
  rows_ = InversionTable(of_rows);
}

double Environment::texel_solid_angle(int y) const {
  const double top = std::cos(std::numbers::pi * y / height_);
  const double bottom = std::cos(std::numbers::pi * (y + 1) / height_);
  return 2 * std::numbers::pi / width_ * (top - bottom);
}

Rgb Environment::texel(int x, int y) const {
  x = (x % width_ + width_) % width_;
  y = std::clamp(y, 0, height_ - 1);
  const float* p = &rgb_[3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                              static_cast<std::size_t>(x))];
  return Rgb(p[0], p[1], p[2]) * scale_;
}

V2f Environment::to_image(const V3f& w) const {
  const float x = cos_rotation_ * w.x - sin_rotation_ * w.z;
  const float z = sin_rotation_ * w.x + cos_rotation_ * w.z;
  const float phi = std::atan2(x, -z);  // 0 at -z, increasing towards +x
  const float theta = std::acos(std::clamp(w.y, -1.0F, 1.0F));
  return {(phi / (2 * pi) + 0.5F) * static_cast<float>(width_),
          theta / pi * static_cast<float>(height_)};
}

Rgb Environment::radiance(const V3f& w) const {
  const V2f p = to_image(w) - V2f(0.5F, 0.5F);
  const float fx = std::floor(p.x);
  const float fy = std::floor(p.y);
  const int x = static_cast<int>(fx);
  const int y = static_cast<int>(fy);
  const float a = p.x - fx;
  const float b = p.y - fy;
  return (1 - b) * ((1 - a) * texel(x, y) + a * texel(x + 1, y)) +
         b * ((1 - a) * texel(x, y + 1) + a * texel(x + 1, y + 1));
}

Environment::Sample Environment::sample(const Rng::FinePoint& at) const {
  const auto high = static_cast<std::uint32_t>(at.x >> 32);
  const InversionTable::Sample row = rows_.sample(at.y);
  const InversionTable::Sample column = texels_[row.index].sample(high);
  // The remainders of the numbers place the direction within its texel.
  const double v = (double(at.y - row.begin) + 0.5) / double(row.count);
  const double rest = double(high - column.begin) + double(at.x & 0xffffffff) * 0x1p-32;
  const double u = rest / double(column.count);
  const double top = std::cos(std::numbers::pi * row.index / height_);
  const double bottom = std::cos(std::numbers::pi * (row.index + 1) / height_);
  const double cos_theta = top + v * (bottom - top);
  const double sin_theta = std::sqrt(std::max(0.0, 1 - cos_theta * cos_theta));
  const double phi = 2 * std::numbers::pi * ((column.index + u) / width_ - 0.5);
  const double local_x = sin_theta * std::sin(phi);
  const double local_z = -sin_theta * std::cos(phi);
  const double c = cos_rotation_;
  const double s = sin_rotation_;
  const V3f w(static_cast<float>(c * local_x + s * local_z), static_cast<float>(cos_theta),
              static_cast<float>(-s * local_x + c * local_z));
  return {w, pdf(column.index, row.index)};
}

float Environment::pdf(std::uint32_t x, std::uint32_t y) const {
  const double of_row = double(rows_.pmf(y).value);
  if (!(of_row > 0)) return 0;
  return static_cast<float>(of_row * double(texels_[y].pmf(x).value) /
                            texel_solid_angle(static_cast<int>(y)));
}

float Environment::pdf(const V3f& w) const {
  if (black()) return 0;
  const V2f p = to_image(w);
  const int x = std::clamp(static_cast<int>(p.x), 0, width_ - 1);
  const int y = std::clamp(static_cast<int>(p.y), 0, height_ - 1);
  return pdf(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y));
}

}  // namespace lacuna
