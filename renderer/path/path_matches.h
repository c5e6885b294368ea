#pragma once

#include "renderer/path/endpoints.h"
#include "renderer/path/path_letters.h"

namespace lacuna {

/// The state of the automaton after an endpoint of a connection in unit direction `w`, which points
/// away from it.
inline PathAutomaton::State state_after(const PathAutomaton& automaton, const SurfaceEndpoint& end,
                                        const V3f& w) {
  const Vertex& v = end.v;
  const bool from_eye = end.transport == Transport::radiance;
  const PathSymbol letter = letter_at(v, from_eye ? v.wp : w, from_eye ? w : v.wp, false);
  return automaton.step(v.letters, letter, end.transport);
}
/// The same of an emitter or the eye, where a walk begins.
template <class End>
PathAutomaton::State state_after(const PathAutomaton&, const End&, const V3f&) {
  return 0;
}

/// The expressions that match the path that two endpoints make, with unit direction `w` from the
/// eye's to the light's; none without an automaton.
template <class Eye, class Light>
PathMatches matches_between(const PathAutomaton* automaton, const Eye& eye, const Light& light,
                            const V3f& w) {
  if (automaton == nullptr) return 0;
  return automaton->matches(state_after(*automaton, eye, w), state_after(*automaton, light, -w));
}

/// The same if the eye path ends on an emitter at vertex `v`.
inline PathMatches matches_at_hit(const PathAutomaton* automaton, const Vertex& v) {
  return automaton != nullptr ? automaton->matches(v.letters, 0) : PathMatches{0};
}

/// The same if the eye path goes on along unit `w` to an emitter; or to vertices with the letters
/// `light`, read from there.
inline PathMatches matches_beyond(const PathAutomaton* automaton, const SurfaceEndpoint& eye,
                                  const V3f& w, PathAutomaton::State light = 0) {
  if (automaton == nullptr) return 0;
  return automaton->matches(state_after(*automaton, eye, w), light);
}

}  // namespace lacuna
