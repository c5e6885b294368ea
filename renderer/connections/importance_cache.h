#pragma once

#include <limits>

#include "renderer/connections/cell_statistics.h"
#include "renderer/connections/eye_records.h"
#include "renderer/connections/resampling_cell.h"
#include "renderer/path/strategy.h"
#include "renderer/settings/connections_settings.h"

namespace lacuna {

/// connections: importance_cache. Light vertices are resampled by distributions at records, the
/// vertices of a few eye paths traced in each iteration (Georgiev et al. 2012, "Importance Caching
/// for Complex Illumination"; with bidirectional path tracing: Noel 2015, 11.5).
class ImportanceCacheConnections : public StrategyBase {
 public:
  /// Records are placed up to `record_depth` edges from the eye.
  explicit ImportanceCacheConnections(const ImportanceCacheSettings& settings,
                                      int record_depth = std::numeric_limits<int>::max())
      : settings_(settings), record_depth_(record_depth) {}

  const ResamplingSettings& resampling() const { return settings_; }
  static constexpr std::array<std::string_view, 4> distributions{"full", "unshadowed", "bounded",
                                                                 "uniform"};

  static std::size_t cells() { return 1; }  // records change in each iteration
  /// Traces the records and builds their distributions. Throws MemoryLimitError if there is no
  /// memory for them.
  void begin(const IterationContext& context, const LightVertices& lights, const CellStatistics&,
             Counters& counters);

  struct CellLookup : EyeRecords::Neighbours {
    const ResamplingCell* selected = nullptr;  ///< of one of the nearest records, at random
  };
  CellLookup find(const Vertex& v, int /*depth*/, Rng& rng) const {
    CellLookup lookup{records_.nearest(v, settings_.neighbours)};
    if (lookup.n > 0) {
      lookup.selected = &cells_of_records_[lookup.index[rng.below(lookup.n)]];
    }
    return lookup;
  }

  /// SharedConnections::sample(). One of the n nearest records, selected uniformly, samples all
  /// light vertices; the probability of a vertex is the mean of its probabilities at the n records.
  template <class Survival, class Use>
  void sample(const CellLookup& lookup, const LightRange& range, Rng& rng, Survival&& survival,
              Use&& use) const {
    if (lookup.n == 0) {
      sample_uniformly(range, rng, uniform, survival, use);
      return;
    }
    sample_connections(
        range, survival, [&](int s) { return lookup.selected->table(s).choose(rng); },
        [&](int s, std::uint32_t chosen) {
          const std::uint32_t i = lookup.selected->table(s).resolve(chosen, rng).index;
          float sum = 0;
          for (std::size_t k = 0; k < lookup.n; ++k) {
            sum += cells_of_records_[lookup.index[k]].table(s).pmf(i).value;
          }
          return VertexSample{i, sum / static_cast<float>(lookup.n),
                              lookup.selected->table(s).distribution(i)};
        },
        use);
  }

  std::vector<std::pair<std::string, double>> statistics() const {
    return {{"records", static_cast<double>(records_.size())}};
  }

 private:
  static constexpr std::uint8_t uniform = 3;  // index in `distributions`

  std::uint64_t build(const EyeRecords::Record& record, ResamplingCell& cell,
                      const IterationContext& context, const LightVertices& lights) const;

  ImportanceCacheSettings settings_;
  int record_depth_;
  EyeRecords records_;
  std::vector<ResamplingCell> cells_of_records_;
};

}  // namespace lacuna
