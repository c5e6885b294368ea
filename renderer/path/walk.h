#pragma once

#include <numeric>
#include <optional>
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
  virtual std::optional<BsdfSample> sample(const Vertex& v, Rng& rng) const;

 private:
  static Vertex& vertex(PathState& w, int depth) { return w.path[static_cast<std::size_t>(depth)]; }

  void trace(PathState& w, Hit& hit);
  /// trace() for all first edges, in packets of eight. If a ray hits two triangles at the same
  /// distance, which of them is found may depend on the packet: the rays of a packet must not
  /// depend on threads or tiles.
  void trace_first(std::span<PathState> states);
  void on_hit(PathState& w, const Hit& hit);
  /// Reads the letter of vertex `before`, which the walk left along `wi` to `v`.
  void read_letter(const Vertex& before, const V3f& wi, Vertex& v) const;
  /// Absorption along the edge from `before` to `v`.
  void absorb(PathState& w, const Vertex& before, Vertex& v) const;
  bool scatters(int depth) const { return limits_.last_scatters || depth < limits_.max_depth; }

  void scatter(PathState& w, int depth);
  /// False if the walk ends before a direction is sampled. May split the path.
  bool continues(PathState& w, std::size_t walk);
  /// Splits the path in `parts`: it continues as one of them, the others become branches.
  void split(PathState& w, const Vertex& v, int parts, std::size_t walk);
  /// Samples the next edge; false if the walk ends.
  bool sample_next(PathState& w);
  double mis_partial(const Vertex& v, int depth, const V3f& wi) const;

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
