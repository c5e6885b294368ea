#pragma once

#include <cstdint>
#include <cstring>
#include <vector>

#include "analysis/space/bit_rows.h"

namespace lacuna {

/// Distances along one line of x: the first pass of every distance map.
class LineDistance {
 public:
  explicit LineDistance(int width)
      : bits_(width),
        half_((static_cast<std::size_t>(width) + 1) / 2),
        up_(half_),
        down_(half_),
        width_(static_cast<std::size_t>(width)) {
    for (std::size_t i = 0; i < half_; ++i) {
      up_[i] = static_cast<std::uint16_t>(i + 1);
      down_[i] = static_cast<std::uint16_t>(half_ - i);
    }
  }

  /// Writes `out[x]`, the distance along the row to the nearest 0 bit, both ends of the row
  /// included; 0 where the bit is 0.
  void operator()(const BitGrid3& domain, int y, int z, std::uint16_t* out) {
    bits_.read(domain, y, z);
    std::memset(out, 0, width_ * sizeof *out);
    bits_.for_each_run([&](int x0, int x1) {
      const auto length = static_cast<std::size_t>(x1 - x0), falling = length / 2;
      const std::size_t rising = length - falling;
      std::memcpy(out + x0, up_.data(), rising * sizeof *out);
      std::memcpy(out + x1 - falling, down_.data() + (half_ - falling), falling * sizeof *out);
    });
  }

 private:
  BitRow bits_;
  std::size_t half_;
  std::vector<std::uint16_t> up_, down_;  // 1, 2, ... half; half, ... 2, 1
  std::size_t width_;
};

}  // namespace lacuna
