#pragma once

#include "renderer/path/connect.h"

namespace lacuna {

/// The two strategies of unidirectional path tracing, combined by MIS: the eye path hits an emitter
/// (s = 0), or a point on an emitter is sampled at one of its vertices (s = 1, next event
/// estimation).
template <class Guide>
class DirectLight {
 public:
  /// Without `next_event`, or without emitters, no points on emitters are sampled and hits have
  /// weight 1.
  DirectLight(const Scene& scene, const Guide& guide, bool next_event)
      : scene_(scene),
        guide_(guide),
        counts_{.hit = 1, .nee = next_event && !scene.emitters().empty() ? 1.0 : 0.0} {}

  /// Whether points on emitters are sampled.
  bool draws() const { return counts_.nee > 0; }

  /// The weighted contribution of the emission at vertex `v`, `depth` edges from the eye.
  Rgb met(const Vertex& v, int depth) const {
    const std::optional<EmitterPoint> e = emitter_at(scene_, v);
    if (!e) return Rgb(0, 0, 0);
    return v.throughput * e->emission * static_cast<float>(hit_weight(v, depth, *e, counts_));
  }

  /// Joins the connectible vertex `v` to a point sampled on the emitter `chosen`
  /// (EmitterSet::choose). Calls `add(ray, value)` where the contribution is not black; `value`
  /// counts if the shadow ray `ray` is unoccluded.
  template <class Add>
  void draw(const Vertex& v, int depth, std::uint32_t chosen, Rng& rng, Add&& add) const {
    const EmitterPoint e = scene_.emitters().sample(chosen, rng);
    const SurfaceEndpoint<Guide> eye{v, depth, Transport::radiance, guide_};
    const EmitterEndpoint light{e};
    if (const Connection c = connect(eye, light)) {
      const auto w = static_cast<float>(weight(eye, light, c, counts_));
      add(shadow_ray(eye, light, c), c.contribution * w);
    }
  }

 private:
  const Scene& scene_;
  const Guide& guide_;
  SampleCounts counts_;
};

}  // namespace lacuna
