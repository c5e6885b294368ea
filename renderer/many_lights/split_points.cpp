#include "renderer/many_lights/split_points.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <queue>

namespace lacuna {

namespace {

/// A group of points, as a range of a list of indices.
struct Group {
  std::size_t first, last;
  std::size_t size() const { return last - first; }
  /// Orders by size; for equal sizes, the first in the list is the largest.
  bool operator<(const Group& o) const {
    return size() != o.size() ? size() < o.size() : first > o.first;
  }
};

class Splitter {
 public:
  Splitter(std::span<const SurfacePoint> points, float radius)
      : points_(points), scale_(radius > 0 ? 1 / radius : 0), order_(points.size()) {
    std::iota(order_.begin(), order_.end(), 0U);
  }

  std::span<const std::uint32_t> members(const Group& g) const {
    return std::span(order_).subspan(g.first, g.size());
  }

  /// Moves the points below the middle of the longest side to the front and returns the start of
  /// the others; g.first if all points are identical.
  std::size_t split(const Group& g) {
    std::array<float, 6> low, high;
    low.fill(std::numeric_limits<float>::infinity());
    high.fill(-std::numeric_limits<float>::infinity());
    for (const std::uint32_t i : members(g)) {
      for (int axis = 0; axis < 6; ++axis) {
        const float v = coordinate(i, axis);
        low[static_cast<std::size_t>(axis)] = std::min(low[static_cast<std::size_t>(axis)], v);
        high[static_cast<std::size_t>(axis)] = std::max(high[static_cast<std::size_t>(axis)], v);
      }
    }
    int longest = 0;
    const auto side = [&](int axis) {
      return high[static_cast<std::size_t>(axis)] - low[static_cast<std::size_t>(axis)];
    };
    for (int axis = 1; axis < 6; ++axis) {
      if (side(axis) > side(longest)) longest = axis;
    }
    if (!(side(longest) > 0)) return g.first;
    const float middle = low[static_cast<std::size_t>(longest)] + 0.5F * side(longest);
    const auto at = [&](std::size_t i) { return order_.begin() + static_cast<std::ptrdiff_t>(i); };
    // Rounding may move the middle to the lowest value, which still splits, or, between adjacent
    // floats, to the highest: then the group is not split.
    const auto second = std::stable_partition(
        at(g.first), at(g.last), [&](std::uint32_t i) { return coordinate(i, longest) <= middle; });
    const auto border = static_cast<std::size_t>(second - order_.begin());
    return border == g.last ? g.first : border;
  }

 private:
  float coordinate(std::uint32_t i, int axis) const {
    return axis < 3 ? points_[i].x[axis] * scale_ : points_[i].n[axis - 3];
  }

  std::span<const SurfacePoint> points_;
  float scale_;
  std::vector<std::uint32_t> order_;
};

}  // namespace

std::vector<std::vector<std::uint32_t>> split_points(std::span<const SurfacePoint> points,
                                                     std::size_t parts, float radius) {
  Splitter splitter(points, radius);
  std::priority_queue<Group> open;
  std::vector<Group> done;
  if (!points.empty()) open.push({0, points.size()});
  while (!open.empty() && open.size() + done.size() < parts) {
    const Group g = open.top();
    open.pop();
    const std::size_t border = splitter.split(g);
    if (border == g.first) {
      done.push_back(g);
      continue;
    }
    open.push({g.first, border});
    open.push({border, g.last});
  }
  for (; !open.empty(); open.pop()) done.push_back(open.top());
  std::sort(done.begin(), done.end(),
            [](const Group& a, const Group& b) { return a.first < b.first; });
  std::vector<std::vector<std::uint32_t>> groups;
  groups.reserve(done.size());
  for (const Group& g : done) {
    const auto members = splitter.members(g);
    groups.emplace_back(members.begin(), members.end());
  }
  return groups;
}

}  // namespace lacuna
