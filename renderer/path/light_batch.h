#pragma once

#include <array>

#include "renderer/path/connect.h"
#include "renderer/path/merge.h"
#include "renderer/path/next_event.h"
#include "renderer/path/path_matches.h"
#include "renderer/path/path_observer.h"
#include "renderer/path/shadow_queue.h"
#include "renderer/path/splats.h"
#include "renderer/path/walk.h"

namespace lacuna {

/// The scene, camera and limits that light paths are traced with.
struct LightPathSetting {
  const Scene& scene;
  const Camera& camera;
  int max_depth;       ///< edges of whole paths, the one to the eye included
  int roulette_depth;  ///< WalkLimits::roulette_depth
  SampleCounts counts;
  /// Select the emitters of an iteration's paths by systematic sampling: at equal steps from a
  /// random start. Each path alone has the same distribution; together they are stratified.
  bool spread = false;
  /// How next event estimation (s = 1) selects emitters. Used if counts.nee > 0.
  EmitterChoice next_event = EmitterChoice::power;
  const PathAutomaton* letters = nullptr;  ///< WalkLimits::letters
  PathObserver* observer = nullptr;        ///< IterationContext::observer, of splats
  std::uint64_t iteration = 0;             ///< for the observer
};

/// At most `size` light paths that are traced together; path i has index i throughout. Guided paths
/// may be split (Roulette): each branch has an index of its own, >= `size`, and shares its first
/// vertices with the path that was split.
class LightBatch {
 public:
  static constexpr int size = 64;  // their vertices fit the second-level cache

  LightBatch(const LightPathSetting& setting, const Guide& guide);

  /// Traces one path for each generator. Without emitters, paths have length 0. `choices`: 32
  /// uniform bits for each path, which select its emitter; empty: taken from `rngs`. `wanted`: the
  /// largest number of vertices of each path, >= 1; empty: LightPathSetting::max_depth.
  void walk(std::span<const Rng> rngs, Counters& counters,
            std::span<const std::uint32_t> choices = {}, std::span<const int> wanted = {});
  /// Removes all branches. Call before restore() of the paths of a batch.
  void clear();

  /// Restores path `i` and its branches from the photons of their vertices, in the order of
  /// for_each_vertex(), and the hit() of each. Vertices without a photon become vertices that are
  /// not connectible. Vertex 0 does not change.
  void restore(std::size_t i, std::span<const Photon> photons, std::span<const Hit> hits);

  /// Number of vertices of path `i`, including the one on the emitter.
  int length(std::size_t i) const { return i < size ? length_[i] : branch(i).length; }
  /// The first vertex that a branch does not share with the path that was split; 1 if `i` is none.
  int first(std::size_t i) const { return i < size ? 1 : branch(i).first; }
  /// Calls `use(j)` for path `i` < size and for all its branches; each branch follows the path that
  /// was split.
  template <class Use>
  void for_each_branch(std::size_t i, Use&& use) const {
    use(i);
    for (const std::size_t j : branches_of_[i]) use(j);
  }
  /// Calls `use(j, index)` for all vertices but vertex 0 of path `i` < size and its branches.
  template <class Use>
  void for_each_vertex(std::size_t i, Use&& use) const {
    for_each_branch(i, [&](std::size_t j) {
      for (int index = first(j); index < length(j); ++index) use(j, index);
    });
  }
  /// Vertex 0, on an emitter.
  const EmitterPoint& emitter(std::size_t i) const { return emitters_[i]; }
  /// Vertex `index` in [1, length(i)).
  const Vertex& vertex(std::size_t i, int index) const {
    if (i < size) return vertices_[i * places_ + static_cast<std::size_t>(index)];
    const Branch& b = branch(i);
    // The last vertex that is shared is stored twice: `delta` differs.
    if (index + 1 < b.first) return vertex(b.parent, index);
    return b.vertices[static_cast<std::size_t>(index + 1 - b.first)];
  }
  bool connectible(std::size_t i, int index) const {
    const std::optional<Bsdf>& bsdf = vertex(i, index).bsdf;
    return bsdf && bsdf->connectible();
  }
  /// The hit of the ray to vertex `index` >= first(i).
  const Hit& hit(std::size_t i, int index) const {
    if (i < size) return hits_[i * places_ + static_cast<std::size_t>(index)];
    return branch(i).hits[static_cast<std::size_t>(index + 1 - branch(i).first)];
  }
  SurfaceEndpoint end(std::size_t i, int index) const {
    return {vertex(i, index), index, Transport::importance, guide_};
  }

