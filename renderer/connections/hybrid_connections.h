#pragma once

#include "renderer/connections/importance_cache.h"
#include "renderer/connections/skeleton_connections.h"
#include "renderer/path/strategy.h"
#include "renderer/settings/connections_settings.h"

namespace lacuna {

/// connections: hybrid. Importance caching at the first vertices of an eye's path, where records
/// are near; the skeleton beyond (Noel 2015, 11.6).
class HybridConnections : public StrategyBase {
 public:
  explicit HybridConnections(const HybridSettings& settings)
      : settings_(settings),
        cache_(settings.cache(), settings.cached_depth),
        skeleton_(settings.skeleton()) {}

  const ResamplingSettings& resampling() const { return settings_; }
  static constexpr std::array<std::string_view, 7> distributions{
      "cache_full", "cache_unshadowed", "cache_bounded", "cache_uniform",
      "visible",    "unshadowed",       "uniform"};
  static constexpr bool needs_space() { return true; }

  void prepare(const PrepareContext& context) { skeleton_.prepare(context); }
  /// The skeleton's, and one for all vertices that use records.
  std::size_t cells() const { return skeleton_.cells() + 1; }
  void begin(const IterationContext& context, const LightVertices& lights,
             const CellStatistics& seen, Counters& counters) {
    cache_.begin(context, lights, seen, counters);
    skeleton_.begin(context, lights, seen, counters);
  }

  /// Where connections from an eye vertex are drawn.
  struct Place {
    std::uint32_t cell = 0;  ///< of CellStatistics
    bool cached = false;
    ImportanceCacheConnections::Place records{};
    SkeletonConnections::Place node{};
  };
  Place find(const Vertex& v, int depth, Rng& rng) const {
    Place place;
    place.cached = depth <= settings_.cached_depth;
    if (place.cached) {
      place.records = cache_.find(v, depth, rng);
      place.cell = static_cast<std::uint32_t>(skeleton_.cells());
    } else {
      place.node = skeleton_.find(v, depth, rng);
      place.cell = place.node.cell;
    }
    return place;
  }

  /// Calls `use(s, pick)` for a light path of each length in [1, longest], made with probability
  /// `survival(s)`.
  template <class Survival, class Use>
  void pick(const Place& place, const LightVertices& lights, int longest, Rng& rng,
            Survival&& survival, Use&& use) const {
    if (place.cached) {
      cache_.pick(place.records, lights, longest, rng, survival, use);
      return;
    }
    skeleton_.pick(place.node, lights, longest, rng, survival, [&](int s, VertexSample pick) {
      pick.owner =
          static_cast<std::uint8_t>(pick.owner + ImportanceCacheConnections::distributions.size());
      use(s, pick);
    });
  }

  std::vector<std::pair<std::string, double>> statistics() const {
    auto told = cache_.statistics();
    for (auto& more : skeleton_.statistics()) told.push_back(std::move(more));
    return told;
  }

 private:
  HybridSettings settings_;
  ImportanceCacheConnections cache_;
  SkeletonConnections skeleton_;
};

}  // namespace lacuna
