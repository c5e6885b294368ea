#include "renderer/guides/sd_tree.h"

#include <algorithm>
#include <stdexcept>

namespace lacuna {

namespace {

constexpr int deepest_places = 40;

}  // namespace

void SdTree::prepare(const PrepareContext& context) {
  const Bounds& box = context.scene.bounds();
  const V3d size = box.size();
  low_ = box.low;
  side_ = std::max({size.x, size.y, size.z});
  nodes_ = {Node{}};
  leaves_ = Leaves(1);
}

std::uint32_t SdTree::leaf_at(const V3f& x) const {
  V3d p = side_ > 0 ? (V3d(x) - low_) / side_ : V3d(0.0);
  std::uint32_t node = 0;
  for (int axis = 0; nodes_[node].child[0] != 0; axis = (axis + 1) % 3) {
    const bool high = p[axis] >= 0.5;
    p[axis] = 2 * p[axis] - (high ? 1 : 0);
    node = nodes_[node].child[high ? 1 : 0];
  }
  return nodes_[node].leaf;
}

std::vector<std::uint32_t> SdTree::update(const TrainingSamples& samples, const ThreadPool& pool) {
  std::vector<std::uint32_t> origins;
  if (!leaves_.update(samples, pool)) return origins;
  divide(0, 0, leaves_.most_vertices(settings_.leaf_vertices), origins);
  leaves_.next_round(pool);
  return origins;
}

void SdTree::divide(std::uint32_t node, int depth, double most,
                    std::vector<std::uint32_t>& origins) {
  if (nodes_[node].child[0] == 0) {
    const std::uint32_t leaf = nodes_[node].leaf;
    if (leaves_.vertices(leaf) <= most || leaves_.size() >= most_learned_cells) return;
    if (depth >= deepest_places) return;
    leaves_.divide(leaf);
    origins.push_back(leaf);
    const auto other = static_cast<std::uint32_t>(leaves_.size() - 1);
    const auto first = static_cast<std::uint32_t>(nodes_.size());
    nodes_.push_back({{}, leaf});
    nodes_.push_back({{}, other});
    nodes_[node].child = {first, first + 1};
  }
  const std::array<std::uint32_t, 2> child = nodes_[node].child;
  for (const std::uint32_t c : child) divide(c, depth + 1, most, origins);
}

void SdTree::save(ByteWriter& out) const {
  out.put(nodes_);
  leaves_.save(out);
}

void SdTree::load(ByteReader& in) {
  std::vector<Node> nodes = in.get_vector<Node>();
  leaves_.load(in);
  bool good = !nodes.empty();
  for (std::size_t i = 0; i < nodes.size() && good; ++i) {
    const auto& child = nodes[i].child;
    const bool leaf = child[0] == 0 && child[1] == 0;
    // Children follow their parents, so there are no cycles.
    good = leaf ? nodes[i].leaf < leaves_.size()
                : std::min(child[0], child[1]) > i && std::max(child[0], child[1]) < nodes.size();
  }
  if (!good) throw std::runtime_error("saved guide is not a valid tree");
  nodes_ = std::move(nodes);
}

std::vector<std::pair<std::string, double>> SdTree::statistics() const {
  double nodes = 0;
  for (std::size_t l = 0; l < leaves_.size(); ++l) {
    nodes += static_cast<double>(leaves_.directions(l).nodes());
  }
  std::vector<std::pair<std::string, double>> stats{
      {"sd_leaves", static_cast<double>(leaves_.size())},
      {"sd_direction_nodes", nodes},
      {"sd_rounds", static_cast<double>(leaves_.rounds())}};
  return stats;
}

}  // namespace lacuna
