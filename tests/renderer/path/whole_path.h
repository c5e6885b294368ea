#pragma once

#include <vector>

#include "renderer/path/light_batch.h"

namespace lacuna::test {

/// A whole path x_0 ... x_k of k edges, x_0 on an emitter and x_k at the eye, whoever made it.
struct WholePath {
  struct Node {
    Surface surface;
    std::optional<Bsdf> bsdf;
    bool delta = false;  ///< the path passes through a delta lobe here
  };

  EmitterPoint emitter;      ///< x_0
  std::vector<Node> nodes;   ///< x_1 ... x_{k-1}
  V3f eye{0, 0, 0};          ///< x_k
  std::vector<V3f> forward;  ///< [i]: unit, from x_i to x_{i+1}

  int edges() const { return static_cast<int>(nodes.size()) + 1; }
  /// x_i, 0 < i < k.
  const Node& node(int i) const { return nodes[static_cast<std::size_t>(i) - 1]; }
  const V3f& towards_eye(int i) const { return forward[static_cast<std::size_t>(i)]; }
  /// Not of x_0 at infinity.
  const V3f& x(int i) const {
    if (i == 0) return emitter.x;
    return i == edges() ? eye : node(i).surface.x;
  }
  /// Whether strategy s can join x_{s-1} and x_s, 0 < s <= k: a delta lobe joins nothing. Any
  /// emitter and the eye can be joined.
  bool joins(int s) const {
    const bool light = s == 1 || !node(s - 1).delta;
    const bool other = s == edges() || !node(s).delta;
    return light && other;
  }
};

/// Puts a whole path together from the eye's end.
class PathFromEye {
 public:
  explicit PathFromEye(const V3f& eye) { path_.eye = eye; }

  /// Adds `v`, reached against v.wp. `last`: where two walks were joined, so that the path does not
  /// take the lobe by which this walk went on.
  void add(const Vertex& v, bool last) {
    path_.nodes.push_back({v.surface, v.bsdf, v.delta && !last});
    path_.forward.push_back(v.wp);
  }
  /// Adds vertices `s` - 1 ... 1 of a walk from the light and its emitter; `w` is the unit
  /// direction from the last vertex of the eye's walk to the next.
  template <class VertexAt>
  WholePath finish(const EmitterPoint& emitter, int s, const VertexAt& vertex, const V3f& w) {
    V3f forward = -w;
    for (int j = s - 1; j >= 1; --j) {
      const Vertex& v = vertex(j);
      path_.nodes.push_back({v.surface, v.bsdf, v.delta && j != s - 1});
      path_.forward.push_back(forward);
      forward = -v.wp;
    }
    path_.emitter = emitter;
    path_.forward.push_back(forward);
    std::reverse(path_.nodes.begin(), path_.nodes.end());
    std::reverse(path_.forward.begin(), path_.forward.end());
    return std::move(path_);
  }

 private:
  WholePath path_;
};

}  // namespace lacuna::test
