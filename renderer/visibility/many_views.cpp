#include "renderer/visibility/many_views.h"

#include <limits>
#include <memory>
#include <mutex>

namespace lacuna {

ManyViewsCounts& ManyViewsCounts::operator+=(const ManyViewsCounts& o) {
  pairs += o.pairs;
  culled += o.culled;
  splats += o.splats;
  sharing += o.sharing;
  large += o.large;
  for (std::size_t i = 0; i < generations.size(); ++i) generations[i] += o.generations[i];
  return *this;
}

namespace {

constexpr float nothing = std::numeric_limits<float>::infinity();

class Traversal {
 public:
  Traversal(const Octree& scene, const ViewTree& views, const ManyViewsSettings& settings)
      : scene_(scene),
        views_(views),
        settings_(settings),
        map_{settings.map_size},
        directions_(static_cast<std::size_t>(map_.texels())) {
    for (int i = 0; i < map_.texels(); ++i) {
      directions_[static_cast<std::size_t>(i)] = map_.direction(i);
    }
    // Views below each node.
    below_.assign(views.tree().nodes.size(), 0);
    for (auto i = static_cast<std::uint32_t>(below_.size()); i-- > 0;) {
      const Octree::Node& v = views.tree().nodes[i];
      if (v.children == 0) below_[i] = 1;
      for (std::uint32_t c = 0; c < v.children; ++c) below_[i] += below_[v.first_child + c];
    }
  }

  const Paraboloid& map() const { return map_; }
  bool is_leaf(std::uint32_t view) const { return views_.tree().nodes[view].children == 0; }

  /// Renders what waits for a view node into its map. What its children must decide is left in
  /// `later`, in order.
  void render(std::uint32_t view, std::span<const std::uint32_t> waiting, std::span<float> depths,
              std::vector<std::uint32_t>& later, ManyViewsCounts& counts) const {
    const ViewTree::Node& v = views_.node(view);
    const bool leaf = is_leaf(view);
    const int level = settings_.share ? views_.tree().nodes[view].level : 0;
    std::vector<std::uint32_t> stack;
    for (const std::uint32_t first : waiting) {
      stack.push_back(first);
      while (!stack.empty()) {
        const std::uint32_t i = stack.back();
        stack.pop_back();
        const Octree::Node& s = scene_.nodes[i];
        ++counts.pairs;
        ++counts.generations[static_cast<std::size_t>(s.level + level)];
        const float radius = scene_.radius(s.level);
        const V3f d = s.centre - v.centre;
        const float distance = d.length();
        if (settings_.cull && outside(v, d, distance, radius)) {
          ++counts.culled;
        } else if (same_texel(v, d, distance, radius)) {
          splat(d, distance, depths);
          ++counts.splats;
          counts.sharing += below_[view];
        } else if (leaf && s.children == 0) {
          fill(d, distance, radius, depths);
          ++counts.splats;
          ++counts.large;
          counts.sharing += below_[view];
        } else if (!leaf && (s.children == 0 || radius / 2 < v.radius)) {
          later.push_back(i);
        } else {
          for (std::uint32_t c = s.children; c-- > 0;) stack.push_back(s.first_child + c);
        }
      }
    }
  }

  /// What a child has of its parent's map: distances to the same places, and so the same texels.
  void hand_down(std::uint32_t parent, std::span<const float> from, std::uint32_t child,
                 std::span<float> to) const {
    const V3f step = views_.node(parent).centre - views_.node(child).centre;
    for (std::size_t i = 0; i < from.size(); ++i) {
      to[i] = from[i] == nothing ? nothing : (step + directions_[i] * from[i]).length();
    }
  }

 private:
  /// Fig. 4: no view below sees anything of a sphere. The region that none of them sees is a cone;
  /// the spheres of both nodes must fit between its rim and the scene node's centre.
  static bool outside(const ViewTree::Node& v, const V3f& d, float distance, float radius) {
    if (v.cosine <= -1) return false;
    const float along = d.dot(v.n);
    // alpha > psi, without a division
    if (along >= v.cosine * distance) return false;
    // |d| sin(alpha - psi), the distance to the rim, or that to the apex where it is nearer.
    const float across = std::sqrt(std::max(0.0F, distance * distance - along * along));
    const bool beyond = along * v.cosine + across * v.sine < 0;
    const float to_rim = beyond ? distance : across * v.cosine - along * v.sine;
    return to_rim > (radius + v.radius) * (1 + 1e-5F);
  }

  /// Fig. 6: a scene node shows less than a texel to all views below, and none of them lies further
  /// from their centre than it is large: so it fills the same texel in all of them.
  bool same_texel(const ViewTree::Node& v, const V3f& d, float distance, float radius) const {
    if (v.radius > radius) return false;
    const float nearest = distance - v.radius;
    if (!(nearest > radius)) return false;
    const float size = 2 * radius / nearest * map_.stretch(std::abs(d.x) / distance);
    return size < 1;
  }

  void splat(const V3f& d, float distance, std::span<float> depths) const {
    float& depth = depths[static_cast<std::size_t>(map_.texel(d))];
    depth = std::min(depth, distance);
  }

