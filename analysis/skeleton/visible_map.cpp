#include "analysis/skeleton/visible_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <stdexcept>

#include "analysis/skeleton/ball_radius.h"
#include "analysis/skeleton/sight.h"
#include "analysis/space/sweep.h"

namespace lacuna {
namespace {

constexpr int planes_at_a_time = 4;

/// From the centre of a voxel to a corner, in halves of a voxel.
Imath::V3i halves(Imath::V3i voxel, Imath::V3i corner) {
  return 2 * corner - 2 * voxel - Imath::V3i(1);
}
std::int64_t l1_length(Imath::V3i d) {
  return std::int64_t{std::abs(d.x)} + std::abs(d.y) + std::abs(d.z);
}

/// Finds the candidate nodes for the voxels of a node: all at up to 4 edges from it, then at
/// distances that grow by a quarter.
class Candidates {
 public:
  explicit Candidates(const SkeletonGraph& graph) : graph_(graph), met_(graph.nodes(), no_node) {}

  const std::vector<std::uint32_t>& around(std::uint32_t node) {
    constexpr std::size_t most_visited = 2048;
    found_.clear();
    level_.assign(1, node);
    met_[node] = node;
    std::size_t visited = 0;
    for (int edges = 0, wanted = 1; !level_.empty() && visited < most_visited; ++edges) {
      if (edges == wanted) {
        for (const std::uint32_t n : level_) {
          if (found_.size() == sight_candidates) return found_;
          found_.push_back(n);
        }
        wanted += std::max(1, wanted / 4);
      }
      next_.clear();
      for (const std::uint32_t n : level_)
        for (const std::uint32_t m : graph_.of(n))
          if (met_[m] != node) met_[m] = node, next_.push_back(m);
      visited += next_.size();
      level_.swap(next_);
    }
    return found_;
  }

 private:
  const SkeletonGraph& graph_;
  std::vector<std::uint32_t> met_;  // the search that last reached each node
  std::vector<std::uint32_t> found_, level_, next_;
};

struct Unseeing {
  std::uint32_t node;
  Imath::V3i voxel;
};

/// Some planes of the map.
class Slab {
 public:
  /// `clear`: for each node the squared radius of an empty ball around it.
  Slab(Grid3<std::uint32_t>& map, const SkeletonGraph& graph, const Grid3<std::uint16_t>& l1,
       const std::vector<std::int64_t>& clear)
      : map_(map), graph_(graph), l1_(l1), clear_(clear) {}

  SightReport improve(int z0, int z1) {
    for (int z = z0; z < z1; ++z)
      for (int y = 0; y < map_.size().y; ++y)
        for (int x = 0; x < map_.size().x; ++x) check({x, y, z});
    report_.seen_after = report_.seen_before;
    if (unseeing_.empty()) return report_;
    std::stable_sort(unseeing_.begin(), unseeing_.end(),
                     [](const Unseeing& a, const Unseeing& b) { return a.node < b.node; });
    Candidates candidates(graph_);
    const std::vector<std::uint32_t>* around = nullptr;
    for (std::size_t i = 0; i < unseeing_.size(); ++i) {
      if (i == 0 || unseeing_[i].node != unseeing_[i - 1].node)
        around = &candidates.around(unseeing_[i].node);
      if (choose(unseeing_[i].voxel, *around)) ++report_.seen_after;
    }
    return report_;
  }

 private:
  void check(Imath::V3i v) {
    const std::uint32_t n = map_(v);
    if (n == no_node) return;
    ++report_.mapped;
    if (in_sight(v, n))
      ++report_.seen_before;
    else
      unseeing_.push_back({n, v});
  }
  bool in_sight(Imath::V3i v, std::uint32_t n) const {
    return sees(l1_, v, graph_.corners[n], clear_[n]);
  }
  bool choose(Imath::V3i v, const std::vector<std::uint32_t>& around) {
    order_.clear();
    for (const std::uint32_t n : around)
      order_.emplace_back(l1_length(halves(v, graph_.corners[n])), n);
    std::sort(order_.begin(), order_.end());
    for (const auto& [length, n] : order_)
      if (in_sight(v, n)) {
        map_(v) = n;
        return true;
      }
    return false;
  }

  Grid3<std::uint32_t>& map_;
  const SkeletonGraph& graph_;
  const Grid3<std::uint16_t>& l1_;
  const std::vector<std::int64_t>& clear_;
  SightReport report_;
  std::vector<Unseeing> unseeing_;
  std::vector<std::pair<std::int64_t, std::uint32_t>> order_;
};

}  // namespace

SightReport prefer_visible_nodes(Grid3<std::uint32_t>& map, const SkeletonGraph& graph,
                                 const Grid3<std::uint16_t>& l1, const ThreadPool& pool) {
  if (map.size() != l1.size())
    throw std::invalid_argument(
        fmt::format("a node map of {} x {} x {} voxels, distances of {} x {} x {}", map.size().x,
                    map.size().y, map.size().z, l1.size().x, l1.size().y, l1.size().z));
  // Not the nodes' own radii, whose balls may reach into the scene (NodeRadius::voxel).
  const std::vector<std::int64_t> clear = squared_ball_radii(l1, graph.corners, pool);
  const int depth = map.size().z;
  const int slabs = (depth + planes_at_a_time - 1) / planes_at_a_time;
  std::vector<SightReport> reports(static_cast<std::size_t>(slabs));
  run_parallel(pool, slabs, [&](int s) {
    reports[static_cast<std::size_t>(s)] =
        Slab(map, graph, l1, clear)
            .improve(s * planes_at_a_time, std::min(depth, (s + 1) * planes_at_a_time));
  });
  SightReport sum;
  for (const SightReport& r : reports) {
    sum.mapped += r.mapped;
    sum.seen_before += r.seen_before;
    sum.seen_after += r.seen_after;
  }
  return sum;
}

}  // namespace lacuna
