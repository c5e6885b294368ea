#pragma once

#include <vector>

#include "renderer/path/counters.h"
#include "renderer/scene/scene.h"

namespace lacuna {

/// Contributions of one tile that wait for their visibility. Shadow rays are traced many at a time,
/// which Embree does half as fast again as one by one, and in the order they were added, so sums
/// have the same bits for any number of threads.
class ShadowQueue {
 public:
  /// `value` counts for `pixel` if `ray` (Scene::shadow_ray) meets nothing.
  void add(const Ray& ray, const Rgb& value, std::uint32_t pixel) {
    rays_.push_back(ray);
    pending_.push_back({value, pixel});
  }

  /// Traces all rays and calls `lit(pixel, value)` for each contribution that arrives; the queue is
  /// then empty.
  template <class Lit>
  void flush(const RayCaster& caster, Counters& counters, Lit&& lit) {
    counters.shadow_rays += rays_.size();
    occluded_.resize(rays_.size());
    caster.occluded(rays_, occluded_);
    for (std::size_t i = 0; i < rays_.size(); ++i) {
      if (occluded_[i] == 0) lit(pending_[i].pixel, pending_[i].value);
    }
    rays_.clear();
    pending_.clear();
  }

 private:
  struct Pending {
    Rgb value;
    std::uint32_t pixel;
  };
  std::vector<Ray> rays_;
  std::vector<Pending> pending_;
  std::vector<std::uint8_t> occluded_;
};

}  // namespace lacuna
