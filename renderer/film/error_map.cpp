#include "renderer/film/error_map.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace lacuna {

std::vector<float> error_map(ErrorMetric metric, const FlipPictures& pictures,
                             const ThreadPool* pool) {
  if (metric == ErrorMetric::flip) {
    return hdr_flip(pictures, flip_exposures(pictures.reference), pool);
  }
  const ErrorMetricRow& row = row_of(metric);
  const auto pixels = static_cast<std::size_t>(std::max(pictures.width, 0)) *
                      static_cast<std::size_t>(std::max(pictures.height, 0));
  if (row.term == nullptr || pixels == 0 || pictures.estimate.size() != 3 * pixels ||
      pictures.reference.size() != 3 * pixels) {
    throw std::invalid_argument("no error map: a metric without a map, or different sizes");
  }
  std::vector<float> map(pixels);
  for (std::size_t i = 0; i < pixels; ++i) {
    double sum = 0;
    for (std::size_t c = 3 * i; c < 3 * i + 3; ++c) {
      sum += row.term(pictures.estimate[c], pictures.reference[c]);
    }
    map[i] = static_cast<float>(row.root ? std::sqrt(sum / 3) : sum / 3);
  }
  return map;
}

double largest_shown_error(ErrorMetric metric, std::span<const float> map) {
  if (metric == ErrorMetric::flip || map.empty()) return 1;
  std::vector<float> sorted(map.begin(), map.end());
  std::erase_if(sorted, [](float v) { return !std::isfinite(v); });
  if (sorted.empty()) return 1;
  const auto rank =
      sorted.begin() +
      static_cast<std::ptrdiff_t>(std::ceil(0.99 * static_cast<double>(sorted.size()))) - 1;
  std::nth_element(sorted.begin(), rank, sorted.end());
  return *rank > 0 ? double{*rank} : 1;
}

std::array<std::uint8_t, 3> magma(double t) {
  // Fourteen equal parts, linear between these colours: at most two codes off.
  constexpr std::array<std::array<double, 3>, 15> colours{{{0, 0, 4},
                                                           {12, 9, 39},
                                                           {35, 17, 81},
                                                           {65, 15, 117},
                                                           {95, 24, 127},
                                                           {123, 35, 130},
                                                           {152, 45, 128},
                                                           {182, 54, 121},
                                                           {211, 67, 110},
                                                           {235, 87, 96},
                                                           {248, 118, 92},
                                                           {253, 153, 105},
                                                           {254, 186, 128},
                                                           {253, 220, 158},
                                                           {252, 253, 191}}};
  constexpr auto parts = static_cast<double>(colours.size() - 1);
  const double at = (t <= 0 ? 0 : t < 1 ? t : 1) * parts;
  const auto i = std::min(static_cast<std::size_t>(at), colours.size() - 2);
  const double f = at - static_cast<double>(i);
  std::array<std::uint8_t, 3> codes{};
  for (std::size_t c = 0; c < 3; ++c) {
    codes[c] =
        static_cast<std::uint8_t>(std::lround((1 - f) * colours[i][c] + f * colours[i + 1][c]));
  }
  return codes;
}

std::vector<std::uint8_t> magma_codes(std::span<const float> map, double largest) {
  std::vector<std::uint8_t> codes;
  codes.reserve(3 * map.size());
  for (const float v : map) {
    const auto c = magma(double{v} / largest);
    codes.insert(codes.end(), c.begin(), c.end());
  }
  return codes;
}

}  // namespace lacuna
