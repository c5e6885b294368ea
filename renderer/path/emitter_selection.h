#pragma once

#include <array>

#include "renderer/path/eye_batch.h"
#include "renderer/path/next_event.h"

namespace lacuna {

/// The emitters that next event estimation selects for the vertices of a batch of eye paths, one at
/// a time for each path: a selection of Walk::trace_paths().
class EmitterSelection {
 public:
  /// Selects for vertices of fewer than `max_depth` edges; for none without `active`.
  EmitterSelection(const NextEvent& next_event, bool active, int max_depth, EyeBatch& batch)
      : next_event_(next_event), active_(active), max_depth_(max_depth), batch_(batch) {}

  /// Before the ray to vertex `depth` of path `i` is traced: selects, if the selection does not
  /// depend on the vertex.
  void before(std::size_t i, int depth) {
    if (active_ && depth < max_depth_) {
      selected_[i] = next_event_.preselect(batch_.states[i].rng);
    }
  }

  /// Whether each vertex has a selection of its own. Descents through a light tree wait for memory:
  /// those of many vertices wait together.
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
  // Here, so that they are initialised once for a batch and not at each of its vertices.
  std::array<PointwiseSelection::Request, EyeBatch::size> requests_;
  std::array<std::size_t, EyeBatch::size> path_of_{};
};

}  // namespace lacuna
