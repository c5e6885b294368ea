#include "renderer/view_maps/view_tree.h"

#include <algorithm>
#include <numeric>

#include "analysis/geometry/morton.h"
#include "renderer/core/sampling.h"

namespace lacuna {

namespace {

/// Box and normals of the views below a node, accumulated from the leaves up.
struct Sum {
  V3f low{std::numeric_limits<float>::infinity()};
  V3f high{-std::numeric_limits<float>::infinity()};
  V3d n{0.0};
  bool everywhere = false;
  std::uint32_t views = 0;

  void add(const Sum& o) {
    for (int k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], o.low[k]);
      high[k] = std::max(high[k], o.high[k]);
    }
    n += o.n;
    everywhere = everywhere || o.everywhere;
    views += o.views;
  }
};

/// The axis and the sign of the largest coordinate of a normal, one of six; 6: no normal.
std::uint64_t facing(const V3f& n) {
  if (n == V3f(0.0F)) return 6;
  int axis = 0;
  for (int k = 1; k < 3; ++k) {
    if (std::abs(n[k]) > std::abs(n[axis])) axis = k;
  }
  return static_cast<std::uint64_t>(2 * axis + (n[axis] < 0 ? 1 : 0));
}

/// Inserts three bits of `facing` into a Morton code, above its lowest `levels` levels.
std::uint64_t insert_facing(std::uint64_t code, std::uint64_t facing, int levels) {
  const int bits = 3 * levels;
  const std::uint64_t low = code & ((std::uint64_t{1} << bits) - 1);
  return ((code >> bits) << 3 | facing) << bits | low;
}

}  // namespace

ViewTree::ViewTree(std::span<const View> views, int levels, V3d corner, double side, Split split) {
  const double cells = std::ldexp(1.0, levels);
  std::vector<std::pair<std::uint64_t, std::uint32_t>> codes(views.size());
  for (std::size_t i = 0; i < views.size(); ++i) {
    std::array<std::uint64_t, 3> cell;
    for (int k = 0; k < 3; ++k) {
      const double at = std::floor((double(views[i].x[k]) - corner[k]) / side * cells);
      cell[static_cast<std::size_t>(k)] =
          static_cast<std::uint64_t>(std::clamp(at, 0.0, cells - 1));
    }
    std::uint64_t code = morton_code(cell[0], cell[1], cell[2]);
    if (split == Split::facing) {
      code = insert_facing(code, facing(views[i].n), std::max(0, levels - facing_level));
    }
    codes[i] = {code, static_cast<std::uint32_t>(i)};
  }
  std::sort(codes.begin(), codes.end());
  std::vector<std::uint64_t> leaves;
  leaf_of_.resize(views.size());
  for (const auto& [code, view] : codes) {
    if (leaves.empty() || leaves.back() != code) leaves.push_back(code);
    leaf_of_[view] = static_cast<std::uint32_t>(leaves.size()) - 1;
  }
  tree_ = build_octree(leaves, split == Split::facing ? levels + 1 : levels, corner, side);
  bound(views);
}

ViewTree ViewTree::of_single_views(std::span<const View> views) {
  ViewTree single;
  single.tree_.nodes.resize(views.size());
  single.tree_.first = {0, static_cast<std::uint32_t>(views.size())};
  single.leaf_of_.resize(views.size());
  std::iota(single.leaf_of_.begin(), single.leaf_of_.end(), 0U);
  single.bound(views);
  return single;
}

/// Computes the bounds of all nodes of the tree.
void ViewTree::bound(std::span<const View> views) {
  nodes_.resize(tree_.nodes.size());
  if (views.empty()) return;
  std::vector<Sum> sums(nodes_.size());
  for (std::size_t i = 0; i < views.size(); ++i) {
    const View& v = views[i];
    sums[first_leaf() + leaf_of_[i]].add({v.x, v.x, V3d(v.n), v.n == V3f(0.0F), 1});
  }
  for (std::size_t i = nodes_.size(); i-- > 0;) {
    const Octree::Node& node = tree_.nodes[i];
    for (std::uint32_t c = 0; c < node.children; ++c) sums[i].add(sums[node.first_child + c]);
  }
  std::vector<float> angles(nodes_.size(), 0.0F);  // largest angle between the normals and n
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const Sum& s = sums[i];
    const V3f centre = (s.low + s.high) * 0.5F;
    // Rounded up, so that every view lies inside.
    const float radius = (s.high - s.low).length() * 0.5F;
    nodes_[i].centre = centre;
    nodes_[i].radius = radius * (1 + 1e-6F);
    nodes_[i].half = (s.high - s.low) * (0.5F * (1 + 1e-6F));
    nodes_[i].views = s.views;
    nodes_[i].n = s.n.length2() > 0 ? V3f(s.n.normalized()) : V3f(1, 0, 0);
  }
  for (std::size_t i = 0; i < views.size(); ++i) {
    const std::size_t leaf = first_leaf() + leaf_of_[i];
    const float c = std::clamp(nodes_[leaf].n.dot(views[i].n), -1.0F, 1.0F);
    angles[leaf] = std::max(angles[leaf], std::acos(c));
  }
  for (std::size_t i = nodes_.size(); i-- > 0;) {
    const Octree::Node& node = tree_.nodes[i];
    for (std::uint32_t c = 0; c < node.children; ++c) {
      const std::size_t child = node.first_child + c;
      const float between = std::acos(std::clamp(nodes_[i].n.dot(nodes_[child].n), -1.0F, 1.0F));
      angles[i] = std::max(angles[i], between + angles[child]);
    }
    const float widest = sums[i].everywhere ? pi : std::min(pi, angles[i] + pi / 2 + 1e-3F);
    nodes_[i].cosine = std::cos(widest);
    nodes_[i].sine = std::sin(widest);
    if (widest >= pi) nodes_[i].cosine = -1, nodes_[i].sine = 0;
  }
}

}  // namespace lacuna
