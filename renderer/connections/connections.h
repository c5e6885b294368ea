#pragma once

#include <array>
#include <string_view>

#include "renderer/connections/cell_statistics.h"
#include "renderer/connections/resampling_cell.h"
#include "renderer/path/strategy.h"
#include "renderer/settings/connections_settings.h"

namespace lacuna {

/// connections: paired. Each eye path is joined to a light path of its own (integrators/bdpt.cpp):
/// the one choice without resampling.
struct PairedConnections : StrategyBase {
  explicit PairedConnections(const PairedSettings&) {}
};

/// Samples light vertices, shared by all pixels, for an eye vertex.
///
/// - resampling(): the settings that all such strategies have in common.
/// - distributions: the names of the distributions, for the layers `distributions.NAME`.
/// - cells(): number of cells that CellStatistics distinguishes; known after prepare().
/// - begin(): called when the light vertices of an iteration are complete. Only begin() may change
///   the distributions of the iteration.
/// - find(): looks up the distributions for an eye vertex, `depth` edges from the eye: a struct
///   with a member `cell` < cells().
/// - sample(): samples light vertices of the LightRange, one of each s that has any or some of all
///   lengths, each with probability `survival(s)`, and calls `use(s, drawn)`.
///   VertexSample::probability is the exact number of times, > 0, that this vertex is expected to
///   be sampled, `survival(s)` apart; otherwise the method is biased. It is above 0 for every
///   vertex that can contribute.
///
/// find() and sample() are const and are called by many threads; they use the given generator only,
/// so that the bits do not depend on the threads.
template <class C>
concept SharedConnections = Strategy<C> &&
    requires(C c, const C& k, const IterationContext& context, Counters& counters,
             const LightVertices& lights, const CellStatistics& statistics, const Vertex& v,
             Rng& rng) {
  { k.resampling() } -> std::convertible_to<const ResamplingSettings&>;
  { C::distributions.size() } -> std::convertible_to<std::size_t>;
  { k.cells() } -> std::convertible_to<std::size_t>;
  c.begin(context, lights, statistics, counters);
  { k.find(v, 1, rng).cell } -> std::convertible_to<std::uint32_t>;
  k.sample(
      k.find(v, 1, rng), LightRange{lights, 1}, rng, [](int) { return 1.0F; },
      [](int, const VertexSample&) {});
};

template <class C>
concept Connections = std::same_as<C, PairedConnections> || SharedConnections<C>;

}  // namespace lacuna
