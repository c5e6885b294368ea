#include "renderer/view_maps/many_views.h"

#include <limits>
#include <memory>
#include <mutex>

#include "renderer/view_maps/view_queue.h"

namespace lacuna {

namespace {

/// A view node to render, with the undecided scene nodes and the map of its parent.
struct Work {
  std::uint32_t view;
  std::shared_ptr<const NodeLevels> waiting;
  std::vector<float> depths;
};

/// Renders the views below one node, depth-first, with one list and one map per level.
class Branch {
 public:
  Branch(const ViewRendering& rendering, const ViewTree& views, const UseMap& use)
      : rendering_(rendering), views_(views), use_(use) {}

  ManyViewsCounts counts;

  void descend(std::uint32_t view, const NodeLevels& waiting, std::span<float> depths) {
    view = rendering_.fork(view);
    const Octree::Node& node = views_.tree().nodes[view];
    Level& below = levels_[node.level];
    rendering_.render(view, waiting, depths, below.later, scratch_, counts);
    if (node.children == 0) {
      rendering_.to_scene_units(depths.first(rendering_.texels()), below.depths);
      use_(view - views_.first_leaf(), below.depths);
      return;
    }
    below.depths.resize(rendering_.map_floats());
    for (std::uint32_t c = 0; c < node.children; ++c) {
      const std::uint32_t child = node.first_child + c;
      rendering_.hand_down(view, depths, child, below.depths);
      descend(child, below.later, below.depths);
    }
  }

 private:
  struct Level {
    NodeLevels later;           // deferred by the node of this level to its children
    std::vector<float> depths;  // of one child
  };
  const ViewRendering& rendering_;
  const ViewTree& views_;
  const UseMap& use_;
  ViewRendering::Scratch scratch_;
  std::array<Level, Octree::most_levels + 1> levels_;
};

}  // namespace

ManyViewsCounts render_views(const SceneNodes& scene, const ViewTree& views,
                             const ManyViewsSettings& settings, const ThreadPool& pool,
                             const UseMap& use) {
  if (views.tree().empty()) return {};
  const ViewRendering rendering(scene, views, settings);
  if (settings.breadth_first) {
    return render_breadth_first(rendering, views, settings.share, pool, use);
  }
  const std::vector<float> empty(rendering.map_floats(), std::numeric_limits<float>::infinity());
  NodeLevels whole;
  if (!scene.empty()) scene.append_root(whole[0]);
  ManyViewsCounts total;
  std::mutex mutex;  // guards `total`
  const auto in_parallel = [&](std::size_t n, auto&& body) {
    pool.for_each(static_cast<int>(n), [&](int k) {
      const ManyViewsCounts counts = body(static_cast<std::size_t>(k));
      const std::lock_guard lock(mutex);
      total += counts;
    });
  };
  const auto descend = [&](std::uint32_t view, const NodeLevels& waiting,
                           std::vector<float> depths) {
    Branch branch(rendering, views, use);
    branch.descend(view, waiting, depths);
    return branch.counts;
  };
  if (!settings.share) {
    in_parallel(views.leaf_count(), [&](std::size_t k) {
      return descend(views.first_leaf() + static_cast<std::uint32_t>(k), whole, empty);
    });
    return total;
  }
  // Proceeds level by level until there is work for all threads; then renders each part separately.
  constexpr std::size_t enough = 256;
  std::vector<Work> works{{rendering.fork(0), std::make_shared<const NodeLevels>(whole), empty}};
  bool forked = true;
  while (works.size() < enough && forked) {
    std::vector<std::vector<Work>> next(works.size());
    in_parallel(works.size(), [&](std::size_t k) {
      Work& work = works[k];
      if (rendering.is_leaf(work.view)) {
        next[k].push_back(std::move(work));
        return ManyViewsCounts{};
      }
      ManyViewsCounts counts;
      ViewRendering::Scratch scratch;
      const auto later = std::make_shared<NodeLevels>();
      rendering.render(work.view, *work.waiting, work.depths, *later, scratch, counts);
      const Octree::Node& node = views.tree().nodes[work.view];
      for (std::uint32_t c = 0; c < node.children; ++c) {
        const std::uint32_t child = node.first_child + c;
        next[k].push_back({rendering.fork(child), later, empty});
        rendering.hand_down(work.view, work.depths, child, next[k].back().depths);
      }
      return counts;
    });
    forked = std::any_of(works.begin(), works.end(),
                         [&](const Work& w) { return !rendering.is_leaf(w.view); });
    works.clear();
    for (auto& part : next) std::move(part.begin(), part.end(), std::back_inserter(works));
  }
  in_parallel(works.size(), [&](std::size_t k) {
    return descend(works[k].view, *works[k].waiting, std::move(works[k].depths));
  });
  return total;
}

}  // namespace lacuna
