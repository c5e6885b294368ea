#include "analysis/octree/octree.h"

#include <algorithm>

namespace lacuna {

namespace {

/// Every third bit of `code`.
std::uint32_t gather_bits(std::uint64_t code) {
  std::uint32_t v = 0;
  for (int i = 0; i <= Octree::most_levels; ++i)
    v |= static_cast<std::uint32_t>(code >> (3 * i) & 1) << i;
  return v;
}

Imath::V3f centre_of(std::uint64_t code, int level, Imath::V3d corner, double side) {
  const double cell = side / (1 << level);
  const Imath::V3d at(gather_bits(code) + 0.5, gather_bits(code >> 1) + 0.5,
                      gather_bits(code >> 2) + 0.5);
  return Imath::V3f(corner + at * cell);
}

}  // namespace

Octree build_octree(std::span<const std::uint64_t> codes, int levels, Imath::V3d corner,
                    double side) {
  Octree tree;
  tree.corner = corner;
  tree.side = side;
  // From the leaves up: a parent's code is that of its children without the last three bits.
  std::vector<std::vector<std::uint64_t>> of_level(static_cast<std::size_t>(levels) + 1);
  of_level.back().assign(codes.begin(), codes.end());
  for (auto level = static_cast<std::size_t>(levels); level > 0; --level) {
    auto& parents = of_level[level - 1];
    for (const std::uint64_t c : of_level[level]) {
      if (parents.empty() || parents.back() != c >> 3) parents.push_back(c >> 3);
    }
  }
  tree.first.push_back(0);
  for (std::size_t level = 0; level < of_level.size(); ++level) {
    const auto next = tree.first.back() + static_cast<std::uint32_t>(of_level[level].size());
    std::size_t child = 0;
    for (const std::uint64_t c : of_level[level]) {
      Octree::Node& node = tree.nodes.emplace_back();
      node.centre = centre_of(c, static_cast<int>(level), corner, side);
      node.level = static_cast<std::uint8_t>(level);
      if (level + 1 == of_level.size()) continue;
      node.first_child = next + static_cast<std::uint32_t>(child);
      const auto& below = of_level[level + 1];
      for (; child < below.size() && below[child] >> 3 == c; ++child) {
        ++node.children;
        node.octants |= static_cast<std::uint8_t>(1U << (below[child] & 7));
      }
    }
    tree.first.push_back(next);
  }
  return tree;
}

}  // namespace lacuna
