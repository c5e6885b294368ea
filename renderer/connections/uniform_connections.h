#pragma once

#include "renderer/connections/site.h"
#include "renderer/integrators/integrator.h"

namespace lacuna {

/// connections: uniform. The control of all resampling: no guidance at all.
class UniformConnections {
 public:
  explicit UniformConnections(const UniformSettings& settings) : settings_(settings) {}

  const ResamplingSettings& resampling() const { return settings_; }
  static constexpr std::array<std::string_view, 1> distributions{"uniform"};
  static constexpr bool needs_space = false;

  /// What the threads of an iteration count apart and end() adds up.
  struct Tally {};
  Tally tally() const { return {}; }
  void prepare(const PrepareContext&) {}
  void begin(const IterationContext&, const LightVertices&, Counters&) {}
  void end(std::span<const Tally>) {}

  /// Calls `use(s, pick)` for a light path of each length in [1, longest], to be joined to `v`.
  template <class Use>
  void pick(const Vertex&, int /*depth*/, const LightVertices& lights, int longest, Rng& rng,
            Tally&, Use&& use) const {
    pick_uniformly(lights, longest, rng, 0, use);
  }

  void save(ByteWriter&) const {}
  void load(ByteReader&) {}
  std::vector<std::pair<std::string, double>> statistics() const { return {}; }

 private:
  UniformSettings settings_;
};

}  // namespace lacuna
