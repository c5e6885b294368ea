#pragma once

#include "renderer/path/connect.h"
#include "renderer/path/next_event.h"

namespace lacuna {

/// The two strategies of unidirectional path tracing, combined by `heuristic`: the eye path hits an
/// emitter (s = 0), or a point on an emitter is sampled at one of its vertices (s = 1, next event
/// estimation).
class DirectLight {
 public:
  /// A point on an emitter, as a vertex sees it.
  struct Sample {
    const V3f& w;  ///< unit, to the point
    float weight;  ///< MIS
    const EmitterPoint& point;
  };

  /// Without `next_event`, or without emitters, no points on emitters are sampled and hits have
  /// weight 1.
  DirectLight(const Scene& scene, const Guide& guide, bool next_event, EmitterChoice emitters,
              Heuristic heuristic = Heuristic::power)
      : scene_(scene),
        guide_(guide),
        next_event_(scene, emitters),
        heuristic_(heuristic),
        counts_{.hit = 1, .nee = next_event && !scene.emitters().empty() ? 1.0 : 0.0} {}

  /// Whether points on emitters are sampled.
  bool active() const { return counts_.nee > 0; }

  const NextEvent& next_event() const { return next_event_; }

  /// The weighted contribution of the emission at vertex `v`, `depth` edges from the eye; `before`
  /// is the vertex before it.
  Rgb hit(const Vertex& v, const Vertex& before, int depth) const {
    std::optional<EmitterPoint> e = emitter_at(scene_, v);
    if (!e) return Rgb(0, 0, 0);
    if (active()) next_event_.set_ratio(*e, v, before, depth);
    const double w = of_two(hit_weight(v, depth, *e, counts_, guide_));
    return v.throughput * e->emission * static_cast<float>(w);
  }

  /// Connects the connectible vertex `v` to a point that is sampled on an emitter; `preselected` is
  /// from EmitterSelection. If the contribution is not black, calls `add(ray, value, sample)`:
  /// `value`, which includes the weight, counts if the shadow ray `ray` is unoccluded.
  template <class Add>
  [[gnu::flatten]] void sample(const Vertex& v, int depth, NextEvent::Preselected preselected,
                               Rng& rng, Add&& add) const {
    const EmitterPoint e = next_event_.sample(v, preselected, rng);
    const SurfaceEndpoint eye{v, depth, Transport::radiance, guide_};
    const EmitterEndpoint light{e, guide_};
    if (const Connection c = connect(eye, light)) {
      const auto w = static_cast<float>(of_two(weight(eye, light, c, counts_)));
      add(shadow_ray(eye, light, c), c.contribution * w, Sample{c.w, w, e});
    }
  }

 private:
  /// The weight of one of the two techniques, from that by the balance heuristic.
  double of_two(double balance) const {
    return heuristic_ == Heuristic::power ? power_of_two(balance) : balance;
  }

  const Scene& scene_;
  const Guide& guide_;
  NextEvent next_event_;
  Heuristic heuristic_;
  SampleCounts counts_;
};

}  // namespace lacuna
