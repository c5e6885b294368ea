#pragma once

#include <algorithm>

#include "renderer/guides/guiding_distribution.h"
#include "renderer/path/eye_batch.h"

namespace lacuna {

/// What the vertices of a batch's paths gave to their pixels, kept until each vertex can be told
/// what arrived from where its path went on: the sum of all behind it.
class GatheredLight {
 public:
  explicit GatheredLight(const EyeBatch& batch) : batch_(batch) {}

  /// To be called when the batch's paths have started.
  void clear() {
    light_.assign(batch_.places * EyeBatch::size, Rgb(0, 0, 0));
    std::fill(length_.begin(), length_.end(), 0);
  }
  /// Path `i` has come to its vertex `depth`.
  void reach(std::size_t i, int depth) { length_[i] = depth; }
  /// Its vertex `depth` emits, or is joined to, what gives `value` to the pixel.
  void add(std::size_t i, int depth, const Rgb& value) {
    if (is_finite(value)) light_[i * batch_.places + static_cast<std::size_t>(depth)] += value;
  }

  /// Tells `guide` of every edge that did not leave through a delta lobe.
  template <class Guide>
  void record(const Guide& guide, typename Guide::Accumulator& accumulator) const {
    for (std::size_t i = 0; i < batch_.walkers.size(); ++i) {
      Rgb behind(0, 0, 0);
      for (int depth = length_[i]; depth > 1; --depth) {
        behind += light_[i * batch_.places + static_cast<std::size_t>(depth)];
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
  /// A channel that the path no longer carries has brought nothing.
  static float over(float value, float throughput) {
    return throughput > 0 ? value / throughput : 0.0F;
  }

  const EyeBatch& batch_;
  std::vector<Rgb> light_;
  std::array<int, EyeBatch::size> length_{};
};

}  // namespace lacuna
