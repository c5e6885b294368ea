#include "renderer/path/record_tree.h"

#include <algorithm>
#include <array>
#include <limits>

namespace lacuna {

void RecordTree::build(std::vector<SurfacePoint> points) {
  points_ = std::move(points);
  std::vector<V3f> places;
  places.reserve(points_.size());
  for (const SurfacePoint& p : points_) places.push_back(p.x);
  tree_.build(std::move(places));
}

std::size_t RecordTree::nearest(const SurfacePoint& at, std::span<std::uint32_t> found) const {
  constexpr std::size_t most_candidates = 128;
  std::array<PointTree::Found, most_candidates> candidates;
  const auto wanted = std::span(candidates).first(std::min(2 * found.size(), most_candidates));
  const std::size_t n = tree_.nearest(at.x, std::numeric_limits<float>::infinity(), wanted);
  std::array<std::pair<float, std::uint32_t>, most_candidates> ranked;
  for (std::size_t i = 0; i < n; ++i) {
    const std::uint32_t index = candidates[i].index;
    ranked[i] = {rank(at, points_[index]), index};
  }
  const std::size_t taken = std::min(found.size(), n);
  std::partial_sort(ranked.begin(), ranked.begin() + static_cast<std::ptrdiff_t>(taken),
                    ranked.begin() + static_cast<std::ptrdiff_t>(n));
  for (std::size_t i = 0; i < taken; ++i) found[i] = ranked[i].second;
  return taken;
}

}  // namespace lacuna
