#include "renderer/many_lights/vpl_tree.h"

#include "base/parallel/for_each_chunked.h"

namespace lacuna {

VplTree::Item VplTree::item(const VplSet& lights, std::size_t block, int i) {
  if (const DiffuseBlock* from = lights.diffuse(block)) {
    const VplGeometry g = lights.geometry(block, i);
    const Rgb rgb(from->r[i], from->g[i], from->b[i]);
    return {{g.x, g.n},
            luminance(rgb) * std::max(1.0F, from->shading_cosine_ratio[i]),
            from->points ? Kind::point : Kind::diffuse,
            true};
  }
  const GeneralLight& light = lights.general(block, i);
  const VplGeometry g = light.geometry();
  Rgb rgb(0, 0, 0);
  if (const auto* v = std::get_if<Vertex>(&light.at)) {
    rgb = v->throughput * v->bsdf->albedo() * inv_pi;
  } else {
    const auto& e = std::get<EmitterPoint>(light.at);
    rgb = e.emission / e.pdf.value;
  }
  return {{g.infinite ? V3f(0.0F) : g.x, V3f(0.0F)},
          luminance(rgb) * lights.share(),
          g.infinite ? Kind::infinite : Kind::point,
          false};
}

VplTree::VplTree(const VplSet& lights, const ThreadPool& pool, const BlockRange& range) : sums_{0} {
  const std::vector<Item> all = items(lights, range, pool);
  sums_.reserve(all.size() + 1);
  for (const Item& i : all) sums_.push_back(sums_.back() + double(i.intensity));
  costs_.resize(all.size());
  build(add_roots(lights, all), all, pool);
  costs_ = {};
}

/// The lights of the range, in the order of blocks.
std::vector<VplTree::Item> VplTree::items(const VplSet& lights, const BlockRange& range,
                                          const ThreadPool& pool) {
  for (std::size_t b = 0; b < lights.blocks(); ++b) {
    first_of_block_.push_back(static_cast<std::uint32_t>(blocks_.size()));
    const int count = range.contains(b) ? lights.count(b) : 0;
    blocks_.insert(blocks_.end(), static_cast<std::size_t>(count), static_cast<std::uint32_t>(b));
  }
  std::vector<Item> all(blocks_.size());
  for_each_chunked(pool, all.size(), 4096, [&](std::size_t i) {
    all[i] = item(lights, blocks_[i], lane(static_cast<std::uint32_t>(i)));
    // A light whose estimated intensity is 0 may shine all the same.
    all[i].intensity = std::max(all[i].intensity, std::numeric_limits<float>::min());
  });
  return all;
}

/// A tree of n lights has 2 n - 1 nodes, so the places of all nodes are given by their numbers of
/// lights.
std::vector<VplTree::Subtree> VplTree::add_roots(const VplSet& lights,
                                                 std::span<const Item> items) {
  const auto starts_tree = [&](std::size_t i) {
    return items[i].kind != items[i - 1].kind || items[i].exact != items[i - 1].exact ||
           (blocks_[i] != blocks_[i - 1] &&
            lights.edges(blocks_[i]) != lights.edges(blocks_[i - 1]));
  };
  nodes_.resize(2 * items.size());
  std::vector<Subtree> trees;
  std::uint32_t root = 0;
  for (std::size_t first = 0, end = 0; first < items.size(); first = end) {
    for (end = first + 1; end < items.size() && !starts_tree(end);) ++end;
    nodes_[root].first = static_cast<std::uint32_t>(first);
    nodes_[root].end = static_cast<std::uint32_t>(end);
    roots_.push_back(root);
    trees.push_back({root, root + 1});
    root += 2 * static_cast<std::uint32_t>(end - first) - 1;
  }
  nodes_.resize(root);
  return trees;
}

/// Builds large subtrees node by node, level by level, until there are enough of them for threads
/// to build whole.
void VplTree::build(std::vector<Subtree> subtrees, std::span<const Item> items,
                    const ThreadPool& pool) {
  constexpr std::uint32_t small = 4096;  // lights
  while (!subtrees.empty()) {
    std::vector<std::optional<std::array<Subtree, 2>>> parts(subtrees.size());
    pool.for_each(static_cast<int>(subtrees.size()), [&](int i) {
      const Subtree& tree = subtrees[static_cast<std::size_t>(i)];
      const Node& node = nodes_[tree.node];
      if (node.end - node.first > small) {
        parts[static_cast<std::size_t>(i)] = divide(tree, items);
      } else {
        build(tree, items);
      }
    });
    subtrees.clear();
    for (const auto& two : parts) {
      if (two) subtrees.insert(subtrees.end(), two->begin(), two->end());
    }
  }
}

void VplTree::build(const Subtree& tree, std::span<const Item> items) {
  const auto parts = divide(tree, items);
  if (!parts) return;
  for (const Subtree& part : *parts) build(part, items);
}

/// Completes the node, and returns its parts if it has more than one light.
std::optional<std::array<VplTree::Subtree, 2>> VplTree::divide(const Subtree& tree,
                                                               std::span<const Item> items) {
  Node& node = nodes_[tree.node];
  node.kind = items[node.first].kind;
  node.exact = items[node.first].exact;
  node.bounds = items[node.first].bounds;
  for (std::uint32_t i = node.first + 1; i < node.end; ++i) node.bounds.add(items[i].bounds);
  node.intensity = static_cast<float>(sums_[node.end] - sums_[node.first]);
  if (node.end - node.first == 1) return {};
  const std::uint32_t middle = split(node, items);
  node.child = tree.below;
  Node &left = nodes_[node.child], &right = nodes_[node.child + 1];
  left.first = node.first, left.end = middle;
  right.first = middle, right.end = node.end;
  const std::uint32_t below_left = tree.below + 2;
  const std::uint32_t below_right = below_left + 2 * (middle - node.first - 1);
  return {{{{node.child, below_left}, {node.child + 1, below_right}}}};
}

std::uint32_t VplTree::split(const Node& node, std::span<const Item> items) {
  // Each part has at least an eighth of the lights, which limits the depth to log_8/7 of their
  // number.
  const std::uint32_t n = node.end - node.first, least = (n + 7) / 8;
  const auto cost = [this](std::uint32_t first, std::uint32_t end, const BlockBounds& b) {
    return (sums_[end] - sums_[first]) * b.size2();
  };
  BlockBounds part = items[node.end - 1].bounds;
  for (std::uint32_t i = node.end - 1; i > node.first; --i) {
    part.add(items[i].bounds);
    costs_[i] = cost(i, node.end, part);
  }
  part = items[node.first].bounds;
  double best = std::numeric_limits<double>::infinity();
  std::uint32_t middle = node.first + n / 2;
  for (std::uint32_t i = node.first + 1; i <= node.end - least; ++i) {
    const double c = cost(node.first, i, part) + costs_[i];
    if (i >= node.first + least && c < best) best = c, middle = i;
    part.add(items[i].bounds);
  }
  return middle;
}

std::uint32_t VplTree::choose(const Node& node, double u) const {
  const double target = sums_[node.first] + u * (sums_[node.end] - sums_[node.first]);
  const auto first = sums_.begin() + node.first + 1, last = sums_.begin() + node.end;
  return static_cast<std::uint32_t>(std::upper_bound(first, last, target) - sums_.begin()) - 1;
}

}  // namespace lacuna
