#include "renderer/view_maps/view_queue.h"

#include <fmt/format.h>

#include <limits>

#include "renderer/core/free_memory.h"
#include "renderer/core/passes.h"

namespace lacuna {

namespace {

/// A scene node to process for a view node, with the centre of its cube in the grid.
struct Pair {
  std::uint32_t view, node;
  std::uint16_t x, y, z;
};
bool by_view(const Pair& a, const Pair& b) { return a.view < b.view; }

/// Appends pairs of a view node with each of `nodes`.
void append_pairs(std::uint32_t view, const NodeList& nodes, std::vector<Pair>& to) {
  const auto whole = [](float at) { return static_cast<std::uint16_t>(at); };
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    to.push_back({view, nodes.node[i], whole(nodes.x[i]), whole(nodes.y[i]), whole(nodes.z[i])});
  }
}

class ViewQueue {
 public:
  ViewQueue(const ViewRendering& rendering, const ViewTree& views, bool share,
            const ThreadPool& pool)
      : rendering_(rendering), views_(views), pool_(pool), first_(share ? 0 : views.first_leaf()) {
    const std::size_t maps = views.tree().nodes.size() - first_;
    const std::size_t floats = maps * rendering.map_floats();
    require_free(double(floats) * sizeof(float), [&] {
      return fmt::format("view_maps: maps of {} nodes, breadth-first; use traversal depth_first",
                         maps);
    });
    maps_.assign(floats, std::numeric_limits<float>::infinity());
    counts_.unfused_bytes = floats * sizeof(float);
  }

  ManyViewsCounts counts() const { return counts_; }
  /// The maps before fuse(); call it last.
  UnfusedMaps take_maps() { return {rendering_, views_, first_, std::move(maps_)}; }

  /// Runs until the queue is empty.
  void empty_queue() {
    std::vector<Pair> queue;
    NodeList root;
    rendering_.scene().append_root(root);
    const auto roots = first_ == 0 ? 1 : views_.leaf_count();
    for (std::uint32_t i = 0; i < roots; ++i)
      append_pairs(rendering_.fork(first_ + i), root, queue);
    for (int generation = 0; !queue.empty(); ++generation) {
      queue = next_generation(queue, generation);
    }
  }

  /// Calls `use` with the map of each leaf.
  void fuse(const UseMap& use) {
    Passes passes(pool_);
    passes.begin("fusion of view maps", counts_.fusion_seconds);
    const Octree& tree = views_.tree();
    for (std::size_t level = 0; level + 1 < tree.first.size(); ++level) {
      const std::uint32_t first = std::max(tree.first[level], first_);
      const std::uint32_t end = tree.first[level + 1];
      if (first >= end) continue;
      pool_.for_each(static_cast<int>(end - first),
                     [&](int k) { fuse_one(first + static_cast<std::uint32_t>(k), use); });
    }
  }

 private:
  std::span<float> map(std::uint32_t view) {
    const std::size_t floats = rendering_.map_floats();
    return {maps_.data() + (view - first_) * floats, floats};
  }

  void fuse_one(std::uint32_t view, const UseMap& use) {
    if (rendering_.fork(view) != view) return;  // it has no map of its own
    std::vector<float> handed(rendering_.map_floats());
    if (rendering_.is_leaf(view)) {
      rendering_.to_scene_units(map(view).first(rendering_.texels()), handed);
      return use(view - views_.first_leaf(), handed);
    }
    const Octree::Node& node = views_.tree().nodes[view];
    for (std::uint32_t c = 0; c < node.children; ++c) {
      const std::uint32_t child = rendering_.fork(node.first_child + c);
      rendering_.hand_down(view, map(view), child, handed);
      const std::span<float> own = map(child);
      for (std::size_t i = 0; i < own.size(); ++i) own[i] = std::min(own[i], handed[i]);
    }
  }

  /// The pairs of the next generation from one part, and its counts.
  struct PartResult {
    std::vector<Pair> pairs;
    ManyViewsCounts counts;
  };

