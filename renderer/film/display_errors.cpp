#include "renderer/film/display_errors.h"

#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "renderer/film/preview.h"

namespace lacuna {

namespace {

using Channel = std::vector<double>;

/// BT.601 luma of sRGB codes, which the authors of SSIM use.
Channel luma(std::span<const double> codes) {
  Channel y(codes.size() / 3);
  for (std::size_t i = 0; i < y.size(); ++i) {
    y[i] = 0.299 * codes[3 * i] + 0.587 * codes[3 * i + 1] + 0.114 * codes[3 * i + 2];
  }
  return y;
}

/// A Gaussian of standard deviation 1.5 pixels over 11 x 11 pixels, truncated at the borders of the
/// picture.
class Blur {
 public:
  Blur(int width, int height) : width_(width), height_(height) {
    for (int k = -reach; k <= reach; ++k) at(k) = std::exp(-k * k / (2 * 1.5 * 1.5));
  }
  Channel operator()(const Channel& in) const {
    return along(along(in, 1, width_), width_, height_);
  }

 private:
  static constexpr int reach = 5;
  double& at(int k) { return weights_[static_cast<std::size_t>(k + reach)]; }
  double weight(int k) const { return weights_[static_cast<std::size_t>(k + reach)]; }

  /// Filters one dimension: `n` values, `step` apart.
  Channel along(const Channel& in, int step, int n) const {
    Channel out(in.size());
    for (std::size_t i = 0; i < in.size(); ++i) {
      const int place = static_cast<int>(i) / step % n;
      double sum = 0;
      double all = 0;
      for (int k = std::max(-reach, -place); k <= std::min(reach, n - 1 - place); ++k) {
        sum += weight(k) * in[static_cast<std::size_t>(static_cast<int>(i) + k * step)];
        all += weight(k);
      }
      out[i] = sum / all;
    }
    return out;
  }

  int width_, height_;
  std::array<double, 2 * reach + 1> weights_{};
};

Channel product(const Channel& a, const Channel& b) {
  Channel p(a.size());
  for (std::size_t i = 0; i < p.size(); ++i) p[i] = a[i] * b[i];
  return p;
}

double similarity(const Channel& a, const Channel& b, int width, int height) {
  const Blur blur(width, height);
  const Channel mean_a = blur(a);
  const Channel mean_b = blur(b);
  const Channel aa = blur(product(a, a));
  const Channel bb = blur(product(b, b));
  const Channel ab = blur(product(a, b));
  constexpr double c1 = 0.01 * 255 * 0.01 * 255;
  constexpr double c2 = 0.03 * 255 * 0.03 * 255;
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double m = mean_a[i] * mean_b[i];
    const double m2 = mean_a[i] * mean_a[i] + mean_b[i] * mean_b[i];
    sum += (2 * m + c1) * (2 * (ab[i] - m) + c2) / ((m2 + c1) * (aa[i] + bb[i] - m2 + c2));
  }
  return sum / static_cast<double>(a.size());
}

Channel shown(std::span<const double> rgb, double exposure) {
  Channel codes;
  codes.reserve(rgb.size());
  for (const double v : rgb) codes.push_back(double(display_code(v * exposure)));
  return codes;
}

}  // namespace

DisplayErrors display_errors(std::span<const double> estimate, std::span<const double> reference,
                             int width, int height, double exposure) {
  const auto size = 3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  if (estimate.size() != size || reference.size() != size || size == 0) {
    throw std::invalid_argument("the two pictures have different sizes");
  }
  const Channel a = shown(estimate, exposure);
  const Channel b = shown(reference, exposure);
  DisplayErrors e;
  for (std::size_t i = 0; i < size; ++i) e.mse += (a[i] - b[i]) * (a[i] - b[i]);
  e.mse /= static_cast<double>(size);
  e.psnr =
      e.mse > 0 ? 10 * std::log10(255.0 * 255.0 / e.mse) : std::numeric_limits<double>::infinity();
  e.ssim = similarity(luma(a), luma(b), width, height);
  return e;
}

}  // namespace lacuna
