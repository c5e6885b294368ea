#pragma once

#include <array>
#include <cmath>
#include <numeric>
#include <span>
#include <vector>

#include "renderer/core/rng.h"
#include "renderer/path/counters.h"
#include "renderer/path/mis.h"
#include "renderer/path/roulette.h"
#include "renderer/path/vertex.h"
#include "renderer/scene/scene.h"

namespace lacuna {

/// Limits and transport of a walk.
struct WalkLimits {
  int max_depth = 1;           ///< edges
  bool last_scatters = false;  ///< make a Bsdf at the last vertex too, because it will be connected
  int roulette_depth = 1;      ///< edges before Russian roulette may end the path
  int split_depth = 1;         ///< edges before the path may be split
  Transport transport = Transport::radiance;
  /// The walks begin with the coherent rays of start_paths(), which are traced in packets.
  bool packets = false;
  /// Sample counts of this side's strategies; all 0: Vertex::mis_partial is not computed.
  TechniqueCounts counts = {};
  /// Takes the place of the other kinds of roulette where it knows enough; null: there is none.
  const Roulette* roulette = nullptr;
};

/// The state of a random walk between two edges.
struct PathState {
  Rng rng;
  Ray ray;                  ///< the next edge
  Hit hit{};                ///< of `ray`
  Rgb throughput{1, 1, 1};  ///< along `ray`
  Pdf<SolidAngle> p;        ///< density with which the direction of `ray` was sampled
  /// BsdfSample::pdf_ratio of all vertices: throughput times this scale is the throughput that
  /// sampling the BSDF would have left. A guide lowers throughput where it sends many paths, so
  /// roulette by throughput alone would end just those.
  float roulette_scale = 1;
  std::span<Vertex> path;  ///< room for max_depth + 1 vertices; path[0] is set
  /// mis_partial_sum() of the last vertex over its density. At vertex 0 of a light path whose
  /// emitter can be hit: TechniqueCounts::none over its density.
  double mis_partial = 0;
  int depth = 0;      ///< edges traced: path[depth] is the last vertex
  int reference = 0;  ///< depth of the first vertex whose BSDF has a density; 0: none yet
  /// Luminance that the path was expected to add behind that vertex; below 0 until it is needed.
  float expected = -1;
  float least = 0;  ///< luminance of throughput below which the path is not split
  float split = 1;  ///< number of equal parts it was split into since it started or branched off
  /// Roulette by what is known of the light has replaced that by throughput at the last vertex.
  bool windowed = false;
  float carried = 0;  ///< luminance of throughput when it left the last vertex; 0: it did not
  /// `throughput` times this is what roulette goes by. Of an eye path: the largest component of
  /// what PathReuse keeps apart from `throughput`; of a light path: 1 / that of the first edge.
  float carried_before = 1;
  std::uint32_t segment = 0;  ///< of PathTrees; a branch has that of the path that was split
};

/// One part of a path that was split at its last vertex. It continues there on its own.
struct PathBranch {
  PathState state{.rng = Rng(0, 0, 0), .ray = {}, .p = {}, .path = {}};
  Vertex vertex;         ///< the last one, with the throughput of the branch
  std::size_t walk = 0;  ///< index of the path that was split
};

/// What Walk::trace_paths() calls for many vertices at once: here nothing.
struct NothingTogether {
  static constexpr bool wanted() { return false; }
  void operator()(std::span<const std::size_t>) const {}
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
  /// densities of all vertices are per area. A `visit` that returns false ends its walk. A state
  /// whose depth is above 0 is a branch: it continues at its last vertex. New branches are appended
  /// to branches().
  /// `together`, if it is wanted, is called for all vertices of one length at once, before they are
  /// visited.
  template <class Before, class Visit, class Together = NothingTogether>
  void trace_paths(std::span<PathState> states, Before&& before, Visit&& visit,
                   Together&& together = {}) {
    active_.resize(states.size());
    std::iota(active_.begin(), active_.end(), std::size_t{0});
    std::erase_if(active_,
                  [&](std::size_t i) { return states[i].depth > 0 && !sample_next(states[i]); });
    bool packets = limits_.packets && !states.empty() && states[0].depth == 0;
    while (!active_.empty()) {
      for (const std::size_t i : active_) {
        const int depth = ++states[i].depth;
        before(i, depth);
        if (!packets) trace(states[i], depth);
      }
      if (packets) trace_first(states);
      packets = false;
      for (const std::size_t i : active_) on_hit(states[i], states[i].depth);
      const bool at_once = together.wanted();
      if (at_once) {
        for (const std::size_t i : active_) scatter(states[i], states[i].depth);
        together(active_);
      }
      std::erase_if(active_, [&](std::size_t i) {
        const int depth = states[i].depth;
        if (!at_once) scatter(states[i], depth);
        if constexpr (std::is_void_v<decltype(visit(i, depth))>) {
          visit(i, depth);
        } else if (!visit(i, depth)) {
          return true;
        }
        return !continues(states[i], i) || !sample_next(states[i]);
      });
    }
  }

