#include "renderer/guides/sd_tree.h"

#include <algorithm>
#include <stdexcept>

namespace lacuna {

namespace {

constexpr int deepest_places = 40;

}  // namespace

struct SdTree::SampleAccumulator final : Accumulator {
  Leaves::Accumulator cells;
  Tuning::Accumulator tuning;
  double bytes() const override { return cells.bytes() + tuning.bytes(); }
};

void SdTree::prepare(const PrepareContext& context) {
  const Bounds& box = context.scene.bounds();
  const V3d size = box.size();
  low_ = box.low;
  side_ = std::max({size.x, size.y, size.z});
  nodes_ = {Node{}};
  leaves_ = Leaves(1);
  tuning_ = new_tuning();
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

std::unique_ptr<GuidingDistribution::Accumulator> SdTree::accumulator() const {
  return std::make_unique<SampleAccumulator>();
}

void SdTree::accumulate(const GuidingSample& sample, Accumulator& accumulator) const {
  auto& own = static_cast<SampleAccumulator&>(accumulator);
  const std::uint32_t leaf = sample.v.guiding_cell.index;
  if (leaf >= leaves_.size()) return;
  Leaves::accumulate(leaf, sample, sample.radiance, own.cells);
  const DirectionTree& tree = leaves_.directions(leaf);
  if (tree.empty() || !tuning_.wants(leaf)) return;
  const float density = tree.pdf(sample.wi).value;
  tuning_.accumulate(sample, leaf, std::span(&density, 1), own.tuning);
}

void SdTree::record_noise(double variance, double by_bsdf, Accumulator& accumulator) const {
  static_cast<SampleAccumulator&>(accumulator).tuning.noise.add(variance, by_bsdf);
}

void SdTree::update(std::span<const std::unique_ptr<Accumulator>> accumulators,
                    const ThreadPool& pool, double iterations) {
  std::vector<const Leaves::Accumulator*> cells;
  std::vector<const Tuning::Accumulator*> tuning;
  for (const auto& a : accumulators) {
    const auto& own = static_cast<const SampleAccumulator&>(*a);
    cells.push_back(&own.cells);
    tuning.push_back(&own.tuning);
  }
  tuning_.update(tuning, iterations);
  if (!leaves_.update(cells, pool, iterations)) return;
  if (leaves_.rounds() > 0) tuning_.stop_if_useless();
  divide(0, 0, leaves_.most_vertices(settings_.leaf_vertices));
  tuning_.forget();
  leaves_.next_round(pool);
}

void SdTree::divide(std::uint32_t node, int depth, double most) {
  if (nodes_[node].child[0] == 0) {
    const std::uint32_t leaf = nodes_[node].leaf;
    if (leaves_.vertices(leaf) <= most || leaves_.size() >= most_learned_cells) return;
    if (depth >= deepest_places) return;
    leaves_.divide(leaf);
    tuning_.divide(leaf);
    const auto other = static_cast<std::uint32_t>(leaves_.size() - 1);
    const auto first = static_cast<std::uint32_t>(nodes_.size());
    nodes_.push_back({{}, leaf});
    nodes_.push_back({{}, other});
    nodes_[node].child = {first, first + 1};
  }
  const std::array<std::uint32_t, 2> child = nodes_[node].child;
  for (const std::uint32_t c : child) divide(c, depth + 1, most);
}

void SdTree::save(ByteWriter& out) const {
  out.put(nodes_);
  leaves_.save(out);
  tuning_.save(out);
}

void SdTree::load(ByteReader& in) {
  std::vector<Node> nodes = in.get_vector<Node>();
  leaves_.load(in);
  bool good = !nodes.empty();
  for (std::size_t i = 0; i < nodes.size() && good; ++i) {
    const auto& child = nodes[i].child;
    const bool leaf = child[0] == 0 && child[1] == 0;
    // Children come after their parents, so there are no cycles.
    good = leaf ? nodes[i].leaf < leaves_.size()
                : std::min(child[0], child[1]) > i && std::max(child[0], child[1]) < nodes.size();
  }
  if (!good) throw std::runtime_error("saved guide is not a valid tree");
  nodes_ = std::move(nodes);
  tuning_ = new_tuning();
  tuning_.load(in);
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
  for (auto& s : tuning_.statistics()) stats.push_back(std::move(s));
  return stats;
}

}  // namespace lacuna
