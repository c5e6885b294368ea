#pragma once

namespace lacuna {

// Multiple importance sampling over all ways (s, t) to make one path x_0 ... x_k, x_0 on the
// emitter and x_k at the eye: its first s vertices walked from the light, the other t = k + 1 - s
// from the eye, and x_{s-1}, x_s joined. Balance heuristic with the number of samples of each
// strategy (Veach 1997, 9.2.2; Noel 2015, 4.3, 11.5). p_i / p_s is a product of ratios of the two
// densities of each vertex between, so the sum over i < s follows from what a walk from the light
// carries along, and the sum over i > s from what a walk from the eye does (van Antwerpen 2011):
//
//   sum_{i <= j} n_i p_i / p_{j+1} = (g_j / p_j) (n_j c_j + sum_{i < j} n_i p_i / p_j)
//
// with p_j the density of vertex j on its walk, g_j the one from the other end, and c_j whether
// x_{j-1} and x_j can be joined: neither scatters through a delta lobe only.

/// How many samples a picture's pixel takes of each strategy. 0: not used.
struct SampleCounts {
  double hit = 1;      ///< s = 0: the eye's path meets an emitter
  double nee = 0;      ///< s = 1, t >= 2: next event estimation
  double connect = 0;  ///< s >= 2, t >= 2
  double splat = 0;    ///< s >= 1, t = 1: a light's path joined to the eye

  /// Whether paths from lights are longer than one vertex.
  constexpr bool bidirectional() const { return connect > 0 || splat > 0; }
  constexpr double of(int s, int t) const {
    if (s == 0) return hit;
    if (t == 1) return splat;
    return s == 1 ? nee : connect;
  }
};

/// The counts as one end of a path sees them: of the strategy that leaves it `vertices` vertices.
struct TechniqueCounts {
  double none = 0, one = 0, more = 0;
  constexpr bool any() const { return none > 0 || one > 0 || more > 0; }
  constexpr double of(int vertices) const {
    return vertices == 0 ? none : vertices == 1 ? one : more;
  }
};
constexpr TechniqueCounts light_side(const SampleCounts& n) { return {n.hit, n.nee, n.connect}; }
/// The eye is a point that nothing hits: no strategy leaves it without a vertex.
constexpr TechniqueCounts eye_side(const SampleCounts& n) { return {0, n.splat, n.connect}; }

/// n_j c_j + sum_{i < j} n_i p_i / p_j at vertex `j` of a walk: `connectible` is c_j, `pdf_rev` the
/// density, per steradian, with which the other end's walk goes on from j to j - 1, and
/// `mis_partial` what the walk knew when it arrived (Walk).
constexpr double mis_partial_sum(const TechniqueCounts& side, int j, bool connectible,
                                 double pdf_rev, double mis_partial) {
  return (connectible ? side.of(j) : 0.0) + pdf_rev * mis_partial;
}

/// The balance heuristic: share of the strategy with `own` samples, where the others' densities
/// over its own, times their samples, add up to `light` and `eye`.
constexpr double mis_weight(double own, double light, double eye) {
  return own / (own + light + eye);
}

}  // namespace lacuna
