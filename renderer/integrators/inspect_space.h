#pragma once

#include <optional>
#include <vector>

#include "analysis/skeleton/surface_lookup.h"
#include "renderer/integrators/integrator.h"
#include "renderer/settings/inspect_settings.h"

namespace lacuna {

/// Shows the analysis of the empty space, for the integrator `inspect`: the value of the voxel in
/// front of a surface point.
class SpaceView {
 public:
  /// Builds only the artefacts that the quantity needs. The context's space must outlive the view.
  SpaceView(InspectQuantity quantity, const PrepareContext& context);

  /// The colour of the surface seen along `d` (unit); black where it has no value. The false
  /// colours of labels depend on the seed.
  Rgb colour(const Scene& scene, const Surface& s, const V3f& d, std::uint64_t seed,
             Counters& counters) const;

 private:
  std::uint32_t label_of_node(std::uint32_t node) const;
  /// Green if the node is visible from `s`, else red.
  Rgb sight(const Scene& scene, const Surface& s, std::uint32_t node, Counters& counters) const;

  InspectQuantity quantity_;
  GridTransform transform_;
  std::optional<SurfaceLookup> lookup_;
  const SkeletonGraph* graph_ = nullptr;
  const std::vector<std::uint32_t>* parent_ = nullptr;   // to the simplified skeleton
  const std::vector<std::uint32_t>* cluster_ = nullptr;  // of its nodes
  const Grid3<std::uint16_t>* opening_ = nullptr;
};

}  // namespace lacuna
