#pragma once

#include <array>
#include <cmath>
#include <numeric>
#include <span>
#include <vector>

#include "renderer/core/rng.h"
#include "renderer/path/counters.h"
#include "renderer/path/mis.h"
#include "renderer/path/path_letters.h"
#include "renderer/path/roulette.h"
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
  /// Sets Vertex::letters; null: they stay as they are.
  const PathAutomaton* letters = nullptr;
};

/// One part of a path that was split at its last vertex. It continues from there on its own.
struct PathBranch {
  PathState state{.rng = Rng(0, 0, 0), .ray = {}, .p = {}, .path = {}};
  Vertex vertex;         ///< the last one, with the throughput of the branch
  std::size_t walk = 0;  ///< index of the path that was split
};

/// A `selection` of Walk::trace_paths() that does nothing.
struct NoSelection {
  static void before(std::size_t, int) {}
  static constexpr bool together() { return false; }
  static void choose(std::span<const std::size_t>) {}
};

/// Traces a batch of random walks through a scene, one edge of each at a time: the data of a vertex
/// are prefetched while the rays of the other walks are traced, which is faster if the scene is
/// larger than the caches. The guide (renderer/guides) samples the directions. The walks are
/// independent: the results do not depend on the size of the batch.
class Walk {
 public:
  Walk(const Scene& scene, const Guide& guide, const WalkLimits& limits, Counters& counters)
      : scene_(scene),
        guide_(guide),
        limits_(limits),
        roulette_(guide, {limits.roulette_depth, limits.split_depth, limits.transport}),
        counters_(counters) {}
  virtual ~Walk() = default;

