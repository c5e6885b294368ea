#pragma once

#include <concepts>
#include <string_view>

#include "renderer/core/rng.h"
#include "renderer/mutations/chain_state.h"
#include "renderer/path/contexts.h"
#include "renderer/path/counters.h"
#include "renderer/settings/path_lengths.h"

namespace lacuna {

/// The paths that chains may contain.
struct ChainPaths {
  PathLengths lengths;
  int least_edges = 1;
};

/// The mutations of Markov chains: the states, and how a proposal is built and evaluated. An object
/// holds the states of up to `size` chains, which one thread advances together.
///
/// - M(settings, paths).
/// - M::Workspace(context, lengths): further data for evaluation. A thread has one for all chains
///   that it advances, batch after batch; `context` outlives it.
/// - start(i, rng): the proposal of chain i becomes an independent sample, which depends on `rng`
///   only.
/// - propose(i, rng): selects a proposal for chain i. Here and in start(), `rng` is read until
///   evaluate() returns.
/// - evaluate(n, workspace, counters): evaluates the proposals of chains [0, n).
/// - current(i), proposed(i): the contributions of state and proposal. For an independent sample,
///   the expectation of the pixels times the number of pixels is the picture; those of other states
///   have any scale.
/// - acceptance_ratio(i): the target density of the proposal times the density of proposing the
///   state from it, over the target density of the state times the density of proposing the
///   proposal from it (Veach 1997, eq. 11.5); not after start().
/// - kinds, kind(i): names for the report, and the index of the proposal's kind.
/// - accept(i): the proposal becomes the state.
template <class M>
concept Mutation = requires(M m, const M& k, std::size_t i, Rng& rng,
                            typename M::Workspace& workspace, Counters& counters) {
  { M::size } -> std::convertible_to<std::size_t>;
  { M::kinds[0] } -> std::convertible_to<std::string_view>;
  m.start(i, rng);
  m.propose(i, rng);
  m.evaluate(i, workspace, counters);
  { k.current(i) } -> std::same_as<const ChainState&>;
  { k.proposed(i) } -> std::same_as<const ChainState&>;
  { k.acceptance_ratio(i) } -> std::same_as<double>;
  { k.kind(i) } -> std::same_as<std::size_t>;
  m.accept(i);
};

}  // namespace lacuna
