#pragma once

#include <algorithm>
#include <limits>
#include <utility>

#include "renderer/guides/guiding_distribution.h"
#include "renderer/path/eye_batch.h"

namespace lacuna {

/// The contributions that each vertex of a batch's paths made to its pixel. When the paths are
/// finished, the light that arrived at a vertex is the sum over the vertices behind it.
class GatheredLight {
 public:
  explicit GatheredLight(const EyeBatch& batch) : batch_(batch) {}

  /// Call when the batch's paths have started or resumed.
  void clear() {
    light_.assign(batch_.stride * EyeBatch::size, Rgb(0, 0, 0));
    split_.assign(batch_.stride * EyeBatch::size, 1.0F);
    carried_.assign(batch_.stride * EyeBatch::size, 0.0F);
    ratio_.assign(batch_.stride * EyeBatch::size, 1.0F);
    shadow_rays_.assign(batch_.stride * EyeBatch::size, std::uint8_t{0});
    for (std::size_t i = 0; i < batch_.states.size(); ++i) {
      first_[i] = last_[i] = batch_.states[i].depth;
    }
  }
  /// Path `i` has reached its vertex `depth`.
  void reach(std::size_t i, int depth) {
    last_[i] = depth;
    carried_[index(i, depth - 1)] = batch_.states[i].carried;
    split_[index(i, depth)] = batch_.states[i].split;
    // A product over very long paths may leave the range.
    ratio_[index(i, depth)] = std::min(batch_.states[i].roulette_scale / batch_.states[i].split,
                                       std::numeric_limits<float>::max());
  }
  /// Adds the contribution `value` to the pixel, by emission or a connection at vertex `depth`.
  void add(std::size_t i, int depth, const Rgb& value) {
    if (is_finite(value)) light_[index(i, depth)] += value;
  }
  /// A shadow ray is traced for vertex `depth` of path `i`.
  void cast(std::size_t i, int depth) { ++shadow_rays_[index(i, depth)]; }

  int last(std::size_t i) const { return last_[i]; }
  const Rgb& light(std::size_t i, int depth) const { return light_[index(i, depth)]; }
  int shadow_rays(std::size_t i, int depth) const { return shadow_rays_[index(i, depth)]; }
  /// PathState::carried of that vertex.
  float carried(std::size_t i, int depth) const {
    return depth < last_[i] ? carried_[index(i, depth)] : batch_.states[i].carried;
  }
  static bool connectible(const Vertex& v) {
    return v.kind == Vertex::Kind::surface && v.bsdf && v.bsdf->connectible();
  }

  /// Passes to `guide` a GuidingSample for every edge that was not sampled from a delta lobe, and
  /// the light behind every connectible vertex. A path that was split represents all of its parts:
  /// its later contributions are multiplied by their number.
  template <class Guide>
  void record(const Guide& guide, typename Guide::Accumulator& accumulator) const {
    record_noise(guide, accumulator);
    for (std::size_t i = 0; i < batch_.states.size(); ++i) {
      Rgb behind(0, 0, 0);
      for (int depth = last_[i]; depth >= std::max(1, first_[i]); --depth) {
        if (depth < last_[i]) record_edge(guide, i, depth, behind, accumulator);
        record_vertex(guide, i, depth, behind, accumulator);
        behind += light_[index(i, depth)] * split_[index(i, depth)];
      }
    }
  }

 private:
  std::size_t index(std::size_t i, int depth) const {
    return i * batch_.stride + static_cast<std::size_t>(depth);
  }

  /// Of the edge from vertex `depth` of path `i` to the next.
  template <class Guide>
  void record_edge(const Guide& guide, std::size_t i, int depth, const Rgb& behind,
                   typename Guide::Accumulator& accumulator) const {
    const Vertex& v = batch_.vertex(i, depth);
    const Vertex& next = batch_.vertex(i, depth + 1);
    if (v.delta) return;
    const V3f wi = -next.wp;
    const Rgb carried = next.throughput * split_[index(i, depth + 1)];
    const Rgb arrived(over(behind.x, carried.x), over(behind.y, carried.y),
                      over(behind.z, carried.z));
    const Pdf<SolidAngle> p(next.p_fwd / to_area(Pdf<SolidAngle>(1.0F), v, wi, next));
    const float distance =
        next.kind == Vertex::Kind::background ? HUGE_VALF : (next.surface.x - v.surface.x).length();
    guide.accumulate(
        {v, wi, p, distance, luminance(arrived), contribution(guide, i, depth + 1, behind)},
        accumulator);
  }

