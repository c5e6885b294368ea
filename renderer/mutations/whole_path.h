#pragma once

#include <memory>
#include <vector>

#include "renderer/emitters/emitter_point.h"
#include "renderer/path/vertex.h"

namespace lacuna {

/// A vertex of a whole path: of a chain's current path, of its proposed path, or of both.
struct PathVertex {
  Vertex v;
  EmitterPoint emitter;  ///< of the last vertex of a path
};

/// The vertices of a chain's two paths.
class VertexPool {
 public:
  PathVertex& operator[](std::uint32_t i) { return *vertices_[i]; }
  const PathVertex& operator[](std::uint32_t i) const { return *vertices_[i]; }

  std::uint32_t take() {
    if (free_.empty()) {
      vertices_.push_back(std::make_unique<PathVertex>());
      return static_cast<std::uint32_t>(vertices_.size() - 1);
    }
    const std::uint32_t i = free_.back();
    free_.pop_back();
    return i;
  }
  void give_back(std::uint32_t i) { free_.push_back(i); }

 private:
  std::vector<std::unique_ptr<PathVertex>> vertices_;
  std::vector<std::uint32_t> free_;
};

/// A vertex as traversed by one path.
struct PathNode {
  std::uint32_t vertex = 0;  ///< in the VertexPool
  bool delta = false;        ///< whether it scatters by a delta lobe
  bool transmitted = false;  ///< for a delta lobe
};

/// The edge from node i to node i + 1. The factors convert solid-angle densities of directions
/// along the edge into densities of the vertex that the edge leads to (to_area()).
struct PathEdge {
  V3f w{0, 0, 0};      ///< unit, towards the light
  float to_light = 0;  ///< of node i + 1
  float to_eye = 0;    ///< of node i
};

/// A path x_0 ... x_k with x_0 at the eye and x_k on an emitter, and its contribution: f of the
/// path integral (Veach 1997, sec. 8.1), luminance * colour, for radiance over the product area
/// measure. A delta lobe contributes its value (DeltaLobe); a vertex at infinity is measured per
/// steradian.
struct WholePath {
  std::vector<PathNode> nodes;
  std::vector<PathEdge> edges;
  V2f film{0, 0};             ///< position, pixels
  Rgb colour{0, 0, 0};        ///< with luminance 1
  long double luminance = 0;  ///< a product of a thousand densities exceeds the range of double

  int edge_count() const { return static_cast<int>(nodes.size()) - 1; }
  const PathNode& node(int i) const { return nodes[static_cast<std::size_t>(i)]; }
  const PathEdge& edge(int i) const { return edges[static_cast<std::size_t>(i)]; }
};

}  // namespace lacuna
