#include "analysis/skeleton/sight.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdlib>

namespace lacuna {
namespace {

/// Traverses the voxels along the line. Each coordinate goes from the middle of a voxel to a face
/// between two, so it changes by an odd number A of halves, and the line crosses the planes across
/// this axis at (2 i + 1) / A of its length, the last at the corner. Positions on the line are
/// integers, in units of 1 / (A_x A_y A_z).
class Walk {
 public:
  Walk(const Grid3<std::uint16_t>& l1, Imath::V3i voxel, Imath::V3i corner,
       std::int64_t squared_radius)
      : here_(l1.data() + l1.index(voxel)) {
    const Imath::V3i size = l1.size();
    const std::array<std::ptrdiff_t, 3> along{1, size.x, std::ptrdiff_t{size.x} * size.y};
    const Imath::V3i halves = 2 * corner - 2 * voxel - Imath::V3i(1);
    std::array<std::int64_t, 3> length;
    for (std::size_t a = 0; a < 3; ++a) {
      const int n = halves[static_cast<int>(a)];
      length[a] = std::abs(n);
      step_[a] = n > 0 ? along[a] : -along[a];
    }
    for (std::size_t a = 0; a < 3; ++a) {
      next_[a] = length[(a + 1) % 3] * length[(a + 2) % 3];
      apart_[a] = 2 * next_[a];
    }
    end_ = length[0] * next_[0];
    planes_ =
        static_cast<double>(length[0] + length[1] + length[2]) / (2 * static_cast<double>(end_));
    if (squared_radius == 0) return;
    // The line ends where it enters the ball, rounded up.
    const std::int64_t length2 =
        length[0] * length[0] + length[1] * length[1] + length[2] * length[2];
    const double inside =
        std::sqrt(4 * static_cast<double>(squared_radius) / static_cast<double>(length2));
    const double outside = (1 - inside + 1e-12) * static_cast<double>(end_);
    end_ = std::min(end_, std::max(std::int64_t{0}, static_cast<std::int64_t>(outside) + 1));
  }

  bool arrives() {
    for (;;) {
      if (*here_ == 0) return false;
      if (*here_ >= worth_a_leap && leap()) return true;
      at_ = std::min({next_[0], next_[1], next_[2]});
      if (at_ >= end_) return true;
      if (!cross()) return false;
    }
  }

 private:
  static constexpr int worth_a_leap = 12;

  /// Steps into the next voxel. At an edge or a corner the line touches all voxels around; false if
  /// one of them, other than the next, is scene.
  bool cross() {
    const std::array<std::int64_t, 3> crossed{-std::int64_t{next_[0] == at_},
                                              -std::int64_t{next_[1] == at_},
                                              -std::int64_t{next_[2] == at_}};  // 0 or all bits
    const auto all = static_cast<unsigned>((crossed[0] & 1) | (crossed[1] & 2) | (crossed[2] & 4));
    if ((all & (all - 1)) != 0) [[unlikely]]
      for (unsigned part = 1; part < all; ++part)
        if ((part & ~all) == 0 && *stepped(part) == 0) return false;
    // The axis is unpredictable: no branches.
    here_ += (crossed[0] & step_[0]) + (crossed[1] & step_[1]) + (crossed[2] & step_[2]);
    for (std::size_t a = 0; a < 3; ++a) next_[a] += crossed[a] & apart_[a];
    return true;
  }
  const std::uint16_t* stepped(unsigned axes) const {
    const std::uint16_t* p = here_;
    for (unsigned a = 0; a < 3; ++a) p += (axes >> a & 1) != 0 ? step_[a] : 0;
    return p;
  }
  /// Crosses as many planes at once as the distance to the scene allows: in a stretch of length s
  /// at most s / apart + 1 across each axis. True if this reaches the end.
  bool leap() {
    at_ += static_cast<std::int64_t>((*here_ - 4) / planes_);
    if (at_ >= end_) return true;
    for (std::size_t a = 0; a < 3; ++a) {
      if (next_[a] > at_) continue;
      const std::int64_t n = (at_ - next_[a]) / apart_[a] + 1;
      here_ += n * step_[a];
      next_[a] += n * apart_[a];
    }
    return false;
  }

  const std::uint16_t* here_;
  std::int64_t at_ = 0, end_;
  std::array<std::int64_t, 3> next_;   // position of the next plane across each axis
  std::array<std::int64_t, 3> apart_;  // between two such positions
  std::array<std::ptrdiff_t, 3> step_;
  double planes_;  // crossed in a stretch of length 1, on average
};

}  // namespace

bool sees(const Grid3<std::uint16_t>& l1, Imath::V3i voxel, Imath::V3i corner,
          std::int64_t squared_radius) {
  return Walk(l1, voxel, corner, squared_radius).arrives();
}

}  // namespace lacuna
