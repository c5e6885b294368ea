#include "analysis/skeleton/ball_radius.h"

#include <algorithm>
#include <bit>
#include <limits>

namespace lacuna {
namespace {

/// The least distance along one axis from lattice position p to the closed voxels [a, b).
int gap(int p, int a, int b) { return a >= p ? a - p : b <= p ? p - b : 0; }

/// Looks for the nearest scene voxel in boxes of voxels, halved again and again. A box is left out
/// if it lies no nearer than what was found, or if the ball of L1 distance around its middle voxel
/// shows that it is empty.
class Search {
 public:
  Search(const Grid3<std::uint16_t>& l1, Imath::V3i corner, std::int64_t best)
      : l1_(l1), corner_(corner), best_(best) {}

  std::int64_t best() const { return best_; }

  /// Those voxels of [low, low + side) that are in the grid. `side` is a power of two.
  void visit(Imath::V3i low, int side) {
    std::int64_t distance2 = 0;
    int reach = 0;  // L1, from the middle to the farthest voxel
    Imath::V3i middle;
    for (int a = 0; a < 3; ++a) {
      const int from = std::max(low[a], 0), to = std::min(low[a] + side, l1_.size()[a]);
      if (from >= to) return;
      const std::int64_t g = gap(corner_[a], from, to);
      distance2 += g * g;
      middle[a] = (from + to) / 2;
      reach += std::max(middle[a] - from, to - 1 - middle[a]);
    }
    if (distance2 >= best_) return;
    const int empty = l1_(middle);
    if (empty > reach) return;
    if (side == 1) {
      best_ = distance2;
      return;
    }
    const int half = side / 2;
    unsigned nearest = 0;
    for (int a = 0; a < 3; ++a) nearest |= (corner_[a] > low[a] + half ? 1u : 0u) << a;
    for (unsigned i = 0; i < 8; ++i) {
      const unsigned child = i ^ nearest;
      visit(low + half * Imath::V3i(child & 1, child >> 1 & 1, child >> 2), half);
    }
  }

 private:
  const Grid3<std::uint16_t>& l1_;
  const Imath::V3i corner_;
  std::int64_t best_;
};

}  // namespace

std::int64_t squared_ball_radius(const Grid3<std::uint16_t>& l1, Imath::V3i corner) {
  // The nearest scene voxel is the one nearest to any of the 8 voxels around the corner, and their
  // L1 distances are no less than their Euclidean ones.
  int bound = std::numeric_limits<int>::max();
  for (int i = 0; i < 8; ++i) {
    const Imath::V3i v = corner - Imath::V3i(i & 1, i >> 1 & 1, i >> 2);
    bound = std::min(bound, in_grid(v, l1.size()) ? int{l1(v)} : 0);
  }
  Search search(l1, corner, std::int64_t{bound} * bound);
  if (bound <= 1) return search.best();
  const int side = static_cast<int>(std::bit_floor(static_cast<unsigned>(bound)));
  for (const int z : {-1, 0, -2, 1})
    for (const int y : {-1, 0, -2, 1})
      for (const int x : {-1, 0, -2, 1}) search.visit(corner + side * Imath::V3i(x, y, z), side);
  return search.best();
}

}  // namespace lacuna
