#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "renderer/guides/gathered_light.h"

namespace lacuna {

/// Paths with all their branches, and what each continuation at a vertex gathered for its rays: the
/// samples of the moments that EfficiencyRoulette decides by. Unlike GatheredLight::record(), in
/// which one part of a split path stands for all, these are samples of the estimate that is made,
/// with its branches.
class PathTrees {
 public:
  /// Call before paths start or resume.
  void begin(std::span<PathState> states) {
    for (PathState& w : states) {
      const auto segment = static_cast<std::uint32_t>(segments_.size());
      segments_.push_back({.parent = w.segment, .first = w.depth});
      w.segment = segment;
    }
  }

  /// Call when these paths have been traced. `key(v, depth)`: the cell of a connectible vertex.
  template <class Key>
  void collect(const EyeBatch& batch, const GatheredLight& gathered, Key&& key) {
    for (std::size_t i = 0; i < batch.states.size(); ++i) {
      Segment& s = segments_[batch.states[i].segment];
      s.nodes = nodes_.size();
      s.last = gathered.last(i);
      for (int depth = s.first; depth <= s.last; ++depth) {
        Node& n = nodes_.emplace_back();
        // What the first vertex of a branch gathers itself is that of the path that was split.
        if (depth > s.first) {
          n.light = luminance(gathered.light(i, depth));
          n.rays = 1 + gathered.shadow_rays(i, depth);
        }
        const Vertex& v = batch.vertex(i, depth);
        if (!GatheredLight::connectible(v)) continue;
        n.carried = gathered.carried(i, depth);
        if (n.carried > 0) n.key = key(v, depth);
      }
    }
  }

  /// Calls `add(key, value, rays)` for every continuation, when all branches are collected: what it
  /// gathered over its throughput, and its rays. Forgets the paths.
  template <class Add>
  void record(Add&& add) {
    for (std::size_t i = segments_.size(); i-- > 0;) {
      const Segment& s = segments_[i];
      double light = 0, rays = 0;
      for (int depth = s.last; depth >= s.first; --depth) {
        const Node& n = node(s, depth);
        if (n.carried > 0) add(n.key, light / double(n.carried), rays);
        light += n.light;
        rays += n.rays;
      }
      if (s.first == 0) continue;
      Node& at = node(segments_[s.parent], s.first);
      at.light += light;
      at.rays += rays;
    }
    segments_.clear();
    nodes_.clear();
  }

 private:
  /// A path, or a branch from where its path was split.
  struct Segment {
    std::uint32_t parent;
    int first, last = 0;
    std::size_t nodes = 0;
  };
  /// A vertex. `light` and `rays` are its own and those of the branches that start there.
  struct Node {
    double light = 0, rays = 0;
    float carried = 0;
    std::uint32_t key = 0;
  };
  Node& node(const Segment& s, int depth) {
    return nodes_[s.nodes + static_cast<std::size_t>(depth - s.first)];
  }

  std::vector<Segment> segments_;
  std::vector<Node> nodes_;
};

}  // namespace lacuna
