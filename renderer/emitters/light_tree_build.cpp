// Builds a light tree: groups are split by the surface area orientation heuristic of Conty Estevez
// and Kulla 2018, sec. 4.4, until a node has eight children.

#include <algorithm>
#include <limits>
#include <numbers>

#include "renderer/emitters/light_tree.h"

namespace lacuna {

namespace {

/// Levels of nodes that are split by cost; at lower levels, groups are halved.
constexpr int levels_by_cost = 24;
constexpr int bins = 16;
/// Larger groups are split only along axes of at least half the longest side.
constexpr std::size_t many = 4096;
/// Groups up to this size are split so that nodes become full.
constexpr std::size_t few = 512;
/// The largest angle between a bundle's axes, and its largest radius relative to the scene's.
constexpr double bundle_spread = std::numbers::pi / 3, bundle_size = 1.0 / 32;

/// A bounding box of points, in floats.
struct FloatBox {
  V3f low{std::numeric_limits<float>::infinity()}, high{-std::numeric_limits<float>::infinity()};

  void add(const V3f& p) { add(p, p); }
  void add(const V3f& a, const V3f& b) {
    for (int k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], a[k]);
      high[k] = std::max(high[k], b[k]);
    }
  }
  void add(const FloatBox& b) { add(b.low, b.high); }
  V3f size() const { return high - low; }
};

/// The quantities that determine the cost of a group.
struct Group {
  FloatBox box;
  FloatBox axes;  ///< of the axes of emission, as points
  double intensity = 0;
  std::size_t count = 0;

  void add(const Group& g) {
    box.add(g.box);
    axes.add(g.axes);
    intensity += g.intensity;
    count += g.count;
  }
  /// Intensity times squared size times a measure of the solid angle of emission: from pi, that of
  /// a plane, to 4 pi.
  double cost() const {
    if (count == 0) return 0;
    const V3d size(box.size());
    const V3d spread(axes.size());
    const double turned = std::min(1.0, spread.length2() / 8);
    return intensity * size.length2() * (1 + 3 * turned);
  }
};

/// An emitter with the data for building.
struct Item {
  Group group;
  V3f centre;
  std::uint32_t emitter = 0;
};

Item item_of(const TreeEmitter& e, std::uint32_t index) {
  Item i;
  i.emitter = index;
  const Bounds& box = e.bounds.box;
  i.group.box.add(V3f(box.low), V3f(box.high));
  i.centre = V3f((box.low + box.high) / 2);
  V3d axis = e.bounds.axes.axis;
  if (e.bounds.both_sides && axis.dot(V3d(1, 1e-3, 1e-6)) < 0) axis = -axis;
  if (e.bounds.axes.spread > 2) {
    i.group.axes.add(V3f(-1), V3f(1));
  } else {
    i.group.axes.add(V3f(axis));
  }
  i.group.intensity = e.bounds.intensity;
  i.group.count = 1;
  return i;
}

/// The emitters of a child under construction.
struct Part {
  std::size_t begin = 0, end = 0;
  Group group;
  std::size_t count() const { return end - begin; }
};

}  // namespace

class LightTreeBuilder {
 public:
  LightTreeBuilder(const std::vector<TreeEmitter>& emitters, double extent, LightTree& tree)
      : emitters_(emitters), tree_(tree), largest_bundle_(extent * bundle_size) {
    items_.reserve(emitters.size());
    std::uint32_t entries = 0;
    for (std::uint32_t i = 0; i < emitters.size(); ++i) {
      items_.push_back(item_of(emitters[i], i));
      entries = std::max(entries, emitters[i].entry + 1);
    }
    tree_.places_.assign(entries, LightTree::none);
    if (items_.empty()) return;
    tree_.member_of_.assign(entries, 0);
    build({0, items_.size(), group_of(0, items_.size())}, add_nodes(1), 0, false);
  }

 private:
  Group group_of(std::size_t begin, std::size_t end) const {
    Group g;
    for (std::size_t i = begin; i < end; ++i) g.add(items_[i].group);
    return g;
  }

  /// Adds `n` contiguous nodes and returns the index of the first; the children of a node are
  /// contiguous.
  std::uint32_t add_nodes(std::size_t n) {
    const std::size_t size = tree_.nodes_.size() + n;
    tree_.nodes_.resize(size);
    tree_.parents_.resize(size, LightTree::none);
    tree_.bundle_of_.resize(size, LightTree::none);
    tree_.entries_.resize(size * LightTree::width, LightTree::none);
    return static_cast<std::uint32_t>(size - n);
  }

