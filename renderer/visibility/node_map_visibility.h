#pragma once

#include <optional>

#include "renderer/settings/visibility_settings.h"
#include "renderer/view_maps/filtered_node_maps.h"
#include "renderer/visibility/skeleton_node.h"
#include "renderer/visibility/visibility_base.h"

namespace lacuna {

/// visibility: node_maps. All lights of a node of the filtered skeleton share the visibility of the
/// node: shading points not visible from the node skip all of them (Noel 2015, ch. 8, eq. 161).
/// Lights without a node are tested by shadow rays.
class NodeMapVisibility : public VisibilityBase {
 public:
  static constexpr bool needs_space() { return true; }
  static constexpr float guess_cost = 0.04F;  // measured on door (docs)

  explicit NodeMapVisibility(const NodeMapsVisibilitySettings& settings) : settings_(settings) {}

  void prepare(const PrepareContext& context);
  std::uint32_t group(const VplGeometry& light) const { return node_of(*lookup_, light); }
  std::uint64_t groups() const { return nodes_.size(); }
  Counters begin(const LightPass& pass);
  struct At {
    V3f x, n;                    // n on the side of the eye
    std::vector<float> visible;  // fraction, by index in `views_`; negative: not computed yet
  };
  At at(const ShadingPoint& point, const IterationContext& context) const;
  bool hides(At& at, std::size_t block) const {
    const std::uint32_t view = view_of_[block];
    if (view == no_group) return false;
    if (at.visible[view] < 0) at.visible[view] = views_[view].visible_fraction(at.x, at.n);
    return at.visible[view] == 0;
  }
  /// Requires hides(at, block) == false.
  void decide(const At& at, std::size_t block, const Terms& terms, VisibilityEstimate& d) const {
    const std::uint32_t view = view_of_[block];
    if (view == no_group) return test_all(terms, d);
    d.tests = 0;
    d.untested.v.fill(at.visible[view]);
  }
  std::vector<std::pair<std::string, double>> statistics() const;

 private:
  NodeMapsVisibilitySettings settings_;
  std::vector<V3f> nodes_;  // scene units
  std::optional<SurfaceLookup> lookup_;
  std::shared_ptr<const NodeMaps> maps_;
  std::vector<NodeView> views_;         // of nodes with lights
  std::vector<std::uint32_t> view_of_;  // of each block of lights
};

}  // namespace lacuna
