#pragma once

#include <array>
#include <string_view>

#include "renderer/connections/cell_statistics.h"
#include "renderer/connections/resampling_cell.h"
#include "renderer/path/strategy.h"
#include "renderer/settings/connections_settings.h"

namespace lacuna {

/// connections: paired. Each eye path is connected to its own light path (integrators/bdpt.cpp):
/// the only strategy without resampling.
struct PairedConnections : StrategyBase {
  explicit PairedConnections(const PairedSettings&) {}
};

/// Samples light vertices, shared by all pixels, for an eye vertex.
///
/// - resampling(): the settings common to all such strategies.
/// - distributions: the names of the distributions, for the layers `distributions.NAME`.
/// - cells(): number of cells of CellStatistics; valid after prepare().
/// - begin(): called when the light vertices of an iteration are complete. Only begin() may change
///   the distributions of the iteration.
/// - find(): looks up the distributions for an eye vertex, `depth` edges from the eye: a struct
///   with a member `cell` < cells().
/// - sample(): samples light vertices of the LightRange, either one of each existing length s or
///   some of all lengths, each with probability `survival(s)`, and calls `use(s, sample)`.
///   VertexSample::probability is the exact expected number of samples of this vertex, without the
///   factor `survival(s)`, > 0; otherwise the method is biased. It must be positive for every
///   vertex that can contribute.
///
/// find() and sample() are const and are called by many threads; they use only the given generator,
/// so the result is bit-identical for any number of threads.
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
