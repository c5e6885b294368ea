#pragma once

#include <array>
#include <cmath>

#include "renderer/mutations/length_choice.h"
#include "renderer/mutations/mutation.h"
#include "renderer/mutations/path_evaluator.h"
#include "renderer/settings/mutation_settings.h"

namespace lacuna {

/// Chains in primary sample space: a state is the random numbers from which a pair of paths is
/// sampled, so sampling, connecting and weighting are those of bidirectional path tracing.
/// `Technique` maps a point's control numbers to strategies.
template <class Technique>
class PrimarySampleChains {
 public:
  static constexpr std::size_t size = PathEvaluator::size;
  static constexpr std::array kinds{"large_step", "small_step"};

  using Workspace = PathEvaluator;

  PrimarySampleChains(const PrimaryStepSettings& settings, const ChainPaths& paths)
      : settings_(settings), paths_(paths) {}

  void start(std::size_t i, Rng& rng) {
    Chain& c = chains_[i];
    c.kind = 0;
    for (PrimarySamples* p : {&c.control, &c.eye, &c.light}) p->propose_fresh(rng);
  }

  void propose(std::size_t i, Rng& rng) {
    if (rng.decide(static_cast<float>(settings_.large_steps))) return start(i, rng);
    Chain& c = chains_[i];
    c.kind = 1;
    // All numbers move at one scale: the largest move determines acceptance, and smaller ones
    // besides it would explore less. If one of the two paths is kept, the other reaches the same
    // light, or the same surface is lit in another way.
    const int octave = static_cast<int>(rng.below(static_cast<std::uint64_t>(settings_.octaves)));
    const double distance = std::ldexp(settings_.step, -octave);
    enum { both, eye, light };
    const auto moved = rng.below(3);
    c.control.propose_near(rng, moved == both ? settings_.step : 0);
    c.eye.propose_near(rng, moved != light ? distance : 0);
    c.light.propose_near(rng, moved != eye ? distance : 0);
  }

  void evaluate(std::size_t n, PathEvaluator& evaluator, Counters& counters) {
    std::array<PathEvaluator::Point, size> points;
    for (std::size_t i = 0; i < n; ++i) {
      Chain& c = chains_[i];
      Rng control(c.control);
      points[i] = {&c.eye, &c.light, Technique::choose(paths_, control), &c.proposed};
    }
    evaluator.evaluate(std::span(points).first(n), counters);
  }

  const ChainState& current(std::size_t i) const { return chains_[i].current; }
  const ChainState& proposed(std::size_t i) const { return chains_[i].proposed; }
  /// Proposals are symmetric, so only target densities remain.
  double acceptance_ratio(std::size_t i) const {
    const Chain& c = chains_[i];
    return c.proposed.scalar / c.current.scalar;
  }
  std::size_t kind(std::size_t i) const { return chains_[i].kind; }

  void accept(std::size_t i) {
    Chain& c = chains_[i];
    c.control.accept();
    c.eye.accept();
    c.light.accept();
    std::swap(c.current, c.proposed);
  }

 private:
  struct Chain {
    PrimarySamples control, eye, light;
    ChainState current, proposed;
    std::size_t kind = 0;
  };
  PrimaryStepSettings settings_;
  ChainPaths paths_;
  std::array<Chain, size> chains_;
};

/// mutation: primary_sample. A point represents all connections of its two paths (Kelemen et al.
/// 2002; Noel 2015, 4.6).
struct AllTechniques {
  static WantedPaths choose(const ChainPaths& paths, Rng&) {
    const int most = paths.lengths.max_depth;
    return {0, most, 1, most + 1, paths.least_edges, most, 1};
  }
};

/// mutation: multiplexed. A point represents one path, of one length by one strategy, both selected
/// by further numbers of the point (Hachisuka, Kaplanyan and Dachsbacher 2014, "Multiplexed
/// Metropolis light transport").
struct OneTechnique {
  static WantedPaths choose(const ChainPaths& paths, Rng& control) {
    const LengthChoice lengths(paths);
    const int edges = lengths.sample(control.next_choice());
    const int s = static_cast<int>(control.below(static_cast<std::uint64_t>(edges) + 1));
    const int t = edges + 1 - s;
    return {s, s, t, t, edges, edges, static_cast<float>((edges + 1) / lengths.probability(edges))};
  }
};

using PrimarySampleMutation = PrimarySampleChains<AllTechniques>;
using MultiplexedMutation = PrimarySampleChains<OneTechnique>;
static_assert(Mutation<PrimarySampleMutation> && Mutation<MultiplexedMutation>);

}  // namespace lacuna
