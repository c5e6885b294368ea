#pragma once

#include <optional>

#include "analysis/skeleton/surface_lookup.h"
#include "renderer/connections/cell_statistics.h"
#include "renderer/connections/resampling_cell.h"
#include "renderer/path/strategy.h"
#include "renderer/settings/connections_settings.h"

namespace lacuna {

/// connections: skeleton. Light paths are resampled by distributions at the nodes of the filtered
/// skeleton, which see much of what the eye vertices around them see (Noel 2015, 11.2-11.4).
class SkeletonConnections : public StrategyBase {
 public:
  explicit SkeletonConnections(const SkeletonConnectionsSettings& settings) : settings_(settings) {}

  const ResamplingSettings& resampling() const { return settings_; }
  static constexpr std::array<std::string_view, 3> distributions{"visible", "unshadowed",
                                                                 "uniform"};
  static constexpr bool needs_space() { return true; }

  void prepare(const PrepareContext& context);
  /// The nodes, and one for what belongs to none.
  std::size_t cells() const { return positions_.size() + 1; }
  /// Builds the distributions of the nodes that enough eye vertices of the iterations before
  /// belonged to; of the first iteration none.
  void begin(const IterationContext& context, const LightVertices& lights,
             const CellStatistics& seen, Counters& counters);

  /// Where connections from an eye vertex are drawn.
  struct Place {
    std::uint32_t cell = 0;                ///< of CellStatistics
    const ResamplingCell* site = nullptr;  // none: uniformly
  };
  Place find(const Vertex& v, int /*depth*/, Rng&) const {
    const std::uint32_t node = lookup_->node(V3d(v.surface.x), V3d(v.surface.ng), V3d(v.wp));
    if (node == no_node) return {static_cast<std::uint32_t>(positions_.size()), nullptr};
    return {node, sites_[node].empty() ? nullptr : &sites_[node]};
  }

  /// Calls `use(s, pick)` for a light path of each length in [1, longest], made with probability
  /// `survival(s)`.
  template <class Survival, class Use>
  void pick(const Place& place, const LightVertices& lights, int longest, Rng& rng,
            Survival&& survival, Use&& use) const {
    if (place.site == nullptr) {
      sample_uniformly(lights, longest, rng, uniform, survival, use);
      return;
    }
    const ResamplingCell& site = *place.site;
    sample_connections(
        lights, longest, survival, [&](int s) { return site.table(s).choose(rng); },
        [&](int s, std::uint32_t chosen) {
          const AliasTable::Draw d = site.table(s).resolve(chosen, rng);
          return VertexSample{d.index, d.pmf.value, site.table(s).owner(d.index)};
        },
        use);
  }

  std::vector<std::pair<std::string, double>> statistics() const;

 private:
  static constexpr std::uint8_t uniform = 2;  // in `distributions`

  bool accepted(std::uint64_t mapped, std::uint64_t sum) const;
  std::uint64_t build(std::size_t node, const Scene& scene, const LightVertices& lights);

  SkeletonConnectionsSettings settings_;
  std::vector<V3f> positions_;  // of the nodes, scene units
  double least_distance_ = 0;
  std::optional<SurfaceLookup> lookup_;
  std::vector<ResamplingCell> sites_;
  std::size_t used_ = 0;
};

}  // namespace lacuna
