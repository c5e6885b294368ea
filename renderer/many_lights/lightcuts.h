#pragma once

#include <algorithm>

#include "renderer/many_lights/vpl_contributions.h"
#include "renderer/many_lights/vpl_tree.h"
#include "renderer/path/contexts.h"
#include "renderer/settings/gather_settings.h"

namespace lacuna {

/// gather: lightcuts (Walter et al. 2005, "Lightcuts: a scalable approach to illumination"): a cut
/// through the light trees for each shading point, each node represented by one of its lights,
/// which stands for the intensity of all. The node with the largest bound of its error is replaced
/// by its children until no bound exceeds a share of the point's light. The control of other
/// methods: biased, because errors below the bounds stay.
class Lightcuts {
 public:
  /// `context`: of the random numbers that choose representatives.
  Lightcuts(const VplContributions& terms, const VplTree& tree, const LightcutsSettings& settings,
            const IterationContext& context)
      : terms_(terms), tree_(tree), settings_(settings) {
    constexpr std::uint64_t path = std::uint64_t{1} << 55;  // no pixel's
    Rng rng(context.seed, context.iteration, path, Rng::Purpose::gather);
    for (const VplTree::Node& n : tree.nodes()) {
      representatives_.push_back(tree.choose(n, rng.next()));
    }
    for (std::uint32_t i = 0; i < representatives_.size(); ++i) {
      const VplTree::Node& n = tree.node(i);
      if (n.child == 0) continue;
      const std::uint32_t r = representatives_[i];
      representatives_[r < tree.node(n.child).end ? n.child : n.child + 1] = r;
    }
  }

  /// A light of the node, chosen by probability proportional to intensity. A child has that of its
  /// parent, if that is one of its lights.
  std::uint32_t representative(std::uint32_t node) const { return representatives_[node]; }

  struct Entry {
    std::uint32_t node;
    double bound;  ///< of the error: of the luminance that the node can contribute
    V3d value;     ///< of the representative, with visibility, for all lights of the node
    bool operator<(const Entry& o) const { return bound < o.bound; }
  };

  /// The cut of a shading point. `value(block, lane, weight)`: the contribution of a light with its
  /// visibility, times `weight`; called once for each representative.
  template <class Value>
  std::vector<Entry> cut(const ShadingPoint& at, Value&& value) const {
    std::vector<Entry> heap;
    double total = 0;
    const auto add = [&](std::uint32_t i, const V3d& v) {
      heap.push_back({i, bound(at, tree_.node(i)), v});
      std::push_heap(heap.begin(), heap.end());
      total += luminance_of(v);
    };
    const auto represent = [&](std::uint32_t i) {
      const VplTree::Node& n = tree_.node(i);
      const std::uint32_t light = representative(i);
      add(i, value(tree_.block(light), tree_.lane(light), n.intensity / tree_.intensity(light)));
    };
    for (const std::uint32_t root : tree_.roots()) {
      const std::uint32_t block = tree_.block(tree_.node(root).first);
      if (block < terms_.lights().blocks(at.edges)) represent(root);
    }
    while (!heap.empty() && heap.size() < static_cast<std::size_t>(settings_.most) &&
           heap.front().bound > settings_.error * total) {
      const Entry parent = heap.front();
      std::pop_heap(heap.begin(), heap.end());
      heap.pop_back();
      total -= luminance_of(parent.value);
      const VplTree::Node& node = tree_.node(parent.node);
      for (const std::uint32_t child : {node.child, node.child + 1}) {
        const VplTree::Node& c = tree_.node(child);
        if (representative(child) != representative(parent.node)) {
          represent(child);
        } else {
          add(child, parent.value * double(c.intensity / node.intensity));
        }
      }
    }
    return heap;
  }

  /// Edges between the lights of an entry and their emitter.
  int edges(const Entry& e) const {
    return terms_.lights().edges(tree_.block(tree_.node(e.node).first));
  }
  /// Bound of the luminance that a node contributes, 0 for a single light. For surfaces that are
  /// not Lambertian or have shading normals it is an estimate, that of a Lambertian of their
  /// albedo.
  double bound(const ShadingPoint& at, const VplTree::Node& node) const {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    if (node.child == 0) return 0;
    if (!node.exact) return double{infinity};
    const Vertex& v = *at.vertex;
    const bool diffuse = node.kind == VplTree::Kind::diffuse;
    PointLanes here;
    here.add(at);
    const auto g = node.bounds.geometric_terms(here.x(0), here.n(0), diffuse);
    // A point light's geometric term has no bound: see VplContributions.
    const Float8 term = min(g.at(g.least2), diffuse ? terms_.bound() : infinity);
    const float f = max_component(v.throughput * v.bsdf->albedo()) * inv_pi;
    return double(node.intensity) * double(f) * double(_mm256_cvtss_f32(term.v));
  }

 private:
  static double luminance_of(const V3d& v) { return luminance(v.x, v.y, v.z); }

  const VplContributions& terms_;
  const VplTree& tree_;
  LightcutsSettings settings_;
  std::vector<std::uint32_t> representatives_;  // of each node
};

}  // namespace lacuna
