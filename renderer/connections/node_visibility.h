#pragma once

#include <memory>

#include "renderer/path/contexts.h"
#include "renderer/path/light_vertices.h"
#include "renderer/settings/connections_settings.h"
#include "renderer/view_maps/node_maps.h"

namespace lacuna {

/// V between the nodes of the filtered skeleton and light vertices (Noel 2015, eq. 188): by shadow
/// rays, or by the nodes' cube maps of depth, which take the same time however many triangles there
/// are (11.6). A few decisions by maps are checked by rays; what the checks find changes nothing
/// but the report.
class NodeVisibility {
 public:
  /// `nodes`: those of filtered_nodes(), which must outlive it. Throws what filtered_node_maps()
  /// does.
  void prepare(const PrepareContext& context, std::span<const V3f> nodes,
               const SkeletonConnectionsSettings& settings);

  /// What its answers have taken.
  struct Tests {
    std::uint64_t rays = 0;
    std::uint64_t checked = 0;  ///< decisions by maps that a ray was traced for, too
    std::uint64_t wrong = 0;    ///< of these, where the map says the other

    Tests& operator+=(const Tests& o) {
      rays += o.rays, checked += o.checked, wrong += o.wrong;
      return *this;
    }
  };

  /// V of `node` and each vertex LightVertices::at(s, .), in [0, 1]; by rays, 0 or 1.
  std::vector<double> between(const IterationContext& context, std::size_t node,
                              const LightVertices& lights, int s, Tests& tests) const;

  /// There are maps.
  bool by_maps() const { return maps_ != nullptr; }

 private:
  std::vector<double> by_map(const IterationContext& context, std::size_t node,
                             const LightVertices& lights, int s, Tests& tests) const;

  std::span<const V3f> nodes_;
  std::shared_ptr<const NodeMaps> maps_;
};

/// V by a node's cube map of all vertices LightVertices::at(s, .).
std::vector<double> seen_from(const LightVertices& lights, int s, const NodeView& view);

}  // namespace lacuna
