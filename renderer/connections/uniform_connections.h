#pragma once

#include "renderer/connections/cell_statistics.h"
#include "renderer/connections/resampling_cell.h"
#include "renderer/path/strategy.h"
#include "renderer/settings/connections_settings.h"

namespace lacuna {

/// connections: uniform. Samples all light vertices with equal probability: the baseline for the
/// other resampling strategies.
class UniformConnections : public StrategyBase {
 public:
  explicit UniformConnections(const UniformSettings& settings) : settings_(settings) {}

  const ResamplingSettings& resampling() const { return settings_; }
  static constexpr std::array<std::string_view, 1> distributions{"uniform"};

  static std::size_t cells() { return 1; }
  static void begin(const IterationContext&, const LightVertices&, const CellStatistics&,
                    Counters&) {}

  /// All eye vertices are one cell.
  struct CellLookup {
    std::uint32_t cell = 0;  ///< of CellStatistics
  };
  static CellLookup find(const Vertex&, int /*depth*/, Rng&) { return {}; }

  /// SharedConnections::sample().
  template <class Survival, class Use>
  static void sample(const CellLookup&, const LightRange& range, Rng& rng, Survival&& survival,
                     Use&& use) {
    sample_uniformly(range, rng, 0, survival, use);
  }

 private:
  UniformSettings settings_;
};

}  // namespace lacuna
