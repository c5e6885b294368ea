#include "renderer/guides/sd_tree.h"

#include <algorithm>
#include <cmath>

namespace lacuna {

namespace {

constexpr double leaf_share = 0.01;  // of a quadtree's energy in a leaf: rho of the paper
constexpr int deepest_directions = 20, deepest_places = 40;
constexpr std::size_t most_leaves = std::size_t{1} << 18;

}  // namespace

struct SdTree::SampleAccumulator final : Accumulator {
  explicit SampleAccumulator(std::size_t leaves) : vertices(leaves, 0) {}
  std::vector<std::uint32_t> vertices;  // of each leaf
  std::vector<EnergySample> samples;
  Tuning::Accumulator tuning;
};

void SdTree::prepare(const PrepareContext& context) {
  const Bounds& box = context.scene.bounds();
  const V3d size = box.size();
  low_ = box.low;
  side_ = std::max({size.x, size.y, size.z});
  nodes_ = {Node{}};
  leaves_.resize(1);
  tuning_ = Tuning({1}, settings_.probability, 1);  // a tree has no strength
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
  return std::make_unique<SampleAccumulator>(leaves_.size());
}

void SdTree::accumulate(const GuidingSample& sample, Accumulator& accumulator) const {
  auto& own = static_cast<SampleAccumulator&>(accumulator);
  const std::uint32_t leaf = sample.v.guiding_cell.index;
  if (leaf >= leaves_.size()) return;
  ++own.vertices[leaf];
  const float energy = sample.radiance / sample.pdf.value;
  if (energy > 0 && std::isfinite(energy)) own.samples.push_back({leaf, sample.wi, energy});
  const DirectionTree& tree = leaves_[leaf].sampling;
  if (tree.empty() || !tuning_.wants(leaf)) return;
  const float density = tree.pdf(sample.wi).value;
  tuning_.accumulate(sample, leaf, std::span(&density, 1), own.tuning);
}

void SdTree::update(std::span<const std::unique_ptr<Accumulator>> accumulators,
                    const ThreadPool& pool) {
  // By leaf, each in the order of the accumulators: leaves can then be filled in parallel.
  std::vector<std::size_t> first(leaves_.size() + 1, 0);
  for (const auto& t : accumulators) {
    const auto& own = static_cast<const SampleAccumulator&>(*t);
    for (std::size_t l = 0; l < leaves_.size(); ++l) leaves_[l].vertices += own.vertices[l];
    for (const EnergySample& s : own.samples) ++first[s.leaf + 1];
  }
  for (std::size_t l = 0; l < leaves_.size(); ++l) first[l + 1] += first[l];
  std::vector<const EnergySample*> sorted(first.back());
  std::vector<std::size_t> next(first.begin(), first.end() - 1);
  for (const auto& t : accumulators) {
    for (const EnergySample& s : static_cast<const SampleAccumulator&>(*t).samples)
      sorted[next[s.leaf]++] = &s;
  }
  pool.for_each(static_cast<int>(leaves_.size()), [&](int i) {
    const auto l = static_cast<std::size_t>(i);
    for (std::size_t k = first[l]; k < first[l + 1]; ++k) {
      leaves_[l].building.add(sorted[k]->w, double(sorted[k]->energy), true);
    }
  });
  std::vector<const Tuning::Accumulator*> tuning;
  for (const auto& t : accumulators) {
    tuning.push_back(&static_cast<const SampleAccumulator&>(*t).tuning);
  }
  tuning_.update(tuning);
  if (++done_ == std::uint64_t{1} << round_) next_round(pool);
}

void SdTree::next_round(const ThreadPool& pool) {
  // The paper's c sqrt(2^k): the limit grows with the number of samples.
  const double most =
      double(settings_.leaf_vertices) * std::sqrt(std::ldexp(1.0, static_cast<int>(round_)));
  divide(0, 0, most);
  tuning_.forget();
  pool.for_each(static_cast<int>(leaves_.size()), [&](int i) {
    Leaf& leaf = leaves_[static_cast<std::size_t>(i)];
    leaf.building.build();
    // Without samples in this round, the old tree stays.
    if (!leaf.building.empty()) leaf.sampling = std::move(leaf.building);
    leaf.building = leaf.sampling.refined(leaf_share, deepest_directions);
    leaf.vertices = 0;
  });
  ++round_;
  done_ = 0;
}

void SdTree::divide(std::uint32_t node, int depth, double most) {
  if (nodes_[node].child[0] == 0) {
    const std::uint32_t leaf = nodes_[node].leaf;
    if (leaves_[leaf].vertices <= most || leaves_.size() >= most_leaves) return;
    if (depth >= deepest_places) return;
    leaves_[leaf].vertices /= 2;
    Leaf half = leaves_[leaf];
    leaves_.push_back(std::move(half));
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
  out.put(round_);
  out.put(done_);
  out.put(nodes_);
  out.put(static_cast<std::uint64_t>(leaves_.size()));
  for (const Leaf& l : leaves_) {
    l.sampling.save(out);
    l.building.save(out);
    out.put(l.vertices);
  }
  tuning_.save(out);
}

void SdTree::load(ByteReader& in) {
  const auto round = in.get<std::uint64_t>(), done = in.get<std::uint64_t>();
  std::vector<Node> nodes = in.get_vector<Node>();
  std::vector<Leaf> leaves(in.get_length(sizeof(std::uint64_t)));
  for (Leaf& l : leaves) {
    l.sampling.load(in);
    l.building.load(in);
    l.vertices = in.get<double>();
  }
  bool good = round < 63 && done < std::uint64_t{1} << round && !nodes.empty();
  for (std::size_t i = 0; i < nodes.size() && good; ++i) {
    const auto& child = nodes[i].child;
    const bool leaf = child[0] == 0 && child[1] == 0;
    // Children come after their parents, so there are no cycles.
    good = leaf ? nodes[i].leaf < leaves.size()
                : std::min(child[0], child[1]) > i && std::max(child[0], child[1]) < nodes.size();
  }
  if (!good) throw std::runtime_error("saved guide is not a valid tree");
  round_ = round;
  done_ = done;
  nodes_ = std::move(nodes);
  leaves_ = std::move(leaves);
  tuning_ = Tuning({1}, settings_.probability, leaves_.size());
  tuning_.load(in);
}

std::vector<std::pair<std::string, double>> SdTree::statistics() const {
  double nodes = 0;
  for (const Leaf& l : leaves_) nodes += static_cast<double>(l.sampling.nodes());
  std::vector<std::pair<std::string, double>> stats{
      {"sd_leaves", static_cast<double>(leaves_.size())},
      {"sd_direction_nodes", nodes},
      {"sd_rounds", static_cast<double>(round_)}};
  for (auto& s : tuning_.statistics()) stats.push_back(std::move(s));
  return stats;
}

}  // namespace lacuna
