#pragma once

#include <array>

#include "renderer/path/connect.h"
#include "renderer/path/merge.h"
#include "renderer/path/next_event.h"
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
  /// How the strategy s = 1 selects emitters; where it does, counts.nee > 0.
  EmitterChoice next_event = EmitterChoice::power;
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
        next_event_(setting.scene, setting.next_event),
        vertices_(places_ * size),
        hits_(places_ * size) {
    states_.reserve(size);
  }

  /// Traces one path for each generator. A path that no emitter could start has length 0.
  /// `choices`: 32 uniform bits for each path that choose its emitter; empty: drawn from `rngs`.
  /// `wanted`: the most vertices of each path, >= 1; empty: as many as max_depth allows.
  void walk(std::span<const Rng> rngs, Counters& counters,
            std::span<const std::uint32_t> choices = {}, std::span<const int> wanted = {}) {
    const auto goes_on = [&](std::size_t i, int vertices) {
      return vertices < (wanted.empty() ? setting_.max_depth : wanted[i]);
    };
    states_.clear();
    counters.samples += rngs.size();
    for (std::size_t i = 0; i < rngs.size(); ++i) {
      Rng rng = rngs[i];
      Rng::FinePoint at = rng.next_fine_point();
      if (!choices.empty()) at.x = std::uint64_t{choices[i]} << 32 | (at.x & 0xffffffff);
      if (start(i, at) && goes_on(i, 1)) leave(i, rng);
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
          const std::size_t path = path_of_[i];
          if (vertex(path, depth).kind == Vertex::Kind::surface) length_[path] = depth + 1;
          if (depth == 1) set_ratio(path);
          hits_[path * places_ + static_cast<std::size_t>(depth)] = states_[i].hit;
          return goes_on(path, depth + 1);
        });
  }

  /// Makes path `i` the one that had these vertices, ascending, each with its hit() beside it. The
  /// others are not connectible; vertex 0 is left as it is.
  void restore(std::size_t i, std::span<const Photon> photons, std::span<const Hit> hits) {
    length_[i] = photons.empty() ? 1 : photons.back().index + 1;
    for (int index = 1; index < length_[i]; ++index) vertex_to_set(i, index).bsdf.reset();
    for (std::size_t k = 0; k < photons.size(); ++k) {
      const Photon& p = photons[k];
      Vertex& v = vertex_to_set(i, p.index);
      v.kind = Vertex::Kind::surface;
      v.delta = false;
      v.surface = setting_.scene.surface(hits[k], p.x);
      v.wp = p.wp;
      v.throughput = p.throughput;
      v.p_fwd = Pdf<Area>(p.p_fwd);
      v.prev_connectible = p.prev_connectible;
      v.mis_partial = p.mis_partial;
      setting_.scene.make_bsdf(v.surface, v.bsdf);
      guide_.on_hit(v);
    }
  }

  /// Number of vertices of path `i`, including the one on the emitter.
  int length(std::size_t i) const { return length_[i]; }
  /// Vertex 0, on an emitter.
  const EmitterPoint& emitter(std::size_t i) const { return emitters_[i]; }
  /// Vertex `index` in [1, length(i)).
  const Vertex& vertex(std::size_t i, int index) const {
    return vertices_[i * places_ + static_cast<std::size_t>(index)];
  }
  bool connectible(std::size_t i, int index) const {
    const std::optional<Bsdf>& bsdf = vertex(i, index).bsdf;
    return bsdf && bsdf->connectible();
  }
  /// Of the ray to a vertex.
  const Hit& hit(std::size_t i, int index) const {
    return hits_[i * places_ + static_cast<std::size_t>(index)];
  }
  SurfaceEndpoint<Guide> end(std::size_t i, int index) const {
    return {vertex(i, index), index, Transport::importance, guide_};
  }

  /// Joins all vertices of the first `paths` paths to the eye (t = 1) and appends the unoccluded
  /// contributions to `splats`.
  void splat(std::size_t paths, Counters& counters, Splats& splats) {
    for (std::size_t i = 0; i < paths; ++i) {
      for (int index = 0; index < length_[i]; ++index) {
        join_eye(i, index,
                 [&](const Ray& ray, const UnshadowedSplat& splat) { queue_.add(ray, splat); });
      }
    }
    queue_.flush(setting_.scene.rays(), counters, [&](const UnshadowedSplat& p) {
      setting_.camera.splat(p.at, [&](std::uint32_t pixel, float share) {
        splats.push_back({p.value * share, p.weight, pixel, p.s});
      });
    });
  }

  /// A contribution to the eye that waits for its shadow ray.
  struct UnshadowedSplat {
    Rgb value;     ///< divided by the number of samples of t = 1
    float weight;  ///< MIS
    V2f at;        ///< on the film, in pixels
    std::uint16_t s;
  };
  /// Joins vertex `index` in [0, length(i)) of path `i` to the eye (t = 1) and calls `joined(ray,
  /// splat)` where the unoccluded contribution is not black.
  template <class Joined>
  void join_eye(std::size_t i, int index, Joined&& joined) const {
    if (index == 0) {
      if (!emitters_[i].delta()) join_eye(EmitterEndpoint<Guide>{emitters_[i], guide_}, joined);
    } else if (connectible(i, index)) {
      join_eye(end(i, index), joined);
    }
  }

 private:
  Vertex& vertex_to_set(std::size_t i, int index) {
    return vertices_[i * places_ + static_cast<std::size_t>(index)];
  }

  /// What vertex 1 of path `i` stores of next event estimation.
  void set_ratio(std::size_t i) {
    if (length_[i] < 2 || !(setting_.counts.nee > 0)) return;
    Vertex& v = vertex_to_set(i, 1);
    if (v.connectible()) v.next_event_ratio = next_event_.ratio(emitters_[i], v);
  }

  /// Vertex 0; false where there is none.
  bool start(std::size_t i, const Rng::FinePoint& at) {
    const EmitterSet& lights = setting_.scene.emitters();
    length_[i] = lights.empty() ? 0 : 1;
    if (!lights.empty()) emitters_[i] = lights.sample(lights.choose(at));
    return !lights.empty();
  }

  std::optional<Leaving> first_edge(const EmitterPoint& e, Rng& rng) const {
    const EmitterSet& lights = setting_.scene.emitters();
    if constexpr (requires { guide_.sample_first_edge(lights, e, rng); }) {
      static_assert(
          requires { guide_.leaving_pdf(e, V3f()); }, "weights need its density");
      return guide_.sample_first_edge(lights, e, rng);
    } else {
      return lights.sample_first_edge(e, rng);
    }
  }

  /// The first edge.
  void leave(std::size_t i, Rng& rng) {
    const EmitterPoint& e = emitters_[i];
    const std::optional<Leaving> leaving = first_edge(e, rng);
    if (!leaving) return;
    const std::span<Vertex> path = std::span(vertices_).subspan(i * places_, places_);
    place_on(e, path[0]);
    PathState w{.rng = rng, .ray = leaving->ray, .p = leaving->pdf, .path = path};
    w.throughput = leaving->throughput;
    w.roulette_scale = 1 / max_component(leaving->throughput);
    if (!e.delta()) w.mis_partial = light_side(setting_.counts).none / double(e.pdf.value);
    path_of_[states_.size()] = i;
    states_.push_back(w);
  }

  template <class End, class Joined>
  void join_eye(const End& light, Joined& joined) const {
    const EyeEndpoint eye{setting_.camera};
    const V3f to = at_infinity(light) ? light.x() : light.x() - eye.x();
    const std::optional<V2f> at = setting_.camera.project(to.normalized());
    if (!at) return;
    const Connection c = connect(eye, light);
    if (!c) return;
    joined(shadow_ray(eye, light, c),
           UnshadowedSplat{c.contribution / static_cast<float>(setting_.counts.splat),
                           static_cast<float>(weight(eye, light, c, setting_.counts)), *at,
                           static_cast<std::uint16_t>(light.index + 1)});
  }

  const LightPathSetting& setting_;
  const Guide& guide_;
  std::size_t places_;
  NextEvent next_event_;
  std::vector<Vertex> vertices_;
  std::vector<Hit> hits_;  // of each vertex
  std::vector<PathState> states_;
  std::array<std::size_t, size> path_of_{};  // of each state in states_, its path's index
  std::array<int, size> length_{};
  std::array<EmitterPoint, size> emitters_{};
  ShadowQueue<UnshadowedSplat> queue_;
};

}  // namespace lacuna
