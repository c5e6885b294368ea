// Single pairs of a scene node and a view node, each against all leaves and all views below them.

#include <gtest/gtest.h>

#include "analysis/geometry/morton.h"
#include "renderer/core/rng.h"
#include "renderer/core/sampling.h"
#include "renderer/view_maps/view_rendering.h"

namespace lacuna {
namespace {

/// A surface of the unit cube as leaves, with views on it.
struct Surface {
  Octree octree;
  std::vector<View> views;
};

/// The surface z = height(x, y). Views are two radii of a leaf along the normal, as lights are.
template <class Height>
Surface surface(int levels, int views, Height&& height) {
  const int cells = 1 << levels;
  const auto at = [&](float x, float y) { return V3f(x, y, height(x, y)); };
  std::vector<std::uint64_t> codes;
  const int steps = 8 * cells;
  for (int i = 0; i < steps; ++i) {
    for (int j = 0; j < steps; ++j) {
      const V3f p = at((float(i) + 0.5F) / float(steps), (float(j) + 0.5F) / float(steps));
      std::array<std::uint64_t, 3> c;
      for (int k = 0; k < 3; ++k) {
        c[static_cast<std::size_t>(k)] = static_cast<std::uint64_t>(p[k] * float(cells));
      }
      codes.push_back(morton_code(c[0], c[1], c[2]));
    }
  }
  std::sort(codes.begin(), codes.end());
  codes.erase(std::unique(codes.begin(), codes.end()), codes.end());
  Surface s{build_octree(codes, levels, V3d(0.0), 1), {}};
  Rng rng(7, 0, 0, Rng::Purpose::test);
  for (int i = 0; i < views; ++i) {
    const float x = 0.05F + 0.9F * rng.next(), y = 0.05F + 0.9F * rng.next(), e = 1e-3F;
    const V3f n = (at(x + e, y) - at(x - e, y)).cross(at(x, y + e) - at(x, y - e)).normalized();
    s.views.push_back({at(x, y) + n * (2 * s.octree.radius(levels)), n});
  }
  return s;
}

const std::vector<std::pair<const char*, Surface>>& surfaces() {
  static const std::vector<std::pair<const char*, Surface>> all = [] {
    std::vector<std::pair<const char*, Surface>> list;
    list.emplace_back("wall", surface(5, 60, [](float, float) { return 0.51F; }));
    list.emplace_back("tilted",
                      surface(5, 60, [](float x, float y) { return 0.2F + 0.4F * x + 0.1F * y; }));
    list.emplace_back("drape", surface(5, 60, [](float x, float y) {
                        return 0.5F + 0.2F * std::sin(9 * x) * std::cos(4 * y);
                      }));
    return list;
  }();
  return all;
}

/// Calls `visit(level, node)` with each scene node alone, as a list.
template <class Visit>
void for_each_node(const SceneNodes& scene, Visit&& visit) {
  NodeList level;
  scene.append_root(level);
  for (int l = 0; l <= scene.levels(); ++l) {
    for (std::size_t i = 0; i < level.size(); ++i) {
      NodeList one;
      one.make_room(1);
      one.store({Float8(level.x[i]), Float8(level.y[i]), Float8(level.z[i]),
                 Int8(static_cast<int>(level.node[i])), Int8(static_cast<int>(level.shape[i]))},
                1);
      visit(l, one);
    }
    NodeList below;
    if (l < scene.levels()) scene.append_children(level, l, below);
    level = below;
  }
}

/// The nodes of the last level at or below a node.
std::vector<std::uint32_t> leaves_below(const Octree& tree, std::uint32_t node) {
  std::vector<std::uint32_t> at{node};
  for (bool inner = true; inner;) {
    inner = false;
    std::vector<std::uint32_t> next;
    for (const std::uint32_t i : at) {
      const Octree::Node& n = tree.nodes[i];
      if (n.children == 0) next.push_back(i);
      for (std::uint32_t c = 0; c < n.children; ++c) next.push_back(n.first_child + c);
      inner = inner || n.children > 0;
    }
    at = next;
  }
  return at;
}

std::vector<View> views_below(const ViewTree& tree, std::span<const View> views,
                              std::uint32_t node) {
  std::vector<View> below;
  const auto leaves = leaves_below(tree.tree(), node);
  for (std::size_t i = 0; i < views.size(); ++i) {
    const std::uint32_t leaf = tree.first_leaf() + tree.leaf_of(i);
    if (std::find(leaves.begin(), leaves.end(), leaf) != leaves.end()) below.push_back(views[i]);
  }
  return below;
}

/// How far the foremost corner of all leaves below a scene node is in front of any of the views,
/// scene units; below 0: no view sees any part of it.
float in_front(const Octree& scene, std::uint32_t node, std::span<const View> views) {
  float most = -std::numeric_limits<float>::infinity();
  const float half = static_cast<float>(std::ldexp(scene.side, -scene.levels() - 1));
  for (const std::uint32_t leaf : leaves_below(scene, node)) {
    for (const View& v : views) {
      const float reach = half * (std::abs(v.n.x) + std::abs(v.n.y) + std::abs(v.n.z));
      most = std::max(most, v.n.dot(scene.nodes[leaf].centre - v.x) + reach);
    }
  }
  return most;
}

/// Renders each pair by itself.
template <class Visit>
void for_each_pair(const Surface& s, const ViewTree& tree, const ManyViewsSettings& settings,
                   Visit&& visit) {
  const SceneNodes scene(s.octree, ThreadPool(1));
  const ViewRendering rendering(scene, tree, settings);
  ViewRendering::Scratch scratch;
  std::vector<float> depths(rendering.map_floats());
  for (std::uint32_t view = 0; view < tree.tree().nodes.size(); ++view) {
    if (rendering.fork(view) != view) continue;
    const std::vector<View> below = views_below(tree, s.views, view);
    for_each_node(scene, [&](int level, const NodeList& one) {
      ManyViewsCounts counts;
      NodeList later;
      scratch.split.clear();
      rendering.render_once(view, level, one, depths, later, scratch, counts);
      visit(view, below, one.node[0], counts);
    });
  }
}

TEST(ViewPairs, AreCulledOnlyIfNoViewSeesAnyLeaf) {
  for (const auto& [name, s] : surfaces()) {
    const ViewTree tree(s.views, 4, V3d(0.0), 1);
    std::array<int, 2> culled{};
    int unseen = 0;
    for (const bool boxes : {false, true}) {
      for_each_pair(s, tree, {.boxes = boxes},
                    [&](std::uint32_t view, std::span<const View> below, std::uint32_t node,
                        const ManyViewsCounts& counts) {
                      const bool hidden = in_front(s.octree, node, below) < 0;
                      culled[boxes] += counts.culled > 0;
                      unseen += boxes && hidden;
                      EXPECT_LE(counts.culled, hidden)
                          << name << ", view node " << view << ", scene node " << node;
                    });
    }
    EXPECT_GT(culled[0], 0);
    EXPECT_GT(culled[1], culled[0]);
    EXPECT_GT(culled[1], 0.5 * unseen) << name;
  }
}

// A node that is rendered for several views is within half a texel of the same place in each.
TEST(ViewPairs, ShareATexelWithinHalfATexel) {
  const Paraboloid map{16};
  std::array<int, 12> shifts{};  // of a tenth of a texel each
  for (const auto& [name, s] : surfaces()) {
    const ViewTree tree(s.views, 4, V3d(0.0), 1);
    for_each_pair(s, tree, {},
                  [&](std::uint32_t view, std::span<const View> below, std::uint32_t node,
                      const ManyViewsCounts& counts) {
                    if (counts.splats == 0 || counts.large > 0) return;
                    const V3f x = s.octree.nodes[node].centre;
                    const auto shared = map.coord(x - tree.node(view).centre);
                    for (const View& v : below) {
                      const auto own = map.coord(x - v.x);
                      if (own.half != shared.half) continue;  // two squares, one direction
                      const float shift = std::hypot(own.u - shared.u, own.v - shared.v);
                      EXPECT_LE(shift, 0.5F) << name << " " << view << " " << node;
                      ++shifts[static_cast<std::size_t>(std::min(11.0F, shift * 10))];
                    }
                  });
  }
  int of_all = 0, small = 0;
  for (std::size_t i = 0; i < shifts.size(); ++i)
    of_all += shifts[i], small += i < 3 ? shifts[i] : 0;
  EXPECT_GT(of_all, 10000);
  EXPECT_GT(small, 0.8 * of_all) << "within 0.3 texels";
  EXPECT_LT(shifts[0], of_all) << "some are shared";
}

// The boxes of nodes hold all leaves below them, and where a sixteenth of a node is a leaf or less
// they are no larger; children follow their parents in place and number.
TEST(SceneNodes, HaveTheBoxesOfTheirLeaves) {
  const Octree& octree = surfaces()[2].second.octree;
  const SceneNodes scene(octree, ThreadPool(2));
  EXPECT_EQ(scene.leaf_count(), octree.leaves().size());
  std::size_t nodes = 0;
  for_each_node(scene, [&](int level, const NodeList& one) {
    const Octree::Node& node = octree.nodes[one.node[0]];
    EXPECT_EQ(one.node[0], nodes++);
    EXPECT_EQ(level, node.level);
    const V3f x(one.x[0], one.y[0], one.z[0]);
    EXPECT_EQ(x, scene.to_grid(node.centre));
    const std::uint32_t shape = one.shape[0];
    EXPECT_EQ(shape & 0xff, node.octants);
    const float half = scene.half_side(level);
    for (int k = 0; k < 3; ++k) {
      float low = 1e9F, high = -1e9F;
      for (const std::uint32_t leaf : leaves_below(octree, one.node[0])) {
        const float c = scene.to_grid(octree.nodes[leaf].centre)[k];
        low = std::min(low, c - 1), high = std::max(high, c + 1);
      }
      const auto from = static_cast<float>(shape >> (8 + 8 * k) & 15);
      const auto to = static_cast<float>((shape >> (12 + 8 * k) & 15) + 1);
      const float sixteenth = half / 8, origin = x[k] - half;
      const float slack = std::max(0.0F, sixteenth - 2);
      EXPECT_LE(origin + from * sixteenth, low);
      EXPECT_GE(origin + to * sixteenth, high);
      EXPECT_GE(origin + from * sixteenth, low - slack);
      EXPECT_LE(origin + to * sixteenth, high + slack);
    }
  });
  EXPECT_EQ(nodes, octree.nodes.size());
}

TEST(ViewTree, OfSingleViewsHasOneLeafForEach) {
  const Surface& s = surfaces()[1].second;
  const ViewTree tree = ViewTree::of_single_views(s.views);
  EXPECT_EQ(tree.leaf_count(), s.views.size());
  for (std::size_t i = 0; i < s.views.size(); ++i) {
    const ViewTree::Node& v = tree.node(tree.first_leaf() + tree.leaf_of(i));
    EXPECT_EQ(v.centre, s.views[i].x);
    EXPECT_EQ(v.radius, 0);
    EXPECT_EQ(v.views, 1U);
    EXPECT_GT(v.n.dot(s.views[i].n), 1 - 1e-6F);
  }
}

}  // namespace
}  // namespace lacuna
