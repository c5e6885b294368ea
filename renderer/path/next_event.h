#pragma once

#include <span>

#include "renderer/path/vertex.h"
#include "renderer/scene/scene.h"
#include "renderer/settings/emitter_settings.h"

namespace lacuna {

/// The light tree's receiver for a surface vertex. The eye path and the light path of one whole
/// path give the same: an opaque surface scatters only to the side from which light arrives.
[[gnu::always_inline]] inline Receiver receiver_at(const Vertex& v) {
  // At grazing angles to ng, the cosine with an interpolated normal may be large.
  constexpr float flat = 0x1p-10F, curved = 0.125F;
  return {v.surface.x, v.side(), v.bsdf->transmits(), v.surface.ns == v.surface.ng ? flat : curved};
}

/// Samples points on emitters for next event estimation (s = 1).
class NextEvent {
 public:
  /// Selects emitters by the light tree, if `choice` asks for it and the scene has one
  /// (SceneNeeds::light_tree); else by power.
  NextEvent(const Scene& scene, EmitterChoice choice)
      : emitters_(scene.emitters()), pointwise_(by_tree(emitters_, choice)) {}

  /// Whether the selection depends on the vertex (light tree).
  bool for_each_vertex() const { return pointwise_ != nullptr; }
  /// An emitter that was selected before the point on it is sampled; `none` if it was not.
  struct Preselected {
    EmitterSet::Selected selected{.entry = none};
    float ratio = 1;  ///< EmitterPoint::next_event_ratio
  };
  /// Selects an emitter before the ray to the vertex is traced, if the selection does not depend on
  /// the vertex; else none. Requires emitters.
  Preselected preselect(Rng& rng) const {
    return pointwise_ == nullptr ? Preselected{emitters_.choose(rng)} : Preselected{};
  }
  /// Copies member by member: to load the whole of what was just stored in parts would stall.
  static void set(Preselected& preselected, const PointwiseSelection::Choice& c) {
    preselected.selected.entry = c.entry;
    preselected.selected.at.x = c.at.x;
    preselected.selected.at.y = c.at.y;
    preselected.selected.at.u_select = c.at.u_select;
    preselected.ratio = c.ratio;
  }
  /// Selects for many receivers at once.
  void choose(std::span<PointwiseSelection::Request> requests) const {
    pointwise_->choose(requests);
    for (const PointwiseSelection::Request& r : requests) emitters_.prefetch(r.result.entry);
  }
  /// Samples a point on an emitter for the connectible vertex `v`: on `preselected`, unless that is
  /// none.
  EmitterPoint sample(const Vertex& v, Preselected preselected, Rng& rng) const {
    if (preselected.selected.entry == none) {
      const Rng::FinePoint at = rng.next_fine_point();
      set(preselected, pointwise_->choose(receiver_at(v), at, rng));
    }
    EmitterPoint e = emitters_.sample(preselected.selected);
    e.next_event_ratio = preselected.ratio;
    return e;
  }
  /// EmitterPoint::next_event_ratio of the point `e`, which another technique sampled, for the
  /// connectible surface vertex `v`.
  float ratio(const EmitterPoint& e, const Vertex& v) const {
    if (pointwise_ == nullptr || !e.pdf.positive()) return 1;
    return pointwise_->ratio(e.entry, receiver_at(v));
  }
  /// Sets next_event_ratio of the point `e` that an eye path hit at `v`, `depth` edges from the
  /// eye, if the path's MIS weight depends on it. `before` is the vertex before `v`.
  void set_ratio(EmitterPoint& e, const Vertex& v, const Vertex& before, int depth) const {
    if (depth > 1 && v.prev_connectible) e.next_event_ratio = ratio(e, before);
  }

 private:
  static constexpr std::uint32_t none = ~0U;
  static const PointwiseSelection* by_tree(const EmitterSet& emitters, EmitterChoice choice) {
    constexpr std::size_t few = 8;
    const PointwiseSelection* p = emitters.pointwise();
    if (p == nullptr || choice == EmitterChoice::power) return nullptr;
    return choice == EmitterChoice::tree || p->finite() > few ? p : nullptr;
  }

  const EmitterSet& emitters_;
  const PointwiseSelection* pointwise_;  // null: by power
};

}  // namespace lacuna
