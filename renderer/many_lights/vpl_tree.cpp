#include "renderer/many_lights/vpl_tree.h"

#include "renderer/core/rng.h"

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

VplTree::VplTree(const VplSet& lights, const IterationContext& context, const BlockRange& range)
    : sums_{0} {
  std::vector<Item> items;
  items.reserve(lights.size());
  std::vector<std::uint32_t> starts;  // of trees
  for (std::size_t b = 0; b < lights.blocks(); ++b) {
    first_of_block_.push_back(static_cast<std::uint32_t>(items.size()));
    for (int i = 0; range.contains(b) && i < lights.count(b); ++i) {
      Item light = item(lights, b, i);
      // A light whose estimated intensity is 0 may shine all the same.
      light.intensity = std::max(light.intensity, std::numeric_limits<float>::min());
      const bool starts_tree = items.empty() || items.back().kind != light.kind ||
                               items.back().exact != light.exact ||
                               (i == 0 && lights.edges(b) != lights.edges(b - 1));
      if (starts_tree) starts.push_back(static_cast<std::uint32_t>(items.size()));
      items.push_back(light);
      blocks_.push_back(static_cast<std::uint32_t>(b));
      sums_.push_back(sums_.back() + double(light.intensity));
    }
  }
  nodes_.reserve(2 * items.size());
  costs_.resize(items.size());
  starts.push_back(static_cast<std::uint32_t>(items.size()));
  constexpr std::uint64_t path = std::uint64_t{1} << 55;  // no pixel's
  Rng rng(context.seed, context.iteration, path, Rng::Purpose::gather);
  for (std::size_t t = 0; t + 1 < starts.size(); ++t) {
    const auto root = static_cast<std::uint32_t>(nodes_.size());
    roots_.push_back(root);
    Node& node = nodes_.emplace_back();
    node.first = starts[t], node.end = starts[t + 1];
    build(root, items);
  }
  for (Node& n : nodes_) n.representative = choose(n, rng.next());
  for (const Node& n : nodes_) {  // parents come before their children
    if (n.child == 0) continue;
    Node& left = nodes_[n.child];
    (n.representative < left.end ? left : nodes_[n.child + 1]).representative = n.representative;
  }
  costs_ = {};
}

void VplTree::build(std::uint32_t index, std::span<const Item> items) {
  Node& node = nodes_[index];
  node.kind = items[node.first].kind;
  node.exact = items[node.first].exact;
  node.bounds = items[node.first].bounds;
  for (std::uint32_t i = node.first + 1; i < node.end; ++i) node.bounds.add(items[i].bounds);
  node.intensity = static_cast<float>(sums_[node.end] - sums_[node.first]);
  if (node.end - node.first == 1) return;
  const std::uint32_t middle = split(node, items);
  const auto child = static_cast<std::uint32_t>(nodes_.size());
  const std::uint32_t first = node.first, end = node.end;
  node.child = child;
  nodes_.resize(nodes_.size() + 2);  // `node` is no longer valid
  nodes_[child].first = first, nodes_[child].end = middle;
  nodes_[child + 1].first = middle, nodes_[child + 1].end = end;
  build(child, items);
  build(child + 1, items);
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
