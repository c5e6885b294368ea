#pragma once

#include <optional>
#include <vector>

#include "analysis/skeleton/surface_lookup.h"
#include "renderer/integrators/integrator.h"
#include "renderer/settings/inspect_settings.h"

namespace lacuna {

/// What `inspect` shows of the analysis of empty space: the value that a surface point has through
/// the voxel in front of it.
class SpaceView {
 public:
  /// Builds what the quantity needs, and only that. The context's space must outlive the view.
  SpaceView(InspectQuantity quantity, const PrepareContext& context);

  /// The colour of the surface seen along `d` (unit); black where it belongs to nothing. Labels
  /// have false colours that hold for the seed.
  Rgb colour(const Scene& scene, const Surface& s, const V3f& d, std::uint64_t seed,
             Counters& counters) const;

 private:
  std::uint32_t label_of_node(std::uint32_t node) const;
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
