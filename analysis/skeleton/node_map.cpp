#include "analysis/skeleton/node_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <stdexcept>

#include "analysis/skeleton/wavefront.h"
#include "analysis/space/memory_limit.h"
#include "analysis/space/sweep.h"

namespace lacuna {
namespace {

void fill(Grid3<std::uint32_t>& map, const ThreadPool& pool) {
  const auto plane =
      static_cast<std::size_t>(map.size().x) * static_cast<std::size_t>(map.size().y);
  run_parallel(pool, map.size().z, [&](int z) {
    std::fill_n(map.data() + static_cast<std::size_t>(z) * plane, plane, no_node);
  });
}

void start_from_nodes(Wavefront& front, const SkeletonGraph& graph, Imath::V3i size) {
  for (std::uint32_t n = 0; n < graph.nodes(); ++n) {
    const Imath::V3i corner = graph.corners[n];
    if (!in_grid(corner, size + Imath::V3i(1)))
      throw std::invalid_argument(
          fmt::format("node {} lies at corner ({}, {}, {}), outside a grid of {} x {} x {} voxels",
                      n, corner.x, corner.y, corner.z, size.x, size.y, size.z));
    for (int i = 0; i < 8; ++i) front.start(corner - Imath::V3i(i & 1, i >> 1 & 1, i >> 2), n);
  }
}

/// Labels the voxels that paths over faces do not reach, which are few: alternately enters them
/// from labelled voxels over edges and corners, and fills them over faces.
class Rest {
 public:
  Rest(Grid3<std::uint32_t>& map, std::vector<Imath::V3i> voxels) : map_(map) {
    BitGrid3 open(map.size());
    for (const Imath::V3i& v : voxels) open.set(v);
    open_ = std::move(open);
    while (!voxels.empty()) {
      enter(voxels);
      spread();
      voxels = touched();
    }
  }

 private:
  struct Entry {
    std::uint32_t label;
    Imath::V3i voxel;
  };

  template <class Visit>
  static void around(Imath::V3i v, Visit&& visit) {
    for (int z = -1; z <= 1; ++z)
      for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x)
          if (x != 0 || y != 0 || z != 0) visit(v + Imath::V3i(x, y, z));
  }
  void take(const Entry& e) {
    map_(e.voxel) = e.label;
    open_.reset(e.voxel);
    queue_.push_back(e);
  }
  /// Labels each of `voxels` that touches a labelled one, in the order of labels in the queue.
  void enter(const std::vector<Imath::V3i>& voxels) {
    std::vector<Entry> entries;
    for (const Imath::V3i& v : voxels) {
      std::uint32_t label = no_node;
      around(v, [&](Imath::V3i w) {
        if (in_grid(w, map_.size())) label = std::min(label, map_(w));
      });
      if (label != no_node) entries.push_back({label, v});
    }
    std::stable_sort(entries.begin(), entries.end(),
                     [](const Entry& a, const Entry& b) { return a.label < b.label; });
    queue_.clear();
    for (const Entry& e : entries) take(e);
  }
  void spread() {
    for (std::size_t i = 0; i < queue_.size(); ++i) {
      const Entry e = queue_[i];
      for (int a = 0; a < 3; ++a)
        for (const int side : {-1, 1}) {
          Imath::V3i w = e.voxel;
          w[a] += side;
          if (in_grid(w, map_.size()) && open_.get(w)) take({e.label, w});
        }
    }
  }
  /// The open voxels around those in the queue, each once.
  std::vector<Imath::V3i> touched() {
    std::vector<Imath::V3i> voxels;
    for (const Entry& e : queue_)
      around(e.voxel, [&](Imath::V3i w) {
        if (!in_grid(w, map_.size()) || !open_.get(w)) return;
        open_.reset(w);
        voxels.push_back(w);
      });
    for (const Imath::V3i& v : voxels) open_.set(v);
    return voxels;
  }

  Grid3<std::uint32_t>& map_;
  BitGrid3 open_;
  std::vector<Entry> queue_;
};

}  // namespace

Grid3<std::uint32_t> node_map(const BitGrid3& domain, const SkeletonGraph& graph,
                              const ThreadPool& pool, std::uint64_t byte_limit) {
  const Imath::V3i size = domain.size();
  require_memory("a node map", size,
                 checked_voxels(size) * sizeof(std::uint32_t) + Wavefront::bytes(size), byte_limit);
  Grid3<std::uint32_t> map(size);
  fill(map, pool);
  Wavefront front(domain, map);
  start_from_nodes(front, graph, size);
  front.run(pool);
  if (graph.nodes() > 0) Rest(map, front.unreached());
  return map;
}

}  // namespace lacuna