  /// The parts that paths were split into, in a fixed order. The caller removes and traces them.
  std::vector<PathBranch>& branches() { return branches_; }

 private:
  static Vertex& vertex(PathState& w, int depth) { return w.path[static_cast<std::size_t>(depth)]; }

  void trace(PathState& w, int depth) {
    ++counters_.rays;
    const bool met = scene_.rays().intersect(w.ray, w.hit);
    vertex(w, depth).kind = met ? Vertex::Kind::surface : Vertex::Kind::background;
    if (met) scene_.prefetch(w.hit);
  }

  /// trace() of all first edges, eight at a time. In a packet the nearest of two triangles that a
  /// ray hits at the same distance may be the other one: which rays are in one must not depend on
  /// threads or tiles.
  void trace_first(std::span<PathState> states) {
    constexpr std::size_t together = 8;
    std::array<Ray, together> rays;
    std::array<Hit, together> hits;
    std::array<std::uint8_t, together> met{};
    counters_.rays += states.size();
    for (std::size_t first = 0; first < states.size(); first += together) {
      const std::span<PathState> some =
          states.subspan(first, std::min(together, states.size() - first));
      for (std::size_t k = 0; k < some.size(); ++k) rays[k] = some[k].ray;
      scene_.rays().intersect(std::span(rays).first(some.size()), hits, met);
      for (std::size_t k = 0; k < some.size(); ++k) {
        vertex(some[k], 1).kind = met[k] != 0 ? Vertex::Kind::surface : Vertex::Kind::background;
        if (met[k] == 0) continue;
        some[k].hit = hits[k];
        scene_.prefetch(hits[k]);
      }
    }
  }

