#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "renderer/path/eye_batch.h"
#include "renderer/path/training_samples.h"

namespace lacuna {

/// The contributions of each vertex of a batch's paths to the path's pixel. When the paths have
/// ended, the light that arrived at a vertex is the sum of the contributions of all later vertices.
class GatheredLight {
 public:
  explicit GatheredLight(const EyeBatch& batch) : batch_(batch) {}

  /// Call when the batch's paths have started or resumed.
  void clear() {
    light_.assign(batch_.stride * EyeBatch::size, Rgb(0, 0, 0));
    split_.assign(batch_.stride * EyeBatch::size, 1.0F);
    for (std::size_t i = 0; i < batch_.states.size(); ++i) {
      first_[i] = last_[i] = batch_.states[i].depth;
    }
  }
  /// Call when path `i` has reached its vertex `depth`.
  void reach(std::size_t i, int depth) {
    last_[i] = depth;
    split_[index(i, depth)] = batch_.states[i].roulette.split;
  }
  /// Adds the contribution `value` to the pixel, by emission or a connection at vertex `depth`.
  void add(std::size_t i, int depth, const Rgb& value) {
    if (is_finite(value)) light_[index(i, depth)] += value;
  }

  /// Appends a training sample for each connectible vertex. A path that was split stands for all of
  /// its parts: its later contributions are multiplied by their number.
  void record(std::vector<TrainingSample>& samples) const {
    for (std::size_t i = 0; i < batch_.states.size(); ++i) {
      Rgb later(0, 0, 0);
      for (int depth = last_[i]; depth >= std::max(1, first_[i]); --depth) {
        record(i, depth, later, samples);
        later += light_[index(i, depth)] * split_[index(i, depth)];
      }
    }
  }

 private:
  std::size_t index(std::size_t i, int depth) const {
    return i * batch_.stride + static_cast<std::size_t>(depth);
  }

  /// Appends the sample of vertex `depth` of path `i`. `later`: contributions of later vertices.
  void record(std::size_t i, int depth, const Rgb& later,
              std::vector<TrainingSample>& samples) const {
    const Vertex& v = batch_.vertex(i, depth);
    if (v.kind != Vertex::Kind::surface || !v.bsdf || !v.bsdf->connectible()) return;
    const float carried = luminance(v.throughput) * split_[index(i, depth)];
    TrainingSample s{.cell = v.guiding_cell, .x = v.surface.x, .n = v.side()};
    s.reflected = luminance(later) / carried;
    if (depth < last_[i] && !v.delta) record_edge(v, batch_.vertex(i, depth + 1), s);
    if (s.pdf > 0) {
      const Rgb next = batch_.vertex(i, depth + 1).throughput * split_[index(i, depth + 1)];
      s.radiance =
          luminance(Rgb(over(later.x, next.x), over(later.y, next.y), over(later.z, next.z)));
    }
    if (std::isfinite(s.reflected) && std::isfinite(s.radiance)) samples.push_back(s);
  }

  static void record_edge(const Vertex& v, const Vertex& next, TrainingSample& s) {
    s.w = -next.wp;
    s.cosine = abs_dot(v.surface.ns, s.w);
    s.pdf = next.p_fwd / to_area(Pdf<SolidAngle>(1.0F), v, s.w, next);
    s.bsdf_pdf = v.bsdf->pdf(v.wp, s.w, Transport::radiance).value;
    s.distance =
        next.kind == Vertex::Kind::background ? HUGE_VALF : (next.surface.x - v.surface.x).length();
    if (!(s.pdf > 0) || !std::isfinite(s.pdf)) s.pdf = 0;
  }

  /// 0 for a channel whose throughput is 0.
  static float over(float value, float throughput) {
    return throughput > 0 ? value / throughput : 0.0F;
  }

  const EyeBatch& batch_;
  std::vector<Rgb> light_;
  std::vector<float> split_;                          // RouletteState::split at each vertex
  std::array<int, EyeBatch::size> first_{}, last_{};  // depths of the vertices recorded
};

}  // namespace lacuna
