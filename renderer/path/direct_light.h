#pragma once

#include "renderer/path/connect.h"

namespace lacuna {

/// The two ways in which a path from the eye alone finds light: an emitter that it meets (s = 0),
/// and a point drawn on an emitter at each of its vertices (s = 1, next event estimation), weighted
/// against each other.
template <class Guide>
class DirectLight {
 public:
  /// Without `next_event`, or without emitters, nothing is drawn and what is met counts in full.
  DirectLight(const Scene& scene, const Guide& guide, bool next_event)
      : scene_(scene),
        guide_(guide),
        counts_{.hit = 1, .nee = next_event && !scene.emitters().empty() ? 1.0 : 0.0} {}

  /// Points on emitters are drawn.
  bool draws() const { return counts_.nee > 0; }

  /// What the vertex `v`, `depth` edges from the eye, itself emits.
  Rgb met(const Vertex& v, int depth) const {
    const std::optional<EmitterPoint> e = emitter_at(scene_, v);
    if (!e) return Rgb(0, 0, 0);
    return v.throughput * e->emission * static_cast<float>(hit_weight(v, depth, *e, counts_));
  }

  /// Joins the connectible vertex `v` to a point on the emitter `chosen` (EmitterSet::choose) and
  /// calls `add(ray, value)` if light may pass: `value` counts if `ray` meets nothing.
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