  /// Builds the node `index` of a group and all nodes below it; returns its bounds. `bundled`: it
  /// is inside a bundle.
  EmitterBounds build(const Part& all, std::uint32_t index, int depth, bool bundled) {
    const std::vector<Part> parts = children_of(all, depth);
    std::array<EmitterBounds, LightTree::width> children;
    std::uint8_t nodes = 0, bundles = 0;
    const auto inner = std::count_if(parts.begin(), parts.end(),
                                     [](const Part& part) { return part.count() > 1; });
    const std::uint32_t first = add_nodes(static_cast<std::size_t>(inner));
    std::uint32_t child = first;
    for (std::size_t k = 0; k < parts.size(); ++k) {
      const Part& part = parts[k];
      const auto own = static_cast<std::uint32_t>(index * LightTree::width + k);
      if (part.count() == 1) {
        const TreeEmitter& e = emitters_[items_[part.begin].emitter];
        children[k] = e.bounds;
        tree_.places_[e.entry] = own;
        tree_.entries_[own] = e.entry;
        continue;
      }
      const bool bundle = !bundled && is_bundle(part);
      nodes = static_cast<std::uint8_t>(nodes | 1U << k);
      if (bundle) bundles = static_cast<std::uint8_t>(bundles | 1U << k);
      tree_.parents_[child] = own;
      children[k] = build(part, child, depth + 1, bundled || bundle);
      if (bundle) add_bundle(child, part);
      ++child;
    }
    const auto bounds = std::span(children).first(parts.size());
    LightNode& node = tree_.nodes_[index] = LightNode(bounds);
    node.first = first;
    node.nodes = nodes;
    node.bundles = bundles;
    EmitterBounds joined = bounds[0];
    for (const EmitterBounds& b : bounds.subspan(1)) joined = EmitterBounds::join(joined, b);
    return joined;
  }

  /// Whether a part is small relative to the scene and consists of surfaces that face one way.
  bool is_bundle(const Part& part) const {
    if (!(largest_bundle_ > 0)) return false;
    EmitterBounds all = emitters_[items_[part.begin].emitter].bounds;
    for (std::size_t i = part.begin; i < part.end; ++i) {
      const EmitterBounds& b = emitters_[items_[i].emitter].bounds;
      if (b.reach < std::numbers::pi / 2 || b.axes.spread > 0) return false;
      all = EmitterBounds::join(all, b);
      if (all.axes.spread > bundle_spread || all.box.radius() > largest_bundle_) return false;
    }
    return true;
  }

  void add_bundle(std::uint32_t node, const Part& part) {
    LightTree::Bundle bundle;
    std::vector<double> intensities;
    for (std::size_t i = part.begin; i < part.end; ++i) {
      const TreeEmitter& e = emitters_[items_[i].emitter];
      tree_.member_of_[e.entry] = static_cast<std::uint32_t>(bundle.entries.size());
      bundle.entries.push_back(e.entry);
      intensities.push_back(e.bounds.intensity);
    }
    bundle.by_intensity = AliasTable(intensities);
    tree_.bundle_of_[node] = static_cast<std::uint32_t>(tree_.bundles_.size());
    tree_.bundled_ += part.count();
    tree_.bundles_.push_back(std::move(bundle));
  }

  std::vector<Part> children_of(const Part& all, int depth) {
    std::vector<Part> parts{all};
    if (all.count() <= std::size_t{LightTree::width}) {
      parts.clear();
      for (std::size_t i = all.begin; i < all.end; ++i) parts.push_back({i, i + 1, {}});
      return parts;
    }
    std::size_t least = 1;
    if (all.count() <= few) {
      while (least * LightTree::width < all.count()) least *= LightTree::width;
    }
    // The gain of splitting a part.
    const auto worth = [&](const Part& p) {
      if (p.count() <= least) return -1.0;
      return depth < levels_by_cost ? p.group.cost() : static_cast<double>(p.count());
    };
    while (parts.size() < std::size_t{LightTree::width}) {
      const auto next =
          std::max_element(parts.begin(), parts.end(),
                           [&](const Part& a, const Part& b) { return worth(a) < worth(b); });
      if (worth(*next) < 0) break;
      const auto [first, second] = least > 1 ? split_few(*next, least) : split(*next, depth);
      *next = first;
      parts.push_back(second);
    }
    return parts;
  }

