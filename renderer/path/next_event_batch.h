#pragma once

#include <array>

#include "renderer/path/eye_batch.h"
#include "renderer/path/next_event.h"

namespace lacuna {

/// The emitters that next event estimation has selected for the paths of a batch.
using EmittersAhead = std::array<NextEvent::Ahead, EyeBatch::size>;

/// Selects emitters for the vertices of a batch of eye paths at once (Walk::trace_paths()), where
/// each vertex has its own selection: descents through a light tree wait for memory, and many
/// descents wait together.
class SelectTogether {
 public:
  /// Selects for vertices of fewer than `max_depth` edges; for none without `active`.
  SelectTogether(const NextEvent& next_event, bool active, int max_depth, EyeBatch& batch,
                 EmittersAhead& ahead)
      : next_event_(next_event),
        active_(active && next_event.for_each_vertex()),
        max_depth_(max_depth),
        batch_(batch),
        ahead_(ahead) {}

  bool wanted() const { return active_; }
  void operator()(std::span<const std::size_t> paths) {
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
      NextEvent::set(ahead_[path_of_[k]], requests_[k].result);
    }
  }

 private:
  const NextEvent& next_event_;
  bool active_;
  int max_depth_;
  EyeBatch& batch_;
  EmittersAhead& ahead_;
  // Here, so that they are initialised once for a batch and not at each of its vertices.
  std::array<PointwiseSelection::Request, EyeBatch::size> requests_;
  std::array<std::size_t, EyeBatch::size> path_of_{};
};

}  // namespace lacuna