  /// Connects all vertices of the first `paths` paths to the eye (t = 1) and appends the unoccluded
  /// contributions to `splats`.
  void splat(std::size_t paths, Counters& counters, Splats& splats);

  /// A contribution to the eye, pending its shadow ray.
  struct UnshadowedSplat {
    Rgb value;     ///< divided by the number of samples of t = 1
    float weight;  ///< MIS
    V2f at;        ///< position on the film, in pixels
    std::uint16_t s;
    PathMatches matches;
    std::uint32_t traced = 0;  ///< number of the path in the observer; 0: none
  };
  /// The vertices 0 to `last` of path `i`, for a PathObserver.
  std::vector<const Vertex*> path_to(std::size_t i, int last) const;
  /// Connects vertex `index` in [0, length(i)) of path `i` to the eye (t = 1) and calls `use(ray,
  /// splat)` if the unoccluded contribution is not black.
  template <class Use>
  void connect_to_eye(std::size_t i, int index, Use&& use) const {
    const V2f& lens = lens_[i < size ? i : branch(i).origin];
    if (index == 0) {
      if (!emitters_[i].delta()) connect_to_eye(EmitterEndpoint{emitters_[i], guide_}, lens, use);
    } else if (connectible(i, index)) {
      connect_to_eye(end(i, index), lens, use);
    }
  }

 private:
  /// Shows the observer a splat before its shadow ray `ray` is traced; 0 if it is of other pixels.
  std::uint32_t observe(std::size_t i, int last, const Ray& ray,
                        const UnshadowedSplat& splat) const;

  struct Branch {
    std::size_t parent, origin;    ///< the path that was split; the path that walk() started
    int first, length;             ///< as first() and length()
    std::vector<Vertex> vertices;  ///< from first - 1 on
    std::vector<Hit> hits;         ///< of each vertex
  };
  const Branch& branch(std::size_t i) const { return branches_[i - size]; }
  std::size_t add_branch(std::size_t parent, int first);

  Vertex& vertex_to_set(std::size_t i, int index) {
    return vertices_[i * places_ + static_cast<std::size_t>(index)];
  }
  /// Appends vertex `index` to path `i`; fills the gap before it with vertices that are not
  /// connectible.
  Vertex& append(std::size_t i, int index);

  /// Traces the branches of all paths, and the branches of branches, at most `size` at a time.
  void trace_branches(Walk& walk);

  /// Sets Vertex::next_event_ratio of vertex 1 of path `i`.
  void set_ratio(std::size_t i);

  /// Samples vertex 0 of path `i` by `at`; false if the scene has no emitters.
  bool start(std::size_t i, const Rng::FinePoint& at);

  /// Makes vertex 0 of path `i` its emitter, with its density.
  void place(std::size_t i);

  /// Samples the first edge of path `i` and adds its state to states_.
  void start_walk(std::size_t i, Rng& rng);

  template <class End, class Use>
  void connect_to_eye(const End& light, const V2f& lens, Use& use) const {
    const Camera& camera = setting_.camera;
    // Two directions from infinity do not meet.
    if (camera.parallel() && at_infinity(light)) return;
    const EyeEndpoint eye{camera, camera.eye(light.x(), lens)};
    const V3f to = at_infinity(light) ? light.x() : light.x() - eye.x();
    const std::optional<V2f> at = camera.project(eye.x(), to.normalized());
    if (!at) return;
    const Connection c = connect(eye, light);
    if (!c) return;
    use(shadow_ray(eye, light, c),
        UnshadowedSplat{c.contribution / static_cast<float>(setting_.counts.splat),
                        static_cast<float>(weight(eye, light, c, setting_.counts)), *at,
                        static_cast<std::uint16_t>(light.index + 1),
                        matches_between(setting_.letters, eye, light, c.w)});
  }

  const LightPathSetting& setting_;
  const Guide& guide_;
  std::size_t places_;
  NextEvent next_event_;
  std::vector<Vertex> vertices_;
  std::vector<Hit> hits_;  // of each vertex
  std::vector<Branch> branches_;
  std::array<std::vector<std::size_t>, size> branches_of_;  // of each path, their indices
  std::vector<Vertex> traced_;                              // of branches while they are traced
  std::vector<Hit> traced_hits_;                            // of each vertex
  std::vector<PathState> states_;
  std::array<std::size_t, size> path_of_{};  // of each state in states_, its path's index
  std::array<int, size> length_{};
  std::array<EmitterPoint, size> emitters_{};
  std::array<V2f, size> lens_{};  // where each path that walk() started may meet the lens
  ShadowQueue<UnshadowedSplat> queue_;
};

}  // namespace lacuna