  /// Splits at a multiple of `unit` emitters, sorted along an axis.
  std::pair<Part, Part> split_few(const Part& p, std::size_t unit) {
    double best = std::numeric_limits<double>::infinity();
    int best_axis = 0;
    std::pair<Part, Part> result;
    const V3f size = p.group.box.size();
    for (int axis = 0; axis < 3; ++axis) {
      sort_along(p, axis);
      const double elongation =
          size[axis] > 0 ? std::min(1e6, double(max_component(size) / size[axis])) : 1e6;
      for (std::size_t m = p.begin + unit; m < p.end; m += unit) {
        const Part below{p.begin, m, group_of(p.begin, m)}, above{m, p.end, group_of(m, p.end)};
        const double cost = elongation * (below.group.cost() + above.group.cost());
        if (!(cost < best)) continue;
        best = cost;
        best_axis = axis;
        result = {below, above};
      }
    }
    sort_along(p, best_axis);
    return result;
  }

  void sort_along(const Part& p, int axis) {
    std::sort(at(p.begin), at(p.end), [axis](const Item& a, const Item& b) {
      return std::pair(a.centre[axis], a.emitter) < std::pair(b.centre[axis], b.emitter);
    });
  }

  std::pair<Part, Part> split(const Part& p, int depth) {
    FloatBox centres;
    for (std::size_t i = p.begin; i < p.end; ++i) centres.add(items_[i].centre);
    const V3f size = centres.size();
    const float longest = max_component(size);
    if (depth < levels_by_cost && longest > 0) {
      double best = std::numeric_limits<double>::infinity();
      std::pair<Part, Part> result;
      int best_axis = -1, best_bin = 0;
      for (int axis = 0; axis < 3; ++axis) {
        if (!(size[axis] > longest * (p.count() > many ? 0.5F : 0x1p-20F))) continue;
        const auto binned = bin(p, centres, axis);
        try_splits(binned, double(longest / size[axis]), axis, best, best_axis, best_bin, result);
      }
      if (best_axis >= 0) {
        const auto middle = std::partition(at(p.begin), at(p.end), [&](const Item& i) {
          return bin_of(i, centres, best_axis) <= best_bin;
        });
        result.first.begin = p.begin;
        result.first.end = result.second.begin = static_cast<std::size_t>(middle - items_.begin());
        result.second.end = p.end;
        return result;
      }
    }
    return halve(p, size);
  }

  std::vector<Item>::iterator at(std::size_t i) {
    return items_.begin() + static_cast<std::ptrdiff_t>(i);
  }

  static int bin_of(const Item& i, const FloatBox& centres, int axis) {
    const float low = centres.low[axis];
    const float size = centres.high[axis] - low;
    return std::clamp(static_cast<int>((i.centre[axis] - low) / size * float{bins}), 0, bins - 1);
  }

  std::array<Group, bins> bin(const Part& p, const FloatBox& centres, int axis) const {
    std::array<Group, bins> result;
    for (std::size_t i = p.begin; i < p.end; ++i) {
      result[static_cast<std::size_t>(bin_of(items_[i], centres, axis))].add(items_[i].group);
    }
    return result;
  }

  /// Tries each split between two bins and keeps the cheapest.
  static void try_splits(const std::array<Group, bins>& binned, double elongation, int axis,
                         double& best, int& best_axis, int& best_bin,
                         std::pair<Part, Part>& result) {
    std::array<Group, bins> from_above;
    Group sum;
    for (std::size_t b = bins; b-- > 1;) {
      sum.add(binned[b]);
      from_above[b] = sum;
    }
    Group below;
    for (std::size_t b = 0; b + 1 < bins; ++b) {
      below.add(binned[b]);
      const Group& above = from_above[b + 1];
      if (below.count == 0 || above.count == 0) continue;
      const double cost = elongation * (below.cost() + above.cost());
      if (!(cost < best)) continue;
      best = cost;
      best_axis = axis;
      best_bin = static_cast<int>(b);
      result.first.group = below;
      result.second.group = above;
    }
  }

  /// Halves the emitters along the longest axis; in any order if all are at one point.
  std::pair<Part, Part> halve(const Part& p, const V3f& size) {
    const std::size_t middle = p.begin + p.count() / 2;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    if (size[axis] > 0) {
      std::nth_element(at(p.begin), at(middle), at(p.end), [axis](const Item& a, const Item& b) {
        return std::pair(a.centre[axis], a.emitter) < std::pair(b.centre[axis], b.emitter);
      });
    }
    return {{p.begin, middle, group_of(p.begin, middle)}, {middle, p.end, group_of(middle, p.end)}};
  }

  const std::vector<TreeEmitter>& emitters_;
  LightTree& tree_;
  std::vector<Item> items_;
  double largest_bundle_;
};

LightTree::LightTree(const std::vector<TreeEmitter>& emitters, double extent) {
  LightTreeBuilder(emitters, extent, *this);
}

}  // namespace lacuna
