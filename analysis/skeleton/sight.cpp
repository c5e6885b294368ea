#include "analysis/skeleton/sight.h"

#include <algorithm>
#include <array>
#include <cstdlib>

namespace lacuna {
namespace {

/// A walk along the line. Each coordinate leads from the middle of a voxel to a face between two,
/// so it changes by an odd number of halves, A, and the line crosses the planes across this axis at
/// (2 i + 1) / A of its length, i = 0 to (A - 1) / 2; the last one is at the corner.
class Walk {
 public:
  Walk(const Grid3<std::uint16_t>& l1, Imath::V3i voxel, Imath::V3i corner)
      : l1_(l1), voxel_(voxel), crossed_(0) {
    for (int a = 0; a < 3; ++a) {
      const int halves = 2 * corner[a] - 2 * voxel[a] - 1;
      side_[a] = halves > 0 ? 1 : -1;
      halves_[a] = std::abs(halves);
      if (halves_[a] > halves_[longest_]) longest_ = a;
    }
  }

  bool arrives() {
    int empty = l1_(voxel_);
    while (empty > 0) {
      if (!leap(empty)) {
        std::array<bool, 3> crosses;
        if (!next(crosses)) return true;
        if (!cross(crosses)) return false;
      }
      empty = l1_(voxel_);
    }
    return false;
  }

 private:
  /// Which planes the line crosses next, all at the same place; false if it is at the corner.
  bool next(std::array<bool, 3>& crosses) const {
    int first = 0;
    for (int a = 1; a < 3; ++a)
      if (order(a, first) < 0) first = a;
    for (int a = 0; a < 3; ++a) crosses[static_cast<std::size_t>(a)] = order(a, first) == 0;
    return 2 * crossed_[first] + 1 < halves_[first];
  }
  /// Below, equal to or above 0 where the next plane across a comes before, with, after that of b.
  std::int64_t order(int a, int b) const {
    return (2 * std::int64_t{crossed_[a]} + 1) * halves_[b] -
           (2 * std::int64_t{crossed_[b]} + 1) * halves_[a];
  }
  /// Where the line meets an edge or a corner, it touches all voxels around. False at the scene.
  bool cross(const std::array<bool, 3>& crosses) {
    const unsigned all = (crosses[0] ? 1u : 0u) | (crosses[1] ? 2u : 0u) | (crosses[2] ? 4u : 0u);
    for (unsigned part = 1; part < all; ++part)
      if ((part & ~all) == 0 && l1_(stepped(part)) == 0) return false;
    voxel_ = stepped(all);
    for (int a = 0; a < 3; ++a) crossed_[a] += static_cast<int>(all >> a & 1);
    return true;
  }
  Imath::V3i stepped(unsigned axes) const {
    Imath::V3i v = voxel_;
    for (int a = 0; a < 3; ++a) v[a] += (axes >> a & 1) != 0 ? side_[a] : 0;
    return v;
  }
  /// Crosses several planes at once where all voxels on the way are nearer than `empty`: m across
  /// the longest axis, and across another one as many as come no later, at most m A / A_longest
  /// + 1.
  bool leap(int empty) {
    const std::int64_t length = halves_[longest_];
    const std::int64_t sum = std::int64_t{halves_[0]} + halves_[1] + halves_[2];
    const std::int64_t left = (length - 1) / 2 - crossed_[longest_];
    const std::int64_t m = std::min((empty - 3) * length / sum, left);
    if (m < 2) return false;
    const std::int64_t at = 2 * (crossed_[longest_] + m) - 1;  // in 1 / length
    for (int a = 0; a < 3; ++a) {
      const auto now = static_cast<int>((at * halves_[a] + length) / (2 * length));
      voxel_[a] += side_[a] * (now - crossed_[a]);
      crossed_[a] = now;
    }
    return true;
  }

  const Grid3<std::uint16_t>& l1_;
  Imath::V3i voxel_;
  Imath::V3i crossed_;  // planes across each axis
  Imath::V3i side_;
  Imath::V3i halves_;
  int longest_ = 0;
};

}  // namespace

bool sees(const Grid3<std::uint16_t>& l1, Imath::V3i voxel, Imath::V3i corner) {
  return Walk(l1, voxel, corner).arrives();
}

}  // namespace lacuna
