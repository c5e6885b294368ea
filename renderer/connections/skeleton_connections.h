#pragma once

#include <optional>

#include "analysis/skeleton/surface_lookup.h"
#include "renderer/connections/site.h"
#include "renderer/integrators/integrator.h"

namespace lacuna {

/// connections: skeleton. Light paths are resampled by distributions at the nodes of the filtered
/// skeleton, which see much of what the eye vertices around them see (Noel 2015, 11.2-11.4).
class SkeletonConnections {
 public:
  explicit SkeletonConnections(const SkeletonSettings& settings) : settings_(settings) {}

  const ResamplingSettings& resampling() const { return settings_; }
  static constexpr std::array<std::string_view, 3> distributions{"visible", "unshadowed",
                                                                 "uniform"};
  static constexpr bool needs_space = true;

  /// Eye vertices that belong to each node.
  using Tally = std::vector<std::uint32_t>;
  Tally tally() const { return Tally(positions_.size(), 0); }

  void prepare(const PrepareContext& context);
  /// Builds the distributions of the nodes that enough eye vertices of the iterations before
  /// belonged to; of the first iteration none.
  void begin(const IterationContext& context, const LightVertices& lights, Counters& counters);
  void end(std::span<const Tally> tallies);

  /// Calls `use(s, pick)` for a light path of each length in [1, longest], to be joined to `v`.
  template <class Use>
  void pick(const Vertex& v, int /*depth*/, const LightVertices& lights, int longest, Rng& rng,
            Tally& tally, Use&& use) const {
    const std::uint32_t node = lookup_->node(V3d(v.surface.x), V3d(v.surface.ng), V3d(v.wp));
    if (node != no_node) ++tally[node];
    if (node == no_node || sites_[node].empty()) {
      pick_uniformly(lights, longest, rng, uniform, use);
      return;
    }
    const Site& site = sites_[node];
    pick_all(
        lights, longest, [&](int s) { return site.table(s).choose(rng); },
        [&](int s, std::uint32_t chosen) {
          const AliasTable::Draw d = site.table(s).resolve(chosen, rng);
          return Pick{d.index, d.pmf.value, site.table(s).owner(d.index)};
        },
        use);
  }

  /// How many eye vertices belonged to each node, in all iterations so far.
  void save(ByteWriter& out) const;
  /// Throws std::runtime_error if they are not of this skeleton.
  void load(ByteReader& in);
  std::vector<std::pair<std::string, double>> statistics() const;

 private:
  static constexpr std::uint8_t uniform = 2;  // in `distributions`

  bool accepted(std::size_t node) const;
  std::uint64_t build(std::size_t node, const Scene& scene, const LightVertices& lights);

  SkeletonSettings settings_;
  std::vector<V3f> positions_;  // of the nodes, scene units
  double least_distance_ = 0;
  std::optional<SurfaceLookup> lookup_;
  std::vector<Site> sites_;
  std::vector<std::uint64_t> mapped_;
  std::uint64_t mapped_sum_ = 0;
  std::size_t used_ = 0;
};

}  // namespace lacuna
