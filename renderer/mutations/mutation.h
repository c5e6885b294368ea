#pragma once

#include <concepts>

#include "renderer/core/rng.h"
#include "renderer/mutations/chain_state.h"
#include "renderer/path/contexts.h"
#include "renderer/path/counters.h"
#include "renderer/settings/path_lengths.h"

namespace lacuna {

/// How a proposal is made from a chain's state.
enum class Step {
  large,  ///< independent of the state: any path may follow any other
  small   ///< near the state
};

/// The paths that chains may contain.
struct ChainPaths {
  PathLengths lengths;
  int least_edges = 1;
};

/// The mutations of Markov chains: what the states are, how a proposal is made and evaluated. An
/// object holds the states of up to `size` chains, which one thread advances together.
///
/// - M(settings, paths).
/// - M::Workspace(context, lengths): what evaluation needs beside the states. A thread has one for
///   all chains that it advances, one batch after the other; `context` outlives it.
/// - propose(i, step, rng): chooses a proposal for chain i. A proposal of Step::large depends on
///   `rng` alone: with equal ones two chains have equal proposals. `rng` is read until evaluate()
///   has returned.
/// - evaluate(n, workspace, counters): evaluates the proposals of chains [0, n).
/// - current(i), proposed(i): what state and proposal contribute to the picture, with
///   E of the pixels over Step::large times the number of pixels = the picture.
/// - reverse_ratio(i): probability density of proposing the state from the proposal over that of
///   the proposal from the state, in the measure in which ChainState::scalar is a density; 1 where
///   proposals are symmetric.
/// - accept(i): the proposal becomes the state.
template <class M>
concept Mutation = requires(M m, const M& k, std::size_t i, Step step, Rng& rng,
                            typename M::Workspace& workspace, Counters& counters) {
  { M::size } -> std::convertible_to<std::size_t>;
  m.propose(i, step, rng);
  m.evaluate(i, workspace, counters);
  { k.current(i) } -> std::same_as<const ChainState&>;
  { k.proposed(i) } -> std::same_as<const ChainState&>;
  { k.reverse_ratio(i) } -> std::same_as<double>;
  m.accept(i);
};

}  // namespace lacuna