  void on_hit(PathState& w, int depth) {
    Vertex& v = vertex(w, depth);
    v.delta = false;
    v.next_event_ratio = 1;
    v.wp = -w.ray.d;
    v.throughput = w.throughput;
    if (v.kind == Vertex::Kind::background) {
      v.surface.x = w.ray.d;
    } else {
      v.surface = scene_.surface(w.ray, w.hit);
      if (scatters(depth)) {
        scene_.prefetch_bsdf(v.surface);
        if constexpr (requires { guide_.prefetch(v); }) guide_.prefetch(v);
      }
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

  /// False where the walk ends before a direction is sampled. May split the path.
  bool continues(PathState& w, std::size_t walk) {
    const Vertex& v = vertex(w, w.depth);
    w.carried = 0;
    if (v.kind == Vertex::Kind::background || w.depth == limits_.max_depth) return false;
    if (!keep(w, v, walk)) return false;
    w.carried = luminance(w.throughput);
    return true;
  }

  bool keep(PathState& w, const Vertex& v, std::size_t walk) {
    if (limits_.roulette != nullptr) return keep_efficient(w, v, walk);
    if constexpr (Guide::has_expected) {
      return !guide_.guides(limits_.transport) || keep_expected(w, v, walk);
    }
    return true;
  }

  /// As many continuations as Roulette advises.
  bool keep_efficient(PathState& w, const Vertex& v, std::size_t walk) {
    w.windowed = false;
    if (!v.bsdf->connectible()) return true;
    const float carried = luminance(w.throughput);
    if (w.reference == 0) begin_window(w, carried);
    const float parts = limits_.roulette->continuations(v, limits_.max_depth - w.depth, carried);
    if (parts < 0) return true;
    w.windowed = true;
    if (parts < 1) return survive(w, parts);
    if (carried > w.least && parts > 1) split(w, v, static_cast<int>(std::lround(parts)), walk);
    return true;
  }

  static void begin_window(PathState& w, float carried) {
    w.reference = w.depth;
    w.least = carried * least_part;
  }

  /// Russian roulette.
  static bool survive(PathState& w, float survival) {
    if (!w.rng.decide(survival)) return false;
    w.throughput /= survival;
    w.roulette_scale *= survival;
    return true;
  }

  /// Adjoint-driven Russian roulette and splitting (Vorba and Krivanek 2016): keeps the luminance
  /// that a guided path is expected to add to the picture within a window around what it was at the
  /// first vertex. Guiding weights multiply by a factor at each vertex; without a window their
  /// variance grows exponentially with the depth. False where roulette ends the path.
  bool keep_expected(PathState& w, const Vertex& v, std::size_t walk) {
    constexpr float low = 1.0F / 3, high = 5.0F / 3;  // 2 / (1 + s) and 2 s / (1 + s), s = 5
    constexpr float min_survival = 0.1F;
    constexpr int max_parts = 16;
    w.windowed = false;
    if (!v.bsdf->connectible()) return true;
    const float carried = w.carried_before * luminance(w.throughput);
    if (w.reference == 0) {
      begin_window(w, carried);
      return true;
    }
    // What the guide has added to the weight.
    const float guiding_weight = 1 / w.roulette_scale;
    if (guiding_weight <= high && w.depth < limits_.roulette_depth) return true;
    if (w.expected < 0) {
      w.expected = w.least / least_part * expected_behind(vertex(w, w.reference));
    }
    if (!(w.expected > 0)) return true;
    const float ratio = carried * expected_behind(v) / w.expected;
    w.windowed = true;
    if (ratio < low && w.depth >= limits_.roulette_depth) {
      return survive(w, std::max(ratio / low, min_survival));
    } else {
      // Splitting undoes what the guide has added to the weight, and no more: to split all paths
      // that come into the light costs more time than it saves noise.
      const float excess = std::min({ratio, guiding_weight, float{max_parts}});
      if (excess > high && carried > w.least) {
        split(w, v, static_cast<int>(std::lround(excess)), walk);
      }
    }
    return true;
  }

  /// The luminance that a path of throughput 1 adds behind `v`; where that is unknown, as it is of
  /// all light paths, as if it were equal everywhere.
  float expected_behind(const Vertex& v) const {
    const float known = limits_.transport == Transport::radiance ? guide_.expected(v) : -1;
    return known < 0 ? 1 : known;
  }

  /// The path itself keeps one of the parts.
  void split(PathState& w, const Vertex& v, int parts, std::size_t walk) {
    if (w.depth < limits_.split_depth) return;
    const float share = 1.0F / static_cast<float>(parts);
    w.throughput *= share;
    w.roulette_scale *= static_cast<float>(parts);
    w.carried = luminance(w.throughput);
    for (int k = 1; k < parts; ++k) {
      PathBranch& b = branches_.emplace_back();
      b.state = w;
      b.state.rng = w.rng.branch();
      b.state.split = 1;
      b.vertex = v;
      b.vertex.throughput *= share;
      b.walk = walk;
    }
    w.split *= static_cast<float>(parts);
  }

  /// Samples the next edge; false where the walk ends.
  bool sample_next(PathState& w) {
    const int depth = w.depth;
    Vertex& v = vertex(w, depth);
    w.rng.next_vertex();
    const std::optional<BsdfSample> next = guide_.sample(v, w.rng, limits_.transport);
    if (!next) return false;
    w.throughput *= next->weight;
    w.roulette_scale *= next->pdf_ratio;
    if (depth >= limits_.roulette_depth && !w.windowed) {
      const float survival =
          std::min(1.0F, w.carried_before * max_component(w.throughput) * w.roulette_scale);
      if (!w.rng.decide(survival)) return false;
      w.throughput /= survival;
    }
    v.delta = next->delta;
    // Deltas cancel in all ratios of densities, if both walks leave them out.
    w.p = next->delta ? Pdf<SolidAngle>(1.0F) : next->pdf;
    if (tracked_) w.mis_partial = mis_partial(v, depth, next->wi);
    w.ray = {offset_origin(v.surface.x, v.surface.ng, v.surface.offset, next->wi), next->wi};
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
    const TechniqueCounts counts = limits_.counts.with_one(double(v.next_event_ratio));
    return (mis_partial_sum(counts, depth, connectible, pdf_rev, v.mis_partial) +
            merge_partial(limits_.counts, depth, v.connectible(), double(v.p_fwd.value))) /
           double(v.p_fwd.value);
  }

  // The throughputs of all parts of a path sum to at most its own, on average. A least part
  // therefore bounds their number, and the time that wrong expectations cost.
  static constexpr float least_part = 1.0F / 64;

  const Scene& scene_;
  const Guide& guide_;
  WalkLimits limits_;
  bool tracked_ = limits_.counts.any();
  Counters& counters_;
  std::vector<std::size_t> active_;
  std::vector<PathBranch> branches_;
};

}  // namespace lacuna
