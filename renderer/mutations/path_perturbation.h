#pragma once

#include "renderer/mutations/path_builder.h"
#include "renderer/settings/mutation_settings.h"

namespace lacuna {

/// Perturbations (Veach 1997, sec. 11.4.3 to 11.4.5): a direction of a path is turned by a small
/// angle, the path is traced through as many delta lobes as before to the next vertex that scatters
/// otherwise, and joined to the vertex behind that. Where that one has a delta lobe, one more
/// direction is turned. Directions are turned away from the eye (from x_0, where the film position
/// moves: lens and multi-chain perturbation) or towards it (caustic perturbation). At infinity no
/// direction is turned towards the eye: the ray from there moves aside instead, by such an angle
/// times its way from x_{k-1} to the next vertex that scatters otherwise.
class PathPerturbation {
 public:
  explicit PathPerturbation(const PathSpaceSettings& settings) : settings_(settings) {}

  /// Builds a proposal from `path`; false where it found none. Turns directions from x_start on,
  /// 0 <= start < k, away from the eye.
  bool propose_from_eye(const WholePath& path, int start, PathBuilder& builder, Rng& rng);
  /// The same from x_start on, 0 < start <= k, towards the eye.
  bool propose_from_light(const WholePath& path, int start, PathBuilder& builder, Rng& rng);
  /// Density of proposing `from` from `to` over that of `to` from `from`, the last proposal.
  long double reverse_ratio(const PathMeasure& measure, const VertexPool& pool,
                            const WholePath& from, const WholePath& to) const;

 private:
  /// Unit, near unit `w`; its density depends on the angle alone.
  V3f turned(const V3f& w, Rng& rng) const;
  V2f moved(const V2f& at, const PathBuilder& builder, Rng& rng) const;
  /// The largest distance that the ray from infinity of `path` may move, in scene units.
  double reach(const VertexPool& pool, const WholePath& path) const;
  /// Appends x_{k-1} of a path whose x_k is at infinity.
  bool move_aside(const WholePath& path, PathBuilder& builder, Rng& rng);

  PathSpaceSettings settings_;
  int first_ = 0, last_ = 0;  // x_first ... x_last have moved
  bool from_eye_ = true;
  /// How far the ray from infinity has moved, in scene units; 0: it has not.
  double aside_ = 0;
};

}  // namespace lacuna
