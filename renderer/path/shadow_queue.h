#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "renderer/path/counters.h"
#include "renderer/scene/scene.h"

namespace lacuna {

/// Contributions pending their shadow rays. Embree traces many rays at a time 1.5 times as fast as
/// single ones. Contributions are returned in the order in which they were added, so sums have the
/// same bits for any number of threads.
template <class Contribution>
class ShadowQueue {
 public:
  /// `value` counts if `ray` is unoccluded.
  void add(const Ray& ray, const Contribution& value) {
    rays_.push_back(ray);
    pending_.push_back(value);
  }

  std::size_t size() const { return rays_.size(); }

  /// Traces all rays, calls `lit(value)` for each unoccluded contribution, and empties the queue.
  /// Calls `between()`, which may throw, between groups of 2^14 rays.
  template <class Lit, class Between = void (*)()>
  void flush(
      const RayCaster& caster, Counters& counters, Lit&& lit, Between&& between = [] {}) {
    constexpr std::size_t together = 1 << 14;
    counters.shadow_rays += rays_.size();
    occluded_.resize(rays_.size());
    for (std::size_t first = 0; first < rays_.size(); first += together) {
      if (first > 0) between();
      const std::size_t n = std::min(together, rays_.size() - first);
      caster.occluded(std::span(rays_).subspan(first, n), std::span(occluded_).subspan(first, n));
    }
    for (std::size_t i = 0; i < rays_.size(); ++i) {
      if (occluded_[i] == 0) lit(pending_[i]);
    }
    rays_.clear();
    pending_.clear();
  }

 private:
  std::vector<Ray> rays_;
  std::vector<Contribution> pending_;
  std::vector<std::uint8_t> occluded_;
};

}  // namespace lacuna
