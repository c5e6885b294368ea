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

/// How far a walk goes, and for whom.
struct WalkLimits {
  int max_depth = 1;           ///< edges
  bool last_scatters = false;  ///< the vertex after the last edge has a Bsdf too: it will be joined
  int roulette_depth = 1;      ///< edges that are walked before Russian roulette may end the path
  Transport transport = Transport::radiance;
  TechniqueCounts counts =
      {};  ///< of this side's strategies; all 0: Vertex::mis_partial is not needed
};

/// A random walk, between two of its edges.
struct PathState {
  Rng rng;
  Ray ray;                  ///< the next edge
  Hit hit{};                ///< of it
  Rgb throughput{1, 1, 1};  ///< along it
  Pdf<SolidAngle> p;        ///< density with which it was drawn
  /// 1 / the largest component of the first edge's throughput, times BsdfSample::pdf_ratio of all
  /// vertices: what is left by throughput that way is what the BSDF's own draws would have left. A
  /// guide lowers it where it sends many paths, so roulette by it alone would end just those.
  float roulette_scale = 1;
  std::span<Vertex> path;  ///< max_depth + 1 places; path[0] is set
  /// mis_partial_sum() of the last vertex over its density: of the first, for a path from a light
  /// whose emitter can be hit, TechniqueCounts::none over its density.
  double mis_partial = 0;
};

/// Leads random walks through a scene, all of them edge by edge: what a vertex needs from memory is
/// asked for while the others' rays are traced, which pays where a scene is larger than the caches.
/// The guide (renderer/guides) draws the directions. Walks know nothing of one another: the results
/// are the same however many are led together.
template <class Guide>
class Walk {
 public:
  Walk(const Scene& scene, const Guide& guide, const WalkLimits& limits, Counters& counters)
      : scene_(scene), guide_(guide), limits_(limits), counters_(counters) {}

  /// Each vertex reached is stored in its walker's path and handed to `visit(i, depth)`, i = index
  /// of the walker and depth = edges walked, before the walk goes on from it; `before(i, depth)` is
  /// called before the ray to it is traced, for what can be drawn ahead. The densities of all
  /// vertices are per area. A `visit` that returns bool ends the walk by false.
  template <class Before, class Visit>
  void trace_paths(std::span<PathState> walkers, Before&& before, Visit&& visit) {
    active_.resize(walkers.size());
    std::iota(active_.begin(), active_.end(), std::size_t{0});
    for (int depth = 1; depth <= limits_.max_depth && !active_.empty(); ++depth) {
      for (const std::size_t i : active_) {
        before(i, depth);
        trace(walkers[i], depth);
      }
      for (const std::size_t i : active_) arrive(walkers[i], depth);
      std::erase_if(active_, [&](std::size_t i) {
        scatter(walkers[i], depth);
        if constexpr (std::is_void_v<decltype(visit(i, depth))>) {
          visit(i, depth);
        } else if (!visit(i, depth)) {
          return true;
        }
        return !leave(walkers[i], depth);
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

  void arrive(PathState& w, int depth) {
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
    v.prior_connectible = before.connectible();
  }

  bool scatters(int depth) const { return limits_.last_scatters || depth < limits_.max_depth; }

  void scatter(PathState& w, int depth) {
    Vertex& v = vertex(w, depth);
    if (v.kind == Vertex::Kind::background || !scatters(depth)) return;
    scene_.make_bsdf(v.surface, v.bsdf);
    if constexpr (requires { guide_.arrive(v); }) guide_.arrive(v);
  }

  /// Draws the next edge; false where the walk ends.
  bool leave(PathState& w, int depth) {
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
    const bool connectible = v.prior_connectible && v.connectible();
    double back = 0;
    if (v.mis_partial > 0) {
      const Transport other =
          limits_.transport == Transport::radiance ? Transport::importance : Transport::radiance;
      back = v.delta ? 1.0 : double(guide_.pdf(v, wi, v.wp, other).value);
    }
    return mis_partial_sum(limits_.counts, depth, connectible, back, v.mis_partial) /
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