  /// `queue` is sorted by view, and so is the result.
  std::vector<Pair> next_generation(const std::vector<Pair>& queue, int generation) {
    const std::vector<std::size_t> ends = parts(queue);
    std::vector<PartResult> results(ends.size());
    pool_.for_each(static_cast<int>(ends.size()), [&](int k) {
      const auto i = static_cast<std::size_t>(k);
      const std::size_t first = i == 0 ? 0 : ends[i - 1];
      render({queue.data() + first, ends[i] - first}, generation, results[i]);
    });
    std::vector<Pair> next;
    for (PartResult& part : results) {
      next.insert(next.end(), part.pairs.begin(), part.pairs.end());
      counts_ += part.counts;
      part = {};
    }
    std::sort(next.begin(), next.end(), by_view);
    counts_.queue_bytes =
        std::max<std::uint64_t>(counts_.queue_bytes, (queue.size() + next.size()) * sizeof(Pair));
    return next;
  }

  /// Ends of parts of similar length; all pairs of a view belong to one part.
  std::vector<std::size_t> parts(const std::vector<Pair>& queue) const {
    const auto most = static_cast<std::size_t>(pool_.threads()) * 16;
    const std::size_t length = std::max<std::size_t>(64, queue.size() / most);
    std::vector<std::size_t> ends;
    std::size_t end = 0;
    while (end < queue.size()) {
      end = std::min(end + length, queue.size());
      while (end < queue.size() && queue[end].view == queue[end - 1].view) ++end;
      ends.push_back(end);
    }
    return ends;
  }

  void render(std::span<const Pair> part, int generation, PartResult& results) {
    NodeList own, later, children;  // of one view
    ViewRendering::Scratch scratch;
    for (std::size_t i = 0; i < part.size();) {
      const std::uint32_t view = part[i].view;
      // The number of a generation is its number of subdivisions; those that were not of views were
      // of the scene.
      const int level = generation - rendering_.depth(view);
      for (NodeList* list : {&own, &later, &children, &scratch.split}) list->clear();
      std::size_t n = 0;
      while (i + n < part.size() && part[i + n].view == view) ++n;
      gather(part.subspan(i, n), own);
      i += n;
      rendering_.render_once(view, level, own, map(view), later, scratch, results.counts);
      if (!scratch.split.empty()) {
        rendering_.scene().append_children(scratch.split, level, children);
      }
      append_pairs(view, children, results.pairs);
      const Octree::Node& node = views_.tree().nodes[view];
      for (std::uint32_t c = 0; c < node.children && !later.empty(); ++c) {
        append_pairs(rendering_.fork(node.first_child + c), later, results.pairs);
      }
    }
  }

  void gather(std::span<const Pair> pairs, NodeList& to) const {
    to.make_room(pairs.size());
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const Pair& p = pairs[i];
      to.x[i] = p.x;
      to.y[i] = p.y;
      to.z[i] = p.z;
      to.node[i] = p.node;
      to.shape[i] = rendering_.scene().shape(p.node);
    }
    to.resize(pairs.size());
  }

  const ViewRendering& rendering_;
  const ViewTree& views_;
  const ThreadPool& pool_;
  std::uint32_t first_;  // index of the first view node that has a map
  std::vector<float> maps_;
  ManyViewsCounts counts_;
};

}  // namespace

ManyViewsCounts render_breadth_first(const ViewRendering& rendering, const ViewTree& views,
                                     bool share, const ThreadPool& pool, const UseMap& use) {
  ViewQueue queue(rendering, views, share, pool);
  if (!rendering.scene().empty()) queue.empty_queue();
  queue.fuse(use);
  return queue.counts();
}

UnfusedMaps render_unfused(const SceneNodes& scene, const ViewTree& views,
                           const ManyViewsSettings& settings, const ThreadPool& pool,
                           ManyViewsCounts& counts) {
  const ViewRendering rendering(scene, views, settings);
  ViewQueue queue(rendering, views, settings.share, pool);
  if (!scene.empty() && !views.tree().empty()) queue.empty_queue();
  counts = queue.counts();
  return queue.take_maps();
}

}  // namespace lacuna
