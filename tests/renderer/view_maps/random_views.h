#pragma once

#include <algorithm>
#include <vector>

#include "renderer/core/rng.h"
#include "renderer/view_maps/many_views.h"

namespace lacuna::test {

// Random scenes and views in the unit cube.

inline V3f random_direction(Rng& rng) {
  return V3f(rng.next() - 0.5F, rng.next() - 0.5F, rng.next() - 0.5F).normalized();
}

/// An octree of `n` random leaves in the unit cube.
inline Octree random_tree(int n, int levels, std::uint32_t seed) {
  Rng rng(seed, 0, 0, Rng::Purpose::test);
  std::vector<std::uint64_t> codes;
  codes.reserve(static_cast<std::size_t>(n));
  for (int i = 0; i < n; ++i) codes.push_back(rng.next_u32() % (std::uint64_t{1} << (3 * levels)));
  std::sort(codes.begin(), codes.end());
  codes.erase(std::unique(codes.begin(), codes.end()), codes.end());
  return build_octree(codes, levels, V3d(0.0), 1);
}

enum class Facing { everywhere, anywhere, alike };

inline std::vector<View> random_views(int n, Facing facing, std::uint32_t seed) {
  Rng rng(seed, 0, 0, Rng::Purpose::test);
  std::vector<View> views;
  const V3f common = random_direction(rng);
  for (int i = 0; i < n; ++i) {
    const V3f x(rng.next(), rng.next(), rng.next());
    const V3f own = random_direction(rng);
    views.push_back({x, facing == Facing::everywhere ? V3f(0.0F)
                        : facing == Facing::anywhere ? own
                                                     : (common + 0.3F * own).normalized()});
  }
  return views;
}

}  // namespace lacuna::test
