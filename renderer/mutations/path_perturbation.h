#pragma once

#include "renderer/mutations/path_builder.h"
#include "renderer/settings/mutation_settings.h"

namespace lacuna {

/// Perturbations (Veach 1997, sec. 11.4.3 to 11.4.5): rotates a direction of a path by a small
/// angle, traces the path through the same number of delta lobes to the next non-delta vertex, and
/// connects it to the following vertex. If that one has a delta lobe, rotates one more direction.
/// Directions point away from the eye (from x_0, the film position moves instead: lens and
/// multi-chain perturbation) or towards it (caustic perturbation). At infinity the direction
/// towards the eye stays, and the ray is shifted sideways instead, by such an angle times its
/// distance from x_{k-1} to the next non-delta vertex.
class PathPerturbation {
 public:
  explicit PathPerturbation(const PathSpaceSettings& settings) : settings_(settings) {}

  /// Builds a proposal from `path`; false if it fails. Rotates directions from x_start, 0 <= start
  /// < k, away from the eye.
  bool propose_from_eye(const WholePath& path, int start, PathBuilder& builder, Rng& rng);
  /// The same from x_start, 0 < start <= k, towards the eye.
  bool propose_from_light(const WholePath& path, int start, PathBuilder& builder, Rng& rng);
  /// Density of proposing `from` from `to`, the last proposal, over that of proposing `to` from
  /// `from`.
  long double reverse_ratio(const PathMeasure& measure, const VertexPool& pool,
                            const WholePath& from, const WholePath& to) const;

 private:
  /// A unit direction near unit `w`; its density depends on the angle only.
  V3f rotated(const V3f& w, Rng& rng) const;
  V2f moved(const V2f& at, const PathBuilder& builder, Rng& rng) const;
  /// The largest sideways shift of the ray from infinity of `path`, scene units.
  double reach(const VertexPool& pool, const WholePath& path) const;
  /// Appends x_{k-1} of a path whose x_k is at infinity, on the shifted ray.
  bool shift_ray(const WholePath& path, PathBuilder& builder, Rng& rng);

  PathSpaceSettings settings_;
  int first_ = 0, last_ = 0;  // x_first ... x_last have moved
  bool from_eye_ = true;
  /// The sideways shift of the ray from infinity, scene units; 0: none.
  double shift_ = 0;
};

}  // namespace lacuna