  /// Stores each vertex in its path and calls `visit(i, depth)`, with i the index of the path and
  /// depth the number of its edges, before the next direction is sampled. The densities of all
  /// vertices are per area. A `visit` that returns false ends its walk. A state whose depth is
  /// above 0 is a branch: it continues at its last vertex. New branches are appended to branches().
  ///
  /// `selection` prepares what `visit` needs of a vertex, as EmitterSelection does.
  /// `selection.before(i, depth)` is called before the ray to that vertex is traced. If
  /// `selection.together()`, `selection.choose(paths)` is called once for the vertices of all
  /// `paths`, before they are visited.
  template <class Visit, class Selection = NoSelection>
  void trace_paths(std::span<PathState> states, Visit&& visit, Selection&& selection = {}) {
    active_.resize(states.size());
    hits_.resize(states.size());
    std::iota(active_.begin(), active_.end(), std::size_t{0});
    std::erase_if(active_,
                  [&](std::size_t i) { return states[i].depth > 0 && !sample_next(states[i]); });
    bool packets = limits_.packets && !states.empty() && states[0].depth == 0;
    while (!active_.empty()) {
      for (const std::size_t i : active_) {
        const int depth = ++states[i].depth;
        selection.before(i, depth);
        if (!packets) trace(states[i], hits_[i]);
      }
      if (packets) trace_first(states);
      packets = false;
      for (const std::size_t i : active_) on_hit(states[i], hits_[i]);
      const bool at_once = selection.together();
      if (at_once) {
        for (const std::size_t i : active_) scatter(states[i], states[i].depth);
        selection.choose(active_);
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

  /// Where the last ray of path `i` hit.
  const Hit& hit(std::size_t i) const { return hits_[i]; }
  /// The branches of the paths so far, in a fixed order. The caller removes and traces them.
  std::vector<PathBranch>& branches() { return branches_; }

 protected:
  /// The next direction of a path from its last vertex. Tests override it.
  virtual std::optional<BsdfSample> sample(const Vertex& v, Rng& rng) const {
    return guide_.sample(v, rng, limits_.transport);
  }

 private:
  static Vertex& vertex(PathState& w, int depth) { return w.path[static_cast<std::size_t>(depth)]; }

  void trace(PathState& w, Hit& hit) {
    ++counters_.rays;
    const bool is_hit = scene_.rays().intersect(w.ray, hit);
    vertex(w, w.depth).kind = is_hit ? Vertex::Kind::surface : Vertex::Kind::background;
    if (is_hit) scene_.prefetch(hit);
  }

  /// trace() for all first edges, in packets of eight. If a ray hits two triangles at the same
  /// distance, which of them is found may depend on the packet: the rays of a packet must not
  /// depend on threads or tiles.
  void trace_first(std::span<PathState> states) {
    constexpr std::size_t together = 8;
    std::array<Ray, together> rays;
    std::array<std::uint8_t, together> is_hit{};
    counters_.rays += states.size();
    for (std::size_t first = 0; first < states.size(); first += together) {
      const std::span<PathState> some =
          states.subspan(first, std::min(together, states.size() - first));
      for (std::size_t k = 0; k < some.size(); ++k) rays[k] = some[k].ray;
      const std::span<Hit> hits = std::span(hits_).subspan(first, some.size());
      scene_.rays().intersect(std::span(rays).first(some.size()), hits, is_hit);
      for (std::size_t k = 0; k < some.size(); ++k) {
        vertex(some[k], 1).kind = is_hit[k] != 0 ? Vertex::Kind::surface : Vertex::Kind::background;
        if (is_hit[k] == 0) continue;
        scene_.prefetch(hits[k]);
      }
    }
  }

  // Flattened: called at every vertex, and GCC no longer inlines all of it by itself.
  [[gnu::flatten]] void on_hit(PathState& w, const Hit& hit) {
    const int depth = w.depth;
    Vertex& v = vertex(w, depth);
    v.delta = false;
    v.next_event_ratio = 1;
    v.wp = -w.ray.d;
    v.throughput = w.throughput;
    if (v.kind == Vertex::Kind::background) {
      v.surface.x = w.ray.d;
    } else {
      v.surface = scene_.surface(w.ray, hit);
      if (scatters(depth)) {
        scene_.prefetch_bsdf(v.surface);
        guide_.prefetch(v);
      }
    }
    const Vertex& before = vertex(w, depth - 1);
    if (scene_.has_media()) absorb(w, before, v);
    v.p_fwd = to_area(w.p, before, w.ray.d, v);
    if (w.mis_partial > 0) {
      v.mis_partial = w.mis_partial * double(to_area(Pdf<SolidAngle>(1.0F), v, v.wp, before).value);
    } else {
      v.mis_partial = 0;
    }
    v.prev_connectible = before.connectible();
    if (limits_.letters != nullptr) [[unlikely]]
      read_letter(before, w.ray.d, v);
  }

  /// Reads the letter of vertex `before`, which the walk left along `wi` to `v`.
  [[gnu::noinline, gnu::cold]] void read_letter(const Vertex& before, const V3f& wi,
                                                Vertex& v) const {
    v.letters = 0;
    if (before.kind != Vertex::Kind::surface) return;
    const bool from_eye = limits_.transport == Transport::radiance;
    const PathSymbol letter =
        letter_at(before, from_eye ? before.wp : wi, from_eye ? wi : before.wp, before.delta);
    v.letters = limits_.letters->step(before.letters, letter, limits_.transport);
  }

  /// Absorption along the edge from `before` to `v`. Not inline: on_hit() is, and few scenes
  /// absorb.
  [[gnu::noinline, gnu::cold]] void absorb(PathState& w, const Vertex& before, Vertex& v) const {
    // Emitters at infinity: their light comes from there. The eye of a parallel projection does
    // not.
    const bool from_infinity =
        before.kind == Vertex::Kind::background && limits_.transport == Transport::importance;
    const bool infinite = from_infinity || v.kind == Vertex::Kind::background;
    const auto medium = [&](const Vertex& at, const V3f& along) {
      return at.kind == Vertex::Kind::surface ? scene_.medium(at.surface, along) : nullptr;
    };
    w.throughput *= transmittance(medium(before, w.ray.d), medium(v, v.wp),
                                  infinite ? infinite_distance : (v.surface.x - w.ray.o).length());
    v.throughput = w.throughput;
  }

  bool scatters(int depth) const { return limits_.last_scatters || depth < limits_.max_depth; }

  void scatter(PathState& w, int depth) {
    Vertex& v = vertex(w, depth);
    if (v.kind == Vertex::Kind::background || !scatters(depth)) return;
    scene_.make_bsdf(v.surface, v.bsdf);
    guide_.on_hit(v);
  }

  /// False if the walk ends before a direction is sampled. May split the path.
  bool continues(PathState& w, std::size_t walk) {
    const Vertex& v = vertex(w, w.depth);
    if (v.kind == Vertex::Kind::background || w.depth == limits_.max_depth) return false;
    const int parts = roulette_.parts(w, v);
    if (parts > 1) split(w, v, parts, walk);
    return parts > 0;
  }

  /// Splits the path in `parts`: it continues as one of them, the others become branches.
  void split(PathState& w, const Vertex& v, int parts, std::size_t walk) {
    const float share = 1.0F / static_cast<float>(parts);
    w.throughput *= share;
    w.roulette.scale *= static_cast<float>(parts);
    for (int k = 1; k < parts; ++k) {
      PathBranch& b = branches_.emplace_back();
      b.state = w;
      b.state.rng = w.rng.branch();
      b.state.roulette.split = 1;
      b.vertex = v;
      b.vertex.throughput *= share;
      b.walk = walk;
    }
    w.roulette.split *= static_cast<float>(parts);
  }

  /// Samples the next edge; false if the walk ends.
  [[gnu::flatten]] bool sample_next(PathState& w) {
    const int depth = w.depth;
    Vertex& v = vertex(w, depth);
    w.rng.next_vertex();
    const std::optional<BsdfSample> next = sample(v, w.rng);
    if (!next) return false;
    w.throughput *= next->weight;
    w.roulette.scale *= next->pdf_ratio;
    if (!roulette_.survives(w)) return false;
    v.delta = next->delta;
    // The delta functions cancel in all ratios of densities: both walks use density 1 instead.
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

  const Scene& scene_;
  const Guide& guide_;
  WalkLimits limits_;
  Roulette roulette_;
  bool tracked_ = limits_.counts.any();
  Counters& counters_;
  std::vector<std::size_t> active_;
  std::vector<Hit> hits_;  // of each path's last ray
  std::vector<PathBranch> branches_;
};

}  // namespace lacuna
