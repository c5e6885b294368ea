#pragma once

#include "renderer/connections/cell_statistics.h"
#include "renderer/connections/resampling_cell.h"
#include "renderer/path/strategy.h"
#include "renderer/settings/connections_settings.h"

namespace lacuna {

/// connections: uniform. The control of all resampling: no guidance at all.
class UniformConnections : public StrategyBase {
 public:
  explicit UniformConnections(const UniformSettings& settings) : settings_(settings) {}

  const ResamplingSettings& resampling() const { return settings_; }
  static constexpr std::array<std::string_view, 1> distributions{"uniform"};

  static std::size_t cells() { return 1; }
  static void begin(const IterationContext&, const LightVertices&, const CellStatistics&,
                    Counters&) {}

  /// Where connections from an eye vertex are drawn.
  struct Place {
    std::uint32_t cell = 0;  ///< of CellStatistics
  };
  static Place find(const Vertex&, int /*depth*/, Rng&) { return {}; }

  /// Calls `use(s, pick)` for a light path of each length in [1, longest], made with probability
  /// `survival(s)`.
  template <class Survival, class Use>
  static void pick(const Place&, const LightVertices& lights, int longest, Rng& rng,
                   Survival&& survival, Use&& use) {
    sample_uniformly(lights, longest, rng, 0, survival, use);
  }

 private:
  UniformSettings settings_;
};

}  // namespace lacuna