  /// Half of the squared difference of two neighbouring pixels that show one material: the
  /// variance of their samples, and what the picture changes from one to the other. Branches of
  /// split paths are no pixels.
  template <class Guide>
  void record_noise(const Guide& guide, typename Guide::Accumulator& accumulator) const {
    if constexpr (Guide::has_expected) {
      PixelMoments before, own = pixel_moments(0);
      for (std::size_t i = 1; i < batch_.states.size(); ++i) {
        before = std::exchange(own, pixel_moments(i));
        if (first_[i] > 0 || first_[i - 1] > 0) continue;
        const Vertex &a = batch_.vertex(i - 1, 1), &b = batch_.vertex(i, 1);
        const bool alike = a.kind == Vertex::Kind::surface && b.kind == Vertex::Kind::surface &&
                           a.surface.material == b.surface.material;
        if (!alike) continue;
        const double difference = own.gathered - before.gathered;
        const double noise = difference * difference / 2;
        guide.record_noise(noise, noise + (own.excess_by_bsdf + before.excess_by_bsdf) / 2,
                           accumulator);
      }
    }
  }
  /// Of one sample of a pixel, in luminance.
  struct PixelMoments {
    double gathered = 0;
    /// By how much the second moment would grow if the path followed the BSDF.
    double excess_by_bsdf = 0;
  };
  /// Of path `i`. If it followed the BSDF, its contributions would be ratio_ times as large, and as
  /// many times rarer. Weights against next event estimation are taken as they are.
  PixelMoments pixel_moments(std::size_t i) const {
    double before = 0, before_by_bsdf = 0, excess = 0;
    for (int depth = 1; depth <= last_[i]; ++depth) {
      const std::size_t k = index(i, depth);
      const double c = double(luminance(light_[k] * split_[k])), by_bsdf = c * double(ratio_[k]);
      excess += c * (by_bsdf + 2 * before_by_bsdf) - c * (c + 2 * before);
      before += c;
      before_by_bsdf += by_bsdf;
    }
    return {before, excess};
  }

  template <class Guide>
  void record_vertex(const Guide& guide, std::size_t i, int depth, const Rgb& behind,
                     typename Guide::Accumulator& accumulator) const {
    if constexpr (Guide::has_expected) {
      const Vertex& v = batch_.vertex(i, depth);
      if (!connectible(v)) return;
      const float carried = luminance(v.throughput) * split_[index(i, depth)];
      guide.record(v, double(luminance(behind)) / double(carried), accumulator);
    }
  }

  /// Luminance of the contributions of vertex `depth` and those `behind` it. The latter are
  /// replaced by their expectation where it is known: a guide that minimises the variance of its
  /// own directions must not learn the noise of the vertices behind.
  template <class Guide>
  float contribution(const Guide& guide, std::size_t i, int depth, const Rgb& behind) const {
    if constexpr (Guide::has_expected) {
      const Vertex& v = batch_.vertex(i, depth);
      if (connectible(v)) {
        const float expected = guide.expected(v);
        if (expected < 0) return 0;
        return split_[index(i, depth)] *
               (luminance(light_[index(i, depth)]) + luminance(v.throughput) * expected);
      }
    }
    return luminance(behind);
  }

  /// 0 for a channel whose throughput is 0.
  static float over(float value, float throughput) {
    return throughput > 0 ? value / throughput : 0.0F;
  }

  const EyeBatch& batch_;
  std::vector<Rgb> light_;
  std::vector<float> split_;    // PathState::split at each vertex
  std::vector<float> carried_;  // and PathState::carried
  /// Density of the path up to each vertex over that by the BSDF.
  std::vector<float> ratio_;
  std::vector<std::uint8_t> shadow_rays_;
  std::array<int, EyeBatch::size> first_{}, last_{};  // depths of the vertices recorded
};

}  // namespace lacuna
