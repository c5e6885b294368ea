#pragma once

#include "renderer/path/vertex.h"
#include "renderer/settings/path_expression.h"

namespace lacuna {

/// The letter of surface vertex `v`, at which light arrives from `to_light` and leaves to `to_eye`,
/// both unit. S: `by_delta`, through a delta lobe. Else D or G: by which of the other lobes scatter
/// more of this light (Bsdf::mostly_diffuse()).
inline PathSymbol letter_at(const Vertex& v, const V3f& to_eye, const V3f& to_light,
                            bool by_delta) {
  const int kind = by_delta ? 2 : v.bsdf->mostly_diffuse(to_eye, to_light) ? 0 : 1;
  const bool crosses = (dot(v.surface.ng, to_eye) > 0) != (dot(v.surface.ng, to_light) > 0);
  return static_cast<PathSymbol>(2 * kind + (crosses ? 1 : 0));
}

/// Which of some path expressions match a path: a bit for each.
using PathMatches = TwoSidedAutomaton::Matches;

/// Some path expressions as one automaton, whose state is one byte that a walk carries. A walk from
/// the eye reads the letters of its vertices forward, a walk from a light backward. State 0 of each
/// direction is that of its first vertex, at the eye or on an emitter.
class PathAutomaton : public TwoSidedAutomaton {
 public:
  explicit PathAutomaton(std::span<const PathExpression> expressions)
      : TwoSidedAutomaton(path_automaton(expressions)) {}

  State step(State s, PathSymbol letter, Transport transport) const {
    const int symbol = static_cast<int>(letter);
    return transport == Transport::radiance ? forward(s, symbol) : backward(s, symbol);
  }
};

}  // namespace lacuna
