#pragma once

#include <array>
#include <string_view>

#include "renderer/connections/cell_statistics.h"
#include "renderer/connections/resampling_cell.h"
#include "renderer/path/strategy.h"
#include "renderer/settings/connections_settings.h"

namespace lacuna {

/// connections: paired. Each eye path meets a light path of its own (integrators/bdpt.cpp): the one
/// choice that resamples nothing.
struct PairedConnections : StrategyBase {
  explicit PairedConnections(const PairedSettings&) {}
};

/// How light vertices that all pixels share are drawn for an eye vertex.
///
/// - resampling(): the settings that all such choices have in common.
/// - distributions: their names, for the layers `distributions.NAME`.
/// - cells(): how many parts the eye vertices fall into, for CellStatistics; known after prepare().
/// - begin(): called once the light vertices of an iteration are there. It may change what the
///   iteration draws from, and nothing else may.
/// - find(): where the connections of an eye vertex, `depth` edges from the eye, are drawn: a
/// struct
///   with a member `cell` < cells().
/// - pick(): draws a light vertex for each s in [1, longest] that has any, each with probability
///   `survival(s)`, and calls `use(s, pick)`. VertexSample::probability is the probability of this
///   vertex among those of its s: the exact one, > 0, or the method is biased. Every vertex that
///   can contribute has a probability above 0.
///
/// find() and pick() are const and are called by many threads; they draw from the given generator
/// only, so that the bits do not depend on the threads.
template <class C>
concept SharedConnections = Strategy<C> &&
    requires(C c, const C& k, const IterationContext& context, Counters& counters,
             const LightVertices& lights, const CellStatistics& seen, const Vertex& v, Rng& rng) {
  { k.resampling() } -> std::convertible_to<const ResamplingSettings&>;
  { C::distributions.size() } -> std::convertible_to<std::size_t>;
  { k.cells() } -> std::convertible_to<std::size_t>;
  c.begin(context, lights, seen, counters);
  { k.find(v, 1, rng).cell } -> std::convertible_to<std::uint32_t>;
  k.pick(
      k.find(v, 1, rng), lights, 1, rng, [](int) { return 1.0F; }, [](int, const VertexSample&) {});
};

template <class C>
concept Connections = std::same_as<C, PairedConnections> || SharedConnections<C>;

}  // namespace lacuna
