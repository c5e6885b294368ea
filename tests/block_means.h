#pragma once

#include <algorithm>
#include <vector>

#include "renderer/film/image.h"

namespace lacuna {

/// How many blocks a picture is cut into for tests of means, across and down, at most.
inline constexpr int most_blocks = 4;

/// Means over as nearly equal blocks as the image's pixels make: [3 * block + channel], blocks row
/// by row. Those of each iteration are independent estimates, so that a test of means needs no more
/// than Student's.
inline std::vector<double> block_means(const Image& image) {
  const int across = std::min(most_blocks, image.width);
  const int down = std::min(most_blocks, image.height);
  std::vector<double> sums(std::size_t(3 * across * down)), pixels(sums.size());
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const int block = y * down / image.height * across + x * across / image.width;
      for (int c = 0; c < 3; ++c) {
        const auto i = static_cast<std::size_t>(3 * block + c);
        sums[i] += double(image.at(x, y)[c]);
        ++pixels[i];
      }
    }
  }
  for (std::size_t i = 0; i < sums.size(); ++i) sums[i] /= pixels[i];
  return sums;
}

}  // namespace lacuna
