#pragma once

#include <cmath>
#include <vector>

#include "renderer/core/rng.h"
#include "renderer/core/vec.h"
#include "renderer/geometry/rays.h"

namespace lacuna {

/// One shadow ray for all connections of an eye path (Lafortune and Willems 1995; Noel 2015,
/// 4.3.2.2). Of contributions c_k with luminance w_k, k is sampled with probability w_k / sum w;
/// c_k sum w / w_k, if it is unoccluded, estimates the sum of all, without bias in each channel.
/// One contribution at a time is stored for each path (reservoir sampling).
///
/// Contribution: has `path`, `value` and the MIS `weight`.
template <class Contribution>
class OneRay {
 public:
  /// For `paths` paths. Call it before each batch.
  void start(const Rng& rng, std::size_t paths) {
    rng_ = rng;
    kept_.assign(paths, {});
  }

  /// A contribution that counts if `ray` is unoccluded. One that is not finite is queued at once,
  /// to be rejected.
  template <class Queue>
  void add(const Ray& ray, const Contribution& c, Queue& queue) {
    const auto w = static_cast<double>(luminance(c.value * c.weight));
    if (!std::isfinite(w)) return queue.add(ray, c);
    if (!(w > 0)) return;
    Kept& kept = kept_[c.path];
    kept.sum += w;
    if (rng_.next_choice() * kept.sum < w) kept.ray = ray, kept.contribution = c, kept.own = w;
  }

  /// Queues the sampled contributions.
  template <class Queue>
  void finish(Queue& queue) {
    for (Kept& kept : kept_) {
      if (kept.sum > 0) {
        kept.contribution.value *= static_cast<float>(kept.sum / kept.own);
        queue.add(kept.ray, kept.contribution);
      }
      kept = {};
    }
  }

 private:
  struct Kept {
    double sum = 0, own = 0;  // of the luminances; of the stored contribution
    Ray ray{V3f(0.0F), V3f(0.0F)};
    Contribution contribution = {};
  };
  Rng rng_{0, 0, 0};
  std::vector<Kept> kept_;
};

}  // namespace lacuna
