#pragma once

#include <atomic>
#include <memory>
#include <optional>

#include "analysis/octree/surface_octree.h"
#include "renderer/settings/visibility_settings.h"
#include "renderer/view_maps/view_maps.h"
#include "renderer/view_maps/view_queue.h"
#include "renderer/visibility/visibility_base.h"

namespace lacuna {

/// visibility: view_maps (Kol et al. 2018). Every light has a small map of distances, rendered by a
/// simultaneous traversal of the octrees of the scene and of the lights. Lights at infinity are
/// tested by shadow rays.
class ViewMapVisibility : public VisibilityBase {
 public:
  static constexpr bool needs_space() { return true; }
  static constexpr float guess_cost = 0.17F;  // measured on door (docs)

  explicit ViewMapVisibility(const ViewMapsVisibilitySettings& settings) : settings_(settings) {}

  void prepare(const PrepareContext& context);
  static std::uint32_t group(const VplGeometry& light) { return light.infinite ? no_group : 0; }
  std::vector<BlockRange> passes(const VplSet& lights) const;
  Counters begin(const LightPass& pass);
  struct At {
    V3f x, n;  // n on the side of the eye
  };
  static At at(const ShadingPoint& point, const IterationContext&) {
    return {point.vertex->surface.x, point.vertex->side()};
  }
  void decide(const At& at, std::size_t block, const Terms& terms, VisibilityEstimate& d) const;
  std::vector<std::pair<std::string, double>> statistics() const;

 private:
  /// Looked-up texels, and the texels that were read for them.
  struct Queries {
    std::uint64_t asked = 0, read = 0;
  };
  bool descends() const {
    return settings_.queries == ViewQueries::descend && settings_.method != ViewMapMethod::per_view;
  }
  float nearness(std::uint32_t leaf, int texel, Queries& queries) const;
  bool sees(std::uint32_t leaf, const At& at, Queries& queries) const;

  ViewMapsVisibilitySettings settings_;
  OctreeCube cube_;                    // of both octrees
  std::unique_ptr<SceneNodes> scene_;  // null for per_view, which traces rays
  float cell_ = 0;                     // radius of the scene's leaves
  std::unique_ptr<ViewTree> views_;
  std::unique_ptr<ViewMaps> maps_;
  std::optional<UnfusedMaps> unfused_;  // in place of maps_, if queries descend
  mutable std::atomic<std::uint64_t> asked_ = 0, read_ = 0;
  std::vector<MapTexel> texels_;      // of a map
  std::vector<std::uint32_t> first_;  // of each block of lights: its first view
  const VplSet* lights_ = nullptr;
  ManyViewsCounts counts_;
  std::uint64_t queue_peak_ = 0;  // largest over all passes
  std::uint64_t leaves_ = 0;      // over all passes of an iteration
  int passes_ = 0;
  double scene_seconds_ = 0, tree_seconds_ = 0, map_seconds_ = 0;
  double memory_seconds_ = 0;  // for allocating the maps, whose pages the system clears
};

}  // namespace lacuna
