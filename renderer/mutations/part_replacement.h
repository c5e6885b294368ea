#pragma once

#include "renderer/mutations/mutation.h"
#include "renderer/mutations/path_builder.h"

namespace lacuna {

/// Veach's bidirectional mutation (Veach 1997, sec. 11.4.2): deletes the vertices between x_first
/// and x_last and samples others in their place, some from the eye's side and some from the
/// light's. The part may extend to the emitter, which is then sampled again, and to the first
/// vertex after the eye.
class PartReplacement {
 public:
  explicit PartReplacement(const ChainPaths& paths) : paths_(paths) {}

  /// Builds a proposal from `path`; false if it fails.
  bool propose(const WholePath& path, PathBuilder& builder, Rng& rng);
  /// Density of proposing `from` from `to`, the last proposal, over that of proposing `to` from
  /// `from`.
  long double reverse_ratio(const PathMeasure& measure, const VertexPool& pool,
                            const WholePath& from, const WholePath& to) const;

 private:
  /// Probability of deleting `deleted` vertices at a given position of a path of `edges` and of
  /// sampling `added` instead; 0 if not allowed. `to_end`: the emitter is deleted, too.
  double probability(int edges, int deleted, int added, bool to_end) const;
  /// Unnormalised weight of `added`, given `edges` and `deleted`.
  double weight(int edges, int deleted, int added, bool to_end) const;
  /// The sum of the weights over all values of `added`.
  double weight_sum(int edges, int deleted, bool to_end) const;

  ChainPaths paths_;
  int first_ = 0, deleted_ = 0, added_ = 0;
  bool to_end_ = false;
};

}  // namespace lacuna
