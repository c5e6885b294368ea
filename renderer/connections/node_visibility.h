#pragma once

#include <memory>

#include "renderer/path/contexts.h"
#include "renderer/path/light_vertices.h"
#include "renderer/settings/connections_settings.h"
#include "renderer/view_maps/node_maps.h"

namespace lacuna {

/// V between the nodes of the filtered skeleton and light vertices (Noel 2015, eq. 188): by shadow
/// rays, or by the nodes' cube maps of depth, whose time does not depend on the number of triangles
/// (11.6). A few results of maps are verified by rays, for the report only.
class NodeVisibility {
 public:
  /// `nodes`: filtered_nodes(), which must outlive this. Throws the exceptions of
  /// filtered_node_maps().
  void prepare(const PrepareContext& context, std::span<const V3f> nodes,
               const SkeletonConnectionsSettings& settings);

  /// The number of tests.
  struct Tests {
    std::uint64_t rays = 0;
    std::uint64_t checked = 0;  ///< results of maps that were verified by a ray
    std::uint64_t wrong = 0;    ///< of these, results that the ray contradicts

    Tests& operator+=(const Tests& o) {
      rays += o.rays, checked += o.checked, wrong += o.wrong;
      return *this;
    }
  };

  /// V of `node` and each vertex LightVertices::at(s, .), in [0, 1]; by rays, 0 or 1.
  std::vector<double> between(const IterationContext& context, std::size_t node,
                              const LightVertices& lights, int s, Tests& tests) const;

  /// Whether maps are used.
  bool by_maps() const { return maps_ != nullptr; }

 private:
  std::vector<double> by_map(const IterationContext& context, std::size_t node,
                             const LightVertices& lights, int s, Tests& tests) const;

  std::span<const V3f> nodes_;
  std::shared_ptr<const NodeMaps> maps_;
};

/// V of all vertices LightVertices::at(s, .), by a node's cube map.
std::vector<double> visible_fractions(const LightVertices& lights, int s, const NodeView& view);

}  // namespace lacuna
