#pragma once

#include <algorithm>

#include "renderer/guides/guiding_distribution.h"
#include "renderer/path/eye_batch.h"

namespace lacuna {

/// The contributions that each vertex of a batch's paths made to its pixel. When the paths are
/// finished, the light that arrived at a vertex is the sum over the vertices behind it.
class GatheredLight {
 public:
  explicit GatheredLight(const EyeBatch& batch) : batch_(batch) {}

  /// Call when the batch's paths have started.
  void clear() {
    light_.assign(batch_.stride * EyeBatch::size, Rgb(0, 0, 0));
    std::fill(length_.begin(), length_.end(), 0);
  }
  /// Path `i` has reached its vertex `depth`.
  void reach(std::size_t i, int depth) { length_[i] = depth; }
  /// Adds the contribution `value` to the pixel, by emission or a connection at vertex `depth`.
  void add(std::size_t i, int depth, const Rgb& value) {
    if (is_finite(value)) light_[i * batch_.stride + static_cast<std::size_t>(depth)] += value;
  }

  /// Passes a GuidingSample to `guide` for every edge that was not sampled from a delta lobe.
  template <class Guide>
  void record(const Guide& guide, typename Guide::Accumulator& accumulator) const {
    for (std::size_t i = 0; i < batch_.states.size(); ++i) {
      Rgb behind(0, 0, 0);
      for (int depth = length_[i]; depth > 1; --depth) {
        behind += light_[i * batch_.stride + static_cast<std::size_t>(depth)];
        const Vertex& v = batch_.vertex(i, depth - 1);
        const Vertex& next = batch_.vertex(i, depth);
        if (v.delta) continue;
        const V3f wi = -next.wp;
        const Rgb arrived(over(behind.x, next.throughput.x), over(behind.y, next.throughput.y),
                          over(behind.z, next.throughput.z));
        const Pdf<SolidAngle> p(next.p_fwd / to_area(Pdf<SolidAngle>(1.0F), v, wi, next));
        guide.accumulate({v, wi, p, luminance(arrived), luminance(behind)}, accumulator);
      }
    }
  }

 private:
  /// 0 for a channel whose throughput is 0.
  static float over(float value, float throughput) {
    return throughput > 0 ? value / throughput : 0.0F;
  }

  const EyeBatch& batch_;
  std::vector<Rgb> light_;
  std::array<int, EyeBatch::size> length_{};
};

}  // namespace lacuna
