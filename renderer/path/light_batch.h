#pragma once

#include <array>

#include "renderer/path/connect.h"
#include "renderer/path/shadow_queue.h"
#include "renderer/path/splats.h"
#include "renderer/path/walk.h"

namespace lacuna {

/// The scene, camera and limits that light paths are traced with.
struct LightPathSetting {
  const Scene& scene;
  const Camera& camera;
  int max_depth;       ///< edges of whole paths, the one to the eye included
  int roulette_depth;  ///< as WalkLimits
  SampleCounts counts;
  /// Choose the emitters of an iteration's paths by systematic sampling: at equal steps from a
  /// random start. Each path alone has the same distribution; together they are stratified.
  bool spread = false;
};

/// At most `size` light paths that are traced together. Path i of the batch has index i throughout.
template <class Guide>
class LightBatch {
 public:
  static constexpr int size = 64;  // their vertices fit the second-level cache

  LightBatch(const LightPathSetting& setting, const Guide& guide)
      : setting_(setting),
        guide_(guide),
        places_(static_cast<std::size_t>(setting.max_depth)),
        vertices_(places_ * size) {
    states_.reserve(size);
  }

  /// Traces one path for each generator. A path that no emitter could start has length 0.
  /// `choices`: 32 uniform bits for each path that choose its emitter; empty: drawn from `rngs`.
  void walk(std::span<const Rng> rngs, Counters& counters,
            std::span<const std::uint32_t> choices = {}) {
    states_.clear();
    counters.samples += rngs.size();
    for (std::size_t i = 0; i < rngs.size(); ++i) {
      Rng rng = rngs[i];
      const std::uint32_t own = rng.next_u32();
      start(i, rng, choices.empty() ? own : choices[i]);
    }
    const WalkLimits limits{.max_depth = setting_.max_depth - 1,
                            .last_scatters = true,
                            .roulette_depth = setting_.roulette_depth,
                            .transport = Transport::importance,
                            .counts = light_side(setting_.counts)};
    Walk<Guide> walk(setting_.scene, guide_, limits, counters);
    walk.trace_paths(
        states_, [](std::size_t, int) {},
        [&](std::size_t i, int depth) {
          if (vertex(path_of_[i], depth).kind == Vertex::Kind::surface)
            length_[path_of_[i]] = depth + 1;
        });
  }

  /// Number of vertices of path `i`, including the one on the emitter.
  int length(std::size_t i) const { return length_[i]; }
  /// Vertex 0, on an emitter.
  const EmitterPoint& emitter(std::size_t i) const { return emitters_[i]; }
  /// Vertex `index` in [1, length(i)).
  const Vertex& vertex(std::size_t i, int index) const {
    return vertices_[i * places_ + static_cast<std::size_t>(index)];
  }
  SurfaceEndpoint<Guide> end(std::size_t i, int index) const {
    return {vertex(i, index), index, Transport::importance, guide_};
  }

  /// Joins all vertices of the first `paths` paths to the eye (t = 1) and appends the unoccluded
  /// contributions to `splats`.
  void splat(std::size_t paths, Counters& counters, Splats& splats) {
    for (std::size_t i = 0; i < paths; ++i) {
      if (length_[i] > 0 && !emitters_[i].delta()) splat_end(EmitterEndpoint{emitters_[i]});
      for (int index = 1; index < length_[i]; ++index) {
        if (vertex(i, index).bsdf->connectible()) splat_end(end(i, index));
      }
    }
    queue_.flush(setting_.scene.rays(), counters, [&](const PendingSplat& p) {
      setting_.camera.splat(p.at, [&](std::uint32_t pixel, float share) {
        splats.push_back({p.value * share, p.weight, pixel, p.s});
      });
    });
  }

 private:
  /// A contribution to the eye that waits for its shadow ray.
  struct PendingSplat {
    Rgb value;
    float weight;
    V2f at;
    std::uint16_t s;
  };

  void start(std::size_t i, Rng rng, std::uint32_t choice) {
    length_[i] = 0;
    const EmitterSet& lights = setting_.scene.emitters();
    if (lights.empty()) return;
    const EmitterPoint& e = emitters_[i] = lights.sample(lights.choose(choice, rng), rng);
    length_[i] = 1;
    if (setting_.max_depth == 1) return;
    const std::optional<Leaving> leaving = lights.sample_first_edge(e, rng);
    if (!leaving) return;
    const std::span<Vertex> path = std::span(vertices_).subspan(i * places_, places_);
    path[0].kind = e.infinite() ? Vertex::Kind::background : Vertex::Kind::emitter;
    path[0].surface.x = e.x;
    path[0].surface.ng = e.ng;
    PathState w{.rng = rng, .ray = leaving->ray, .p = leaving->pdf, .path = path};
    w.throughput = leaving->throughput;
    w.roulette_scale = 1 / max_component(leaving->throughput);
    if (!e.delta()) w.mis_partial = light_side(setting_.counts).none / double(e.pdf.value);
    path_of_[states_.size()] = i;
    states_.push_back(w);
  }

  template <class End>
  void splat_end(const End& light) {
    const EyeEndpoint eye{setting_.camera};
    const V3f to = at_infinity(light) ? light.x() : light.x() - eye.x();
    const std::optional<V2f> at = setting_.camera.project(to.normalized());
    if (!at) return;
    const Connection c = connect(eye, light);
    if (!c) return;
    queue_.add(shadow_ray(eye, light, c),
               {c.contribution / static_cast<float>(setting_.counts.splat),
                static_cast<float>(weight(eye, light, c, setting_.counts)), *at,
                static_cast<std::uint16_t>(light.index + 1)});
  }

  const LightPathSetting& setting_;
  const Guide& guide_;
  std::size_t places_;
  std::vector<Vertex> vertices_;
  std::vector<PathState> states_;
  std::array<std::size_t, size> path_of_{};  // of each state in states_, its path's index
  std::array<int, size> length_{};
  std::array<EmitterPoint, size> emitters_{};
  ShadowQueue<PendingSplat> queue_;
};

}  // namespace lacuna
