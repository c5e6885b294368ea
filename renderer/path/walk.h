#pragma once

#include <numeric>
#include <span>
#include <vector>

#include "renderer/core/rng.h"
#include "renderer/path/counters.h"
#include "renderer/path/mis.h"
#include "renderer/path/vertex.h"
#include "renderer/scene/scene.h"

namespace lacuna {

/// Limits and transport of a walk.
struct WalkLimits {
  int max_depth = 1;           ///< edges
  bool last_scatters = false;  ///< make a Bsdf at the last vertex too, because it will be connected
  int roulette_depth = 1;      ///< edges before Russian roulette may end the path
  Transport transport = Transport::radiance;
  /// Sample counts of this side's strategies; all 0: Vertex::mis_partial is not computed.
  TechniqueCounts counts = {};
};

/// The state of a random walk between two edges.
struct PathState {
  Rng rng;
  Ray ray;                  ///< the next edge
  Hit hit{};                ///< of `ray`
  Rgb throughput{1, 1, 1};  ///< along `ray`
  Pdf<SolidAngle> p;        ///< density with which the direction of `ray` was sampled
  /// 1 / the largest component of the first edge's throughput, times BsdfSample::pdf_ratio of all
  /// vertices. throughput times this scale is the throughput that sampling the BSDF would have
  /// left. A guide lowers throughput where it sends many paths, so roulette by throughput alone
  /// would end just those.
  float roulette_scale = 1;
  std::span<Vertex> path;  ///< room for max_depth + 1 vertices; path[0] is set
  /// mis_partial_sum() of the last vertex over its density. At vertex 0 of a light path whose
  /// emitter can be hit: TechniqueCounts::none over its density.
  double mis_partial = 0;
};

/// Traces a batch of random walks through a scene, one edge of each at a time: the memory that a
/// vertex needs is prefetched while the rays of the others are traced, which pays where a scene is
/// larger than the caches. The guide (renderer/guides) samples the directions. The walks are
/// independent: the results do not depend on the size of the batch.
template <class Guide>
class Walk {
 public:
  Walk(const Scene& scene, const Guide& guide, const WalkLimits& limits, Counters& counters)
      : scene_(scene), guide_(guide), limits_(limits), counters_(counters) {}

  /// Stores each vertex in its path and calls `visit(i, depth)`, with i the index of the path and
  /// depth the number of its edges, before the next direction is sampled. `before(i, depth)` is
  /// called before the ray to that vertex is traced, for random numbers that are drawn ahead. The
  /// densities of all vertices are per area. A `visit` that returns false ends its walk.
  template <class Before, class Visit>
  void trace_paths(std::span<PathState> states, Before&& before, Visit&& visit) {
    active_.resize(states.size());
    std::iota(active_.begin(), active_.end(), std::size_t{0});
    for (int depth = 1; depth <= limits_.max_depth && !active_.empty(); ++depth) {
      for (const std::size_t i : active_) {
        before(i, depth);
        trace(states[i], depth);
      }
      for (const std::size_t i : active_) on_hit(states[i], depth);
      std::erase_if(active_, [&](std::size_t i) {
        scatter(states[i], depth);
        if constexpr (std::is_void_v<decltype(visit(i, depth))>) {
          visit(i, depth);
        } else if (!visit(i, depth)) {
          return true;
        }
        return !sample_next(states[i], depth);
      });
    }
  }

 private:
  static Vertex& vertex(PathState& w, int depth) { return w.path[static_cast<std::size_t>(depth)]; }

  void trace(PathState& w, int depth) {
    ++counters_.rays;
    const bool met = scene_.rays().intersect(w.ray, w.hit);
    vertex(w, depth).kind = met ? Vertex::Kind::surface : Vertex::Kind::background;
    if (met) scene_.prefetch(w.hit);
  }

  void on_hit(PathState& w, int depth) {
    Vertex& v = vertex(w, depth);
    v.delta = false;
    v.wp = -w.ray.d;
    v.throughput = w.throughput;
    if (v.kind == Vertex::Kind::background) {
      v.surface.x = w.ray.d;
    } else {
      v.surface = scene_.surface(w.hit);
      if (scatters(depth)) scene_.prefetch_bsdf(v.surface);
    }
    const Vertex& before = vertex(w, depth - 1);
    v.p_fwd = to_area(w.p, before, w.ray.d, v);
    if (w.mis_partial > 0) {
      v.mis_partial = w.mis_partial * double(to_area(Pdf<SolidAngle>(1.0F), v, v.wp, before).value);
    } else {
      v.mis_partial = 0;
    }
    v.prev_connectible = before.connectible();
  }

  bool scatters(int depth) const { return limits_.last_scatters || depth < limits_.max_depth; }

  void scatter(PathState& w, int depth) {
    Vertex& v = vertex(w, depth);
    if (v.kind == Vertex::Kind::background || !scatters(depth)) return;
    scene_.make_bsdf(v.surface, v.bsdf);
    if constexpr (requires { guide_.on_hit(v); }) guide_.on_hit(v);
  }

  /// Samples the next edge; false where the walk ends.
  bool sample_next(PathState& w, int depth) {
    Vertex& v = vertex(w, depth);
    if (v.kind == Vertex::Kind::background || depth == limits_.max_depth) return false;
    const std::optional<BsdfSample> next = guide_.sample(v, w.rng, limits_.transport);
    if (!next) return false;
    w.throughput *= next->weight;
    w.roulette_scale *= next->pdf_ratio;
    if (depth >= limits_.roulette_depth) {
      const float survival = std::min(1.0F, max_component(w.throughput) * w.roulette_scale);
      if (!w.rng.decide(survival)) return false;
      w.throughput /= survival;
    }
    v.delta = next->delta;
    // Deltas cancel in all ratios of densities, if both walks leave them out.
    w.p = next->delta ? Pdf<SolidAngle>(1.0F) : next->pdf;
    if (tracked_) w.mis_partial = mis_partial(v, depth, next->wi);
    w.ray = {offset_origin(v.surface.x, v.surface.ng, v.surface.extent, next->wi), next->wi};
    return true;
  }

  double mis_partial(const Vertex& v, int depth, const V3f& wi) const {
    const bool connectible = v.prev_connectible && v.connectible();
    double pdf_rev = 0;
    if (v.mis_partial > 0) {
      const Transport other =
          limits_.transport == Transport::radiance ? Transport::importance : Transport::radiance;
      pdf_rev = v.delta ? 1.0 : double(guide_.pdf(v, wi, v.wp, other).value);
    }
    return mis_partial_sum(limits_.counts, depth, connectible, pdf_rev, v.mis_partial) /
           double(v.p_fwd.value);
  }

  const Scene& scene_;
  const Guide& guide_;
  WalkLimits limits_;
  bool tracked_ = limits_.counts.any();
  Counters& counters_;
  std::vector<std::size_t> active_;
};

}  // namespace lacuna
