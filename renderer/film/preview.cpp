#include "renderer/film/preview.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/storage/atomic_file.h"
#include "renderer/images/png_write.h"

namespace lacuna {

unsigned char display_code(double linear) {
  if (!(linear > 0)) return 0;
  const double v = std::min(linear, 1.0);
  const double s = v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
  return static_cast<unsigned char>(std::lround(s * 255));
}

double preview_exposure(std::span<const double> rgb) {
  std::vector<double> luminances;
  luminances.reserve(rgb.size() / 3);
  for (std::size_t i = 0; i + 2 < rgb.size(); i += 3) {
    const double y = 0.2126 * rgb[i] + 0.7152 * rgb[i + 1] + 0.0722 * rgb[i + 2];
    if (std::isfinite(y) && y > 0) luminances.push_back(y);
  }
  if (luminances.empty()) return 1;
  const auto rank = static_cast<std::ptrdiff_t>(static_cast<double>(luminances.size() - 1) * 0.95);
  std::nth_element(luminances.begin(), luminances.begin() + rank, luminances.end());
  return 0.8 / luminances[static_cast<std::size_t>(rank)];
}

std::string preview_png(int width, int height, std::span<const double> rgb, double exposure) {
  std::vector<unsigned char> bytes(rgb.size());
  std::transform(rgb.begin(), rgb.end(), bytes.begin(),
                 [&](double v) { return display_code(v * exposure); });
  return encode_png(width, height, bytes);
}

void write_preview(const std::filesystem::path& file, int width, int height,
                   std::span<const double> rgb) {
  write_file_atomically(file, preview_png(width, height, rgb, preview_exposure(rgb)));
}

}  // namespace lacuna
