#pragma once

#include "renderer/connections/importance_cache.h"
#include "renderer/connections/skeleton_connections.h"
#include "renderer/path/strategy.h"
#include "renderer/settings/connections_settings.h"

namespace lacuna {

/// connections: hybrid. Importance caching at the first vertices of an eye path, where records are
/// close; the skeleton at later vertices (Noel 2015, 11.6).
class HybridConnections : public StrategyBase {
 public:
  explicit HybridConnections(const HybridSettings& settings)
      : settings_(settings),
        cache_(settings.cache(), settings.cached_depth),
        skeleton_(settings.skeleton()) {}

  const ResamplingSettings& resampling() const { return settings_; }
  static constexpr std::array<std::string_view, 8> distributions{
      "cache_full", "cache_unshadowed", "cache_bounded", "cache_uniform",
      "visible",    "unshadowed",       "uniform",       "fallback"};
  static constexpr bool needs_space() { return true; }

  void prepare(const PrepareContext& context) { skeleton_.prepare(context); }
  /// The cells of the skeleton, and one for all vertices that use records.
  std::size_t cells() const { return skeleton_.cells() + 1; }
  void begin(const IterationContext& context, const LightVertices& lights,
             const CellStatistics& statistics, Counters& counters) {
    cache_.begin(context, lights, statistics, counters);
    skeleton_.begin(context, lights, statistics, counters);
  }

  /// The distributions used by an eye vertex.
  struct CellLookup {
    std::uint32_t cell = 0;  ///< of CellStatistics
    bool cached = false;
    ImportanceCacheConnections::CellLookup records{};
    SkeletonConnections::CellLookup node{};
  };
  CellLookup find(const Vertex& v, int depth, Rng& rng) const {
    CellLookup lookup;
    lookup.cached = depth <= settings_.cached_depth;
    if (lookup.cached) {
      lookup.records = cache_.find(v, depth, rng);
      lookup.cell = static_cast<std::uint32_t>(skeleton_.cells());
    } else {
      lookup.node = skeleton_.find(v, depth, rng);
      lookup.cell = lookup.node.cell;
    }
    return lookup;
  }

  /// SharedConnections::sample().
  template <class Survival, class Use>
  void sample(const CellLookup& lookup, const LightRange& range, Rng& rng, Survival&& survival,
              Use&& use) const {
    if (lookup.cached) {
      cache_.sample(lookup.records, range, rng, survival, use);
      return;
    }
    skeleton_.sample(lookup.node, range, rng, survival, [&](int s, VertexSample sample) {
      sample.distribution = static_cast<std::uint8_t>(
          sample.distribution + ImportanceCacheConnections::distributions.size());
      use(s, sample);
    });
  }

  std::vector<std::pair<std::string, double>> statistics() const {
    auto stats = cache_.statistics();
    for (auto& more : skeleton_.statistics()) stats.push_back(std::move(more));
    return stats;
  }

 private:
  HybridSettings settings_;
  ImportanceCacheConnections cache_;
  SkeletonConnections skeleton_;
};

}  // namespace lacuna
