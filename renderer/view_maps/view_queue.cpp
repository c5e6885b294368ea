#include "renderer/view_maps/view_queue.h"

#include <fmt/format.h>

#include <limits>

#include "renderer/core/free_memory.h"
#include "renderer/core/pass_seconds.h"

namespace lacuna {

namespace {

/// Pairs: siblings of the scene's octree to process for a view node.
struct Waiting {
  std::uint32_t view;
  Siblings siblings;
};
bool by_view(const Waiting& a, const Waiting& b) { return a.view < b.view; }

class ViewQueue {
 public:
  ViewQueue(const ViewRendering& rendering, const ViewTree& views, bool share,
            const ThreadPool& pool)
      : rendering_(rendering), views_(views), pool_(pool), first_(share ? 0 : views.first_leaf()) {
    const std::size_t maps = views.tree().nodes.size() - first_;
    const std::size_t floats = maps * rendering.map_floats();
    require_free(double(floats) * sizeof(float), [&] {
      return fmt::format("view_maps: breadth-first, maps of {} nodes; go depth_first", maps);
    });
    maps_.assign(floats, std::numeric_limits<float>::infinity());
    counts_.unfused_bytes = floats * sizeof(float);
  }

  ManyViewsCounts counts() const { return counts_; }

  /// Runs until the queue is empty.
  void empty_queue() {
    std::vector<Waiting> queue;
    const auto roots = first_ == 0 ? 1 : views_.leaf_count();
    for (std::uint32_t i = 0; i < roots; ++i) queue.push_back({first_ + i, Siblings::root()});
    while (!queue.empty()) queue = next_generation(queue);
  }

  /// Calls `use` with the map of each leaf.
  void fuse(const UseMap& use) {
    PassSeconds seconds;
    const Octree& tree = views_.tree();
    for (std::size_t level = 0; level + 1 < tree.first.size(); ++level) {
      const std::uint32_t first = std::max(tree.first[level], first_);
      const std::uint32_t end = tree.first[level + 1];
      if (first >= end) continue;
      pool_.for_each(static_cast<int>(end - first),
                     [&](int k) { fuse_one(first + static_cast<std::uint32_t>(k), use); });
    }
    seconds.end(counts_.fusion_seconds);
  }

 private:
  std::span<float> map(std::uint32_t view) {
    const std::size_t floats = rendering_.map_floats();
    return {maps_.data() + (view - first_) * floats, floats};
  }

  void fuse_one(std::uint32_t view, const UseMap& use) {
    if (rendering_.is_leaf(view)) {
      return use(view - views_.first_leaf(), map(view).first(rendering_.texels()));
    }
    const Octree::Node& node = views_.tree().nodes[view];
    std::vector<float> handed(rendering_.map_floats());
    for (std::uint32_t c = 0; c < node.children; ++c) {
      const std::uint32_t child = node.first_child + c;
      rendering_.hand_down(view, map(view), child, handed);
      const std::span<float> own = map(child);
      for (std::size_t i = 0; i < own.size(); ++i) own[i] = std::min(own[i], handed[i]);
    }
  }

  /// The pairs that a part of a generation leaves for the next; both sorted by view.
  struct Left {
    std::vector<Waiting> here, later;
    ManyViewsCounts counts;
  };

  /// `queue` is sorted by view, and so is the result.
  std::vector<Waiting> next_generation(const std::vector<Waiting>& queue) {
    // View nodes are numbered by level, children as their parents, so what is left for children
    // is sorted by view, too.
    const std::vector<std::size_t> ends = parts(queue);
    std::vector<Left> left(ends.size());
    pool_.for_each(static_cast<int>(ends.size()), [&](int k) {
      const auto i = static_cast<std::size_t>(k);
      const std::size_t first = i == 0 ? 0 : ends[i - 1];
      render({queue.data() + first, ends[i] - first}, left[i]);
    });
    std::vector<Waiting> here, later;
    for (Left& part : left) {
      here.insert(here.end(), part.here.begin(), part.here.end());
      later.insert(later.end(), part.later.begin(), part.later.end());
      counts_ += part.counts;
      part = {};
    }
    std::vector<Waiting> next(here.size() + later.size());
    std::merge(here.begin(), here.end(), later.begin(), later.end(), next.begin(), by_view);
    counts_.queue_bytes = std::max<std::uint64_t>(counts_.queue_bytes,
                                                  (queue.size() + next.size()) * sizeof(Waiting));
    return next;
  }

  /// Ends of parts of similar length; all pairs of a view are in one part.
  std::vector<std::size_t> parts(const std::vector<Waiting>& queue) const {
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

  void render(std::span<const Waiting> part, Left& left) {
    std::vector<Siblings> own;  // of one view
    ViewRendering::Undecided undecided;
    for (std::size_t i = 0; i < part.size();) {
      const std::uint32_t view = part[i].view;
      own.clear();
      for (; i < part.size() && part[i].view == view; ++i) own.push_back(part[i].siblings);
      undecided.here.clear();
      undecided.later.clear();
      rendering_.render_once(view, own, map(view), undecided, left.counts);
      for (const Siblings& s : undecided.here) left.here.push_back({view, s});
      const Octree::Node& node = views_.tree().nodes[view];
      for (std::uint32_t c = 0; c < node.children; ++c) {
        for (const Siblings& s : undecided.later) left.later.push_back({node.first_child + c, s});
      }
    }
  }

  const ViewRendering& rendering_;
  const ViewTree& views_;
  const ThreadPool& pool_;
  std::uint32_t first_;  // of the view nodes that have maps
  std::vector<float> maps_;
  ManyViewsCounts counts_;
};

}  // namespace

ManyViewsCounts render_breadth_first(const ViewRendering& rendering, const ViewTree& views,
                                     bool share, const ThreadPool& pool, const UseMap& use) {
  ViewQueue queue(rendering, views, share, pool);
  if (!rendering.scene_empty()) queue.empty_queue();
  queue.fuse(use);
  return queue.counts();
}

}  // namespace lacuna
