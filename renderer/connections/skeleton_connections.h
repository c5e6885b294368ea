#pragma once

#include <optional>

#include "analysis/skeleton/surface_lookup.h"
#include "renderer/connections/cell_statistics.h"
#include "renderer/connections/node_visibility.h"
#include "renderer/connections/resampling_cell.h"
#include "renderer/path/strategy.h"
#include "renderer/settings/connections_settings.h"

namespace lacuna {

/// connections: skeleton. Light vertices are resampled by distributions at the nodes of the
/// filtered skeleton: a node sees much of what the eye vertices around it see (Noel 2015,
/// 11.2-11.4).
class SkeletonConnections : public StrategyBase {
 public:
  explicit SkeletonConnections(const SkeletonConnectionsSettings& settings) : settings_(settings) {}

  const ResamplingSettings& resampling() const { return settings_; }
  static constexpr std::array<std::string_view, 4> distributions{"visible", "unshadowed", "uniform",
                                                                 "fallback"};
  static constexpr bool needs_space() { return true; }

  void prepare(const PrepareContext& context);
  /// One cell per node, and one for eye vertices without a node.
  std::size_t cells() const { return positions_.size() + 1; }
  /// Builds the distributions of nodes with enough eye vertices in earlier iterations; none in the
  /// first iteration.
  void begin(const IterationContext& context, const LightVertices& lights,
             const CellStatistics& statistics, Counters& counters);

  /// The node used by an eye vertex.
  struct CellLookup {
    std::uint32_t cell = 0;                         ///< of CellStatistics
    const ResamplingCell* distributions = nullptr;  // null: sample uniformly
  };
  CellLookup find(const Vertex& v, int /*depth*/, Rng&) const {
    const std::uint32_t node = lookup_->node(V3d(v.surface.x), V3d(v.surface.ng), V3d(v.wp));
    if (node == no_node) return {static_cast<std::uint32_t>(positions_.size()), nullptr};
    return {node, cells_of_nodes_[node].empty() ? nullptr : &cells_of_nodes_[node]};
  }

  /// SharedConnections::sample().
  template <class Survival, class Use>
  void sample(const CellLookup& lookup, const LightRange& range, Rng& rng, Survival&& survival,
              Use&& use) const {
    if (lookup.distributions == nullptr) {
      sample_uniformly(range, rng, fallback, survival, use);
      return;
    }
    const ResamplingCell& cell = *lookup.distributions;
    sample_connections(
        range, survival, [&](int s) { return cell.table(s).choose(rng); },
        [&](int s, std::uint32_t chosen) {
          const AliasTable::Sample d = cell.table(s).resolve(chosen, rng);
          return VertexSample{d.index, d.pmf.value, cell.table(s).distribution(d.index)};
        },
        use);
  }

  std::vector<std::pair<std::string, double>> statistics() const;

 private:
  // Index in `distributions` for eye vertices whose node has no distributions (Noel 2015, Fig.
  // 106).
  static constexpr std::uint8_t fallback = 3;

  bool accepted(std::uint64_t mapped, std::uint64_t sum) const;
  NodeVisibility::Tests build(std::size_t node, const IterationContext& context,
                              const LightVertices& lights);

  SkeletonConnectionsSettings settings_;
  std::vector<V3f> positions_;  // of the nodes, scene units
  double least_distance_ = 0;
  std::optional<SurfaceLookup> lookup_;
  NodeVisibility visibility_;
  NodeVisibility::Tests tests_;  // over all iterations of this process
  std::vector<ResamplingCell> cells_of_nodes_;
  std::size_t used_ = 0;
};

}  // namespace lacuna
