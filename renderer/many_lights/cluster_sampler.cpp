#include "renderer/many_lights/cluster_sampler.h"

#include <algorithm>
#include <queue>

namespace lacuna {

struct ClusterSampler::Tile {
  std::span<const ShadingPoint> points;
  const Rates& rates;
  PointLanes lanes = {};
  std::vector<std::size_t> ends = {};  // end of the blocks whose lights reach each point
};

ClusterSampler::Entry ClusterSampler::weigh(std::uint32_t index, const Tile& tile) const {
  const VplTree::Node& node = tree_.node(index);
  const std::size_t block = tree_.block(node.first);  // all lights have the edges of the first
  const std::size_t middle = tree_.block(node.first + (node.end - node.first) / 2);
  Entry entry{index, 0, {}};
  Lanes roots;
  for (std::size_t i = 0; i < tile.points.size(); ++i) {
    const int at = static_cast<int>(i);
    const auto cells = tile.rates.cells.first(i);
    const auto same = std::find(cells.begin(), cells.end(), tile.rates.cells[i]);
    roots[at] = same == cells.end() ? std::sqrt(tile.rates.of(tile.rates.cells[i], middle))
                                    : roots[static_cast<int>(same - cells.begin())];
    entry.weights[at] = block < tile.ends[i] ? roots[at] : 0;
  }
  Float8 gain = 0;
  for (int k = 0; 8 * k < static_cast<int>(tile.points.size()); ++k) {
    Float8 term = node.intensity * entry.weights.eight(k);
    if (node.kind != VplTree::Kind::infinite) {
      const bool normals = node.kind == VplTree::Kind::diffuse;
      const auto g = node.bounds.geometric_terms(tile.lanes.x(k), tile.lanes.n(k), normals);
      const float most = std::min(terms_.bound(), 1e20F);  // finite at the node itself
      term = term * min(g.at(g.middle2), most);
      constexpr float least = std::numeric_limits<float>::min();  // no 0 / 0
      gain = gain + term * (g.size2 / max(g.middle2, least));
    }
    entry.weights.set(k, term);
  }
  entry.gain = node.child == 0 ? 0 : double(reduce_add(gain));
  return entry;
}

std::vector<ClusterSampler::Entry> ClusterSampler::cut(const Tile& tile) const {
  std::vector<Entry> entries;
  std::priority_queue<std::pair<double, std::size_t>> queue;  // gains and indices
  const auto put = [&](std::uint32_t node, std::size_t at) {
    if (at == entries.size()) entries.emplace_back();
    entries[at] = weigh(node, tile);
    if (entries[at].gain > 0) queue.emplace(entries[at].gain, at);
  };
  for (const std::uint32_t root : tree_.roots()) put(root, entries.size());
  while (!queue.empty() && entries.size() < static_cast<std::size_t>(settings_.nodes)) {
    const std::size_t at = queue.top().second;
    const std::uint32_t child = tree_.node(entries[at].node).child;
    queue.pop();
    put(child, at);
    put(child + 1, entries.size());
  }
  std::sort(entries.begin(), entries.end(), [this](const Entry& a, const Entry& b) {
    return tree_.node(a.node).first < tree_.node(b.node).first;
  });
  return entries;
}

std::vector<ClusterSampler::Sample> ClusterSampler::sample(std::span<const ShadingPoint> points,
                                                           const IterationContext& context,
                                                           const Rates& rates) const {
  Tile tile{points, rates};
  for (const ShadingPoint& p : points) {
    tile.lanes.add(p);
    tile.ends.push_back(terms_.lights().blocks(p.edges));
  }
  const std::vector<Entry> entries = cut(tile);
  std::vector<Sample> samples;
  for (std::size_t i = 0; i < points.size(); ++i)
    sample_for(points[i], i, entries, context, samples);
  std::sort(samples.begin(), samples.end());
  return samples;
}

void ClusterSampler::sample_for(const ShadingPoint& at, std::size_t point,
                                std::span<const Entry> cut, const IterationContext& context,
                                std::vector<Sample>& samples) const {
  const int lane = static_cast<int>(point);
  double weights = 0, power = 0;
  for (const Entry& e : cut) {
    const float w = e.weights[lane];
    if (!(w > 0)) continue;
    weights += double(w);
    power += double(tree_.node(e.node).intensity);
  }
  // Systematic sampling: numbers at equal steps from a random start.
  Rng rng(context.seed, context.iteration, at.pixel, Rng::Purpose::gather);
  const double step = 1.0 / settings_.lights, by_power = settings_.power_share;
  double next = (double(rng.next_u32()) + 0.5) * 0x1p-32 * step, before = 0;
  std::uint32_t last = ~0U;
  for (const Entry& e : cut) {
    const auto w = double(e.weights[lane]);
    if (!(w > 0)) continue;
    const VplTree::Node& node = tree_.node(e.node);
    const double intensity = double(node.intensity);
    const double p = (1 - by_power) * w / weights + by_power * intensity / power;
    for (; next < before + p; next += step) {
      const std::uint32_t light = tree_.choose(node, (next - before) / p);
      const double weight = step / (p * double(tree_.intensity(light)) / intensity);
      if (light != last) {
        samples.push_back({tree_.block(light), point, std::uint64_t{1} << tree_.lane(light), 0});
      }
      samples.back().weight += static_cast<float>(weight);
      last = light;
    }
    before += p;
  }
}

}  // namespace lacuna
