#pragma once

#include "renderer/path/guiding_distribution.h"
#include "renderer/path/mis.h"
#include "tests/renderer/path/whole_path.h"

namespace lacuna::test {

/// What guides the paths from either end; null: they follow the BSDF.
struct DirectionsOf {
  const GuidingDistribution* eye = nullptr;
  const GuidingDistribution* light = nullptr;
};

/// The definition of the weights, with nothing of the recursion in it: the density of every vertex
/// from either end, the strategies' densities as plain products, each times its number of samples.
class Oracle {
 public:
  Oracle(const Scene& scene, const Camera& camera, const WholePath& path,
         const DirectionsOf& directions = {});

  /// Of all techniques under the balance heuristic: [s] of strategy s = 0 ... k, then [k + j] of
  /// merging at x_j, 0 < j < k. All 0: no technique makes this path.
  /// `next_event_ratio`: the density of x_0 in next event estimation over that on light paths.
  std::vector<double> weights(const SampleCounts& n, double next_event_ratio = 1) const;

 private:
  double pdf_Le(const V3f& w) const;
  double light_step(int i) const;
  double eye_step(int i) const;
  double product(int from_light, int from_eye) const;

  const Scene& scene_;
  const Camera& camera_;
  const WholePath& path_;
  DirectionsOf directions_;
  /// [i] per area at x_i, of a walk that comes from there; in logarithms, -inf: never.
  std::vector<double> from_light_, from_eye_;
};

}  // namespace lacuna::test
