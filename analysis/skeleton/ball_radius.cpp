#include "analysis/skeleton/ball_radius.h"

#include <algorithm>
#include <bit>
#include <limits>

#include "analysis/space/sweep.h"

namespace lacuna {
namespace {

/// The least distance along one axis from lattice position p to the closed voxels [a, b).
int gap(int p, int a, int b) { return a >= p ? a - p : b <= p ? p - b : 0; }

/// Calls `use` with the 8 voxels that meet at a lattice corner; some may lie outside the grid.
template <class Use>
void for_each_voxel_at(Imath::V3i corner, Use&& use) {
  for (int i = 0; i < 8; ++i) use(corner - Imath::V3i(i & 1, i >> 1 & 1, i >> 2));
}

/// Searches the nearest scene voxel in recursively halved boxes of voxels. Skips a box if it lies
/// no nearer than the best voxel found, or if the L1 distance at its middle voxel shows that it is
/// empty.
class Search {
 public:
  Search(const Grid3<std::uint16_t>& l1, Imath::V3i corner, std::int64_t best)
      : l1_(l1), corner_(corner), best_(best) {}

  std::int64_t best() const { return best_; }

  /// Searches the voxels of [low, low + side) in the grid. `side` is a power of two.
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
  for_each_voxel_at(corner, [&](Imath::V3i v) {
    bound = std::min(bound, in_grid(v, l1.size()) ? int{l1(v)} : 0);
  });
  Search search(l1, corner, std::int64_t{bound} * bound);
  if (bound <= 1) return search.best();
  const int side = static_cast<int>(std::bit_floor(static_cast<unsigned>(bound)));
  for (const int z : {-1, 0, -2, 1})
    for (const int y : {-1, 0, -2, 1})
      for (const int x : {-1, 0, -2, 1}) search.visit(corner + side * Imath::V3i(x, y, z), side);
  return search.best();
}

std::vector<std::int64_t> squared_ball_radii(const Grid3<std::uint16_t>& l1,
                                             std::span<const Imath::V3i> corners,
                                             const ThreadPool& pool) {
  constexpr std::size_t at_a_time = 64;
  std::vector<std::int64_t> squares(corners.size());
  const auto parts = static_cast<int>((corners.size() + at_a_time - 1) / at_a_time);
  run_parallel(pool, parts, [&](int part) {
    const std::size_t first = static_cast<std::size_t>(part) * at_a_time;
    for (std::size_t i = first; i < std::min(corners.size(), first + at_a_time); ++i) {
      squares[i] = squared_ball_radius(l1, corners[i]);
    }
  });
  return squares;
}

std::int64_t squared_voxel_radius(const Grid3<std::uint32_t>& squares, Imath::V3i corner) {
  std::int64_t most = 0;
  for_each_voxel_at(corner, [&](Imath::V3i v) {
    if (in_grid(v, squares.size())) most = std::max(most, std::int64_t{squares(v)});
  });
  return most;
}

}  // namespace lacuna
