#pragma once

#include <array>

#include "renderer/path/eye_batch.h"
#include "renderer/path/next_event.h"

namespace lacuna {

/// Selects the emitters of next event estimation for the vertices of a batch of eye paths; stores
/// one for the last vertex of each path. It is the `selection` of Walk::trace_paths().
class EmitterSelection {
 public:
  /// Selects for vertices fewer than `max_depth` edges from the eye; for none unless `active`.
  EmitterSelection(const NextEvent& next_event, bool active, int max_depth, EyeBatch& batch)
      : next_event_(next_event), active_(active), max_depth_(max_depth), batch_(batch) {}

  /// Called before the ray to vertex `depth` of path `i` is traced. Selects if the selection does
  /// not depend on the vertex.
  void before(std::size_t i, int depth) {
    if (active_ && depth < max_depth_) {
      selected_[i] = next_event_.preselect(batch_.states[i].rng);
    }
  }

  /// Whether the selection depends on the vertex. Then choose() descends the light tree for many
  /// vertices at once, which hides the latency of memory.
  bool together() const { return active_ && next_event_.for_each_vertex(); }
  /// Selects for the last vertices of `paths`.
  void choose(std::span<const std::size_t> paths) {
    std::size_t n = 0;
    for (const std::size_t i : paths) {
      PathState& state = batch_.states[i];
      const Vertex& v = batch_.vertex(i, state.depth);
      if (state.depth >= max_depth_ || v.kind != Vertex::Kind::surface || !v.bsdf->connectible()) {
        continue;
      }
      requests_[n].receiver = receiver_at(v);
      requests_[n].rng = &state.rng;
      path_of_[n++] = i;
    }
    next_event_.choose(std::span(requests_).first(n));
    for (std::size_t k = 0; k < n; ++k) {
      NextEvent::set(selected_[path_of_[k]], requests_[k].result);
    }
  }

  /// The emitter for the last vertex of path `i`.
  const NextEvent::Preselected& of(std::size_t i) const { return selected_[i]; }

 private:
  const NextEvent& next_event_;
  bool active_;
  int max_depth_;
  EyeBatch& batch_;
  std::array<NextEvent::Preselected, EyeBatch::size> selected_{};
  // A member, so that it is initialised once and not at each vertex.
  std::array<PointwiseSelection::Request, EyeBatch::size> requests_;
  std::array<std::size_t, EyeBatch::size> path_of_{};
};

}  // namespace lacuna
