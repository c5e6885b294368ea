#pragma once

#include <array>
#include <memory>

#include "renderer/mutations/chain_state.h"
#include "renderer/mutations/length_choice.h"
#include "renderer/mutations/part_replacement.h"
#include "renderer/mutations/path_perturbation.h"
#include "renderer/path/contexts.h"

namespace lacuna {

/// mutation: path_space. A state is a path, and proposals change some of its vertices (Veach and
/// Guibas 1997; Veach 1997, ch. 11). The chain's target density is the path's contribution per
/// product area.
class PathSpaceMutation {
 public:
  static constexpr std::size_t size = 16;
  static constexpr std::array kinds{"independent", "bidirectional", "lens", "eye", "light"};

  struct Workspace {
    Workspace(const IterationContext& c, const PathLengths&)
        : context(c), measure(c.scene, c.camera) {}
    const IterationContext& context;
    PathMeasure measure;
    PathBuilder::Parts parts;
    SparseStop stop;
  };

  PathSpaceMutation(const PathSpaceSettings& settings, const ChainPaths& paths);

  void start(std::size_t i, Rng& rng);
  void propose(std::size_t i, Rng& rng);
  void evaluate(std::size_t n, Workspace& workspace, Counters& counters);
  const ChainState& current(std::size_t i) const { return chains_[i].current.state; }
  const ChainState& proposed(std::size_t i) const { return chains_[i].proposed.state; }
  double acceptance_ratio(std::size_t i) const { return chains_[i].ratio; }
  std::size_t kind(std::size_t i) const { return static_cast<std::size_t>(chains_[i].kind); }
  void accept(std::size_t i);

 private:
  enum class Kind : std::uint8_t { independent, bidirectional, lens, eye, light };
  struct Path : WholePath {
    ChainState state;
    double pixel_weight =
        0;  ///< sum of the filter weights of its pixels: 1 except at the film's border
    /// The target density of the chain, up to a factor.
    long double target() const { return luminance * pixel_weight; }
  };
  struct Chain {
    VertexPool pool;
    Path current, proposed;
    double ratio = 0;
    Kind kind = Kind::independent;
    bool starting = false;
    bool pending = false;  ///< `proposed` has new vertices
    Rng* rng = nullptr;
  };

  void evaluate(Chain& c, Workspace& workspace, Counters& counters) const;
  /// Builds the proposal of `c`; false if there is none, or none that can be accepted.
  bool propose(Chain& c, PathBuilder& builder) const;
  bool build(const Chain& c, PathBuilder& builder, PartReplacement& replacement,
             PathPerturbation& perturbation) const;
  bool sample_anew(const Chain& c, PathBuilder& builder) const;
  /// Density with which sample_anew() samples a path.
  long double independent_density(const PathMeasure& measure, const VertexPool& pool,
                                  const WholePath& path) const;
  static void drop_proposal(Chain& c);
  /// Returns the vertices of `path` that are not in `kept` to the pool.
  static void give_back(VertexPool& pool, const WholePath& path, const WholePath& kept);
  /// Sets ChainState::parts of a path with its contribution.
  static void set_parts(Path& path, const VertexPool& pool, const PathAutomaton* automaton);
  static void set_contribution(Path& path, const Camera& camera, double scale);

  PathSpaceSettings settings_;
  ChainPaths paths_;
  LengthChoice lengths_;
  std::array<Chain, size> chains_;
};

static_assert(Mutation<PathSpaceMutation>);

}  // namespace lacuna
