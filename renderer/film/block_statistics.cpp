#include "renderer/film/block_statistics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace lacuna {

namespace {

struct Block {
  std::array<double, 3> a{}, b{}, variance{};
};

}  // namespace

BlockStatistics block_statistics(const PicturePair& pair, int size) {
  const auto& [a, b, variance, width, height] = pair;
  BlockStatistics s;
  std::vector<double> z;
  double sum_of_squares = 0;
  for (int y0 = 0; y0 + size <= height; y0 += size) {
    for (int x0 = 0; x0 + size <= width; x0 += size) {
      Block block;
      for (int y = y0; y < y0 + size; ++y) {
        for (int x = x0; x < x0 + size; ++x) {
          const auto pixel = 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                                  static_cast<std::size_t>(x));
          for (std::size_t c = 0; c < 3; ++c) {
            block.a[c] += a[pixel + c];
            block.b[c] += b[pixel + c];
            if (!variance.empty()) block.variance[c] += variance[pixel + c];
          }
        }
      }
      ++s.blocks;
      const double sum_a = block.a[0] + block.a[1] + block.a[2];
      const double sum_b = block.b[0] + block.b[1] + block.b[2];
      const double relative = sum_b != 0 ? std::abs(sum_a - sum_b) / std::abs(sum_b) : 0;
      if (relative > s.largest_relative) {
        s.largest_relative = relative;
        s.worst_x = x0;
        s.worst_y = y0;
      }
      for (std::size_t c = 0; c < 3; ++c) {
        const double difference = (block.a[c] - block.b[c]) / (double(size) * size);
        sum_of_squares += difference * difference;
        if (block.variance[c] > 0)
          z.push_back((block.a[c] - block.b[c]) / std::sqrt(block.variance[c]));
      }
    }
  }
  if (s.blocks > 0) s.rms = std::sqrt(sum_of_squares / (3.0 * s.blocks));
  if (z.empty()) return s;
  const auto n = static_cast<double>(z.size());
  for (const double v : z) s.z_mean += v / n;
  for (const double v : z) s.z_deviation += (v - s.z_mean) * (v - s.z_mean) / n;
  s.z_deviation = std::sqrt(s.z_deviation);
  s.z_beyond = static_cast<double>(
                   std::count_if(z.begin(), z.end(), [](double v) { return std::abs(v) > 1.96; })) /
               n;
  return s;
}

}  // namespace lacuna