  /// All texels whose middle the sphere covers, or that of its centre (3.2.4).
  void fill(const V3f& d, float distance, float radius, std::span<float> depths) const {
    if (distance > 0) splat(d, distance, depths);
    const float sine = distance > radius ? radius / distance : 1;
    const float cosine = std::sqrt(std::max(0.0F, 1 - sine * sine));
    for (int half = 0; half < 2; ++half) fill_half(half, d, distance, sine, cosine, depths);
  }
  void fill_half(int half, const V3f& d, float distance, float sine, float cosine,
                 std::span<float> depths) const {
    // Around the sphere's middle on this square; what lies beyond its rim is never asked for.
    const float towards = half == 0 ? d.x : -d.x;
    if (towards < -sine * distance) return;
    const float most = 2 * sine * static_cast<float>(map_.size);  // texels, at the rim's stretch
    const float scale = 1 / (distance + std::max(0.0F, towards) + 1e-30F);
    const auto range = [&](float along) {
      const float middle = (along * scale + 1) * static_cast<float>(map_.size) / 2;
      const auto low = static_cast<int>(std::max(0.0F, middle - most - 1));
      const auto high =
          static_cast<int>(std::min(static_cast<float>(map_.size) - 1, middle + most + 1));
      return std::pair(low, high);
    };
    const auto [i0, i1] = range(d.y);
    const auto [j0, j1] = range(d.z);
    for (int j = j0; j <= j1; ++j) {
      for (int i = i0; i <= i1; ++i) {
        const auto t = static_cast<std::size_t>(map_.index(half, i, j));
        if (directions_[t].dot(d) >= cosine * distance) depths[t] = std::min(depths[t], distance);
      }
    }
  }

  const Octree& scene_;
  const ViewTree& views_;
  ManyViewsSettings settings_;
  Paraboloid map_;
  std::vector<V3f> directions_;  // of the texels
  std::vector<std::uint32_t> below_;
};

/// A view node that is to be rendered: what its parent left, and what it has of the parent's map.
struct Work {
  std::uint32_t view;
  std::shared_ptr<const std::vector<std::uint32_t>> waiting;  // scene nodes
  std::vector<float> depths;
};

/// Renders a view node, and hands what is left to its children: calls `next(work)` for each.
template <class Next>
void step(const Traversal& t, const ViewTree& views, Work work, const UseMap& use,
          ManyViewsCounts& counts, Next&& next) {
  const auto later = std::make_shared<std::vector<std::uint32_t>>();
  t.render(work.view, *work.waiting, work.depths, *later, counts);
  if (t.is_leaf(work.view)) {
    use(work.view - views.first_leaf(), work.depths);
    return;
  }
  const Octree::Node& node = views.tree().nodes[work.view];
  for (std::uint32_t c = 0; c < node.children; ++c) {
    Work child{node.first_child + c, later, std::vector<float>(work.depths.size())};
    t.hand_down(work.view, work.depths, child.view, child.depths);
    next(std::move(child));
  }
}

void descend(const Traversal& t, const ViewTree& views, Work work, const UseMap& use,
             ManyViewsCounts& counts) {
  step(t, views, std::move(work), use, counts,
       [&](Work child) { descend(t, views, std::move(child), use, counts); });
}

}  // namespace

ManyViewsCounts render_views(const Octree& scene, const ViewTree& views,
                             const ManyViewsSettings& settings, const ThreadPool& pool,
                             const UseMap& use) {
  if (views.tree().empty()) return {};
  const Traversal t(scene, views, settings);
  const auto texels = static_cast<std::size_t>(t.map().texels());
  const auto whole = std::make_shared<const std::vector<std::uint32_t>>(scene.empty() ? 0 : 1, 0U);
  ManyViewsCounts total;
  std::mutex mutex;  // of total
  std::vector<Work> works;
  const auto in_parallel = [&](std::size_t n, auto&& body) {
    pool.for_each(static_cast<int>(n), [&](int k) {
      ManyViewsCounts counts;
      body(static_cast<std::size_t>(k), counts);
      const std::lock_guard lock(mutex);
      total += counts;
    });
  };
  if (!settings.share) {
    in_parallel(views.leaf_count(), [&](std::size_t k, ManyViewsCounts& counts) {
      const auto view = views.first_leaf() + static_cast<std::uint32_t>(k);
      descend(t, views, {view, whole, std::vector<float>(texels, nothing)}, use, counts);
    });
    return total;
  }
  // Level by level until there is enough for all threads; then each part by itself.
  constexpr std::size_t enough = 256;
  works.push_back({0, whole, std::vector<float>(texels, nothing)});
  while (!works.empty() && works.size() < enough) {
    std::vector<std::vector<Work>> next(works.size());
    in_parallel(works.size(), [&](std::size_t k, ManyViewsCounts& counts) {
      step(t, views, std::move(works[k]), use, counts,
           [&](Work child) { next[k].push_back(std::move(child)); });
    });
    works.clear();
    for (auto& part : next) std::move(part.begin(), part.end(), std::back_inserter(works));
  }
  in_parallel(works.size(), [&](std::size_t k, ManyViewsCounts& counts) {
    descend(t, views, std::move(works[k]), use, counts);
  });
  return total;
}

}  // namespace lacuna
