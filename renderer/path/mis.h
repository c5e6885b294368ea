#pragma once

namespace lacuna {

// Multiple importance sampling over all strategies (s, t) that sample one path x_0 ... x_k, with
// x_0 on the emitter and x_k at the eye: the first s vertices are sampled from the light, the other
// t = k + 1 - s from the eye, and x_{s-1} and x_s are connected. Balance heuristic with the number
// of samples of each strategy (Veach 1997, 9.2.2; Noel 2015, 4.3, 11.5). p_i / p_s is a product of
// ratios, over the vertices between, of the densities from the two ends. So the sum over i < s
// follows from a quantity that the walk from the light accumulates, and the sum over i > s from one
// of the walk from the eye (van Antwerpen 2011):
//
//   sum_{i <= j} n_i p_i / p_{j+1} = (g_j / p_j) (n_j c_j + sum_{i < j} n_i p_i / p_j)
//
// with p_j the density of vertex j on its walk, g_j the one from the other end, and c_j whether
// x_{j-1} and x_j can be connected: neither scatters through a delta lobe only.
//
// With a light tree, next event estimation samples x_0 with another density than light paths do.
// p_1 is then r times the product of densities on the walks, with r the ratio of the two, a
// function of x_0 and x_1: n_1 r takes the place of n_1 in the recursion.
//
// Vertex merging (Georgiev et al. 2012; Hachisuka et al. 2012) is one more technique for each
// vertex x_j, 0 < j < k: both walks sample it, and it contributes if the two points lie within a
// radius r. Its density is p_{j+1} times the probability g_j pi r^2 that the walk from the other
// end comes so close. With m the number of light paths times pi r^2 and d_j whether x_j can be
// merged (it does not scatter through a delta lobe only), the sum has one more term for each
// vertex:
//
//   (g_j / p_j) (n_j c_j + m p_j d_j + sum_{i < j} ...)

/// Number of samples of each strategy that a pixel takes; 0: the strategy is not used.
struct SampleCounts {
  double hit = 1;      ///< s = 0: the eye path hits an emitter
  double nee = 0;      ///< s = 1, t >= 2: next event estimation
  double connect = 0;  ///< s >= 2, t >= 2
  double splat = 0;    ///< s >= 1, t = 1: a light path is connected to the eye
  /// Merging: the number of light paths whose vertices may be merged with an eye vertex, times
  /// pi r^2; in scene units^2.
  double merge = 0;

  /// Whether paths from lights are longer than one vertex.
  constexpr bool bidirectional() const { return connect > 0 || splat > 0 || merge > 0; }
  constexpr double of(int s, int t) const {
    if (s == 0) return hit;
    if (t == 1) return splat;
    return s == 1 ? nee : connect;
  }
};

/// The sample counts by the number of vertices that a strategy samples from one side of the path.
struct TechniqueCounts {
  double none = 0, one = 0, more = 0;
  double merge = 0;  ///< SampleCounts::merge
  constexpr bool any() const { return none > 0 || one > 0 || more > 0 || merge > 0; }
  /// The same with `ratio` times as many samples of the strategies with one vertex; with r of
  /// above, n_1 r for n_1.
  constexpr TechniqueCounts with_one(double ratio) const {
    return {none, one * ratio, more, merge};
  }
  constexpr double of(int vertices) const {
    return vertices == 0 ? none : vertices == 1 ? one : more;
  }
};
constexpr TechniqueCounts light_side(const SampleCounts& n) {
  return {n.hit, n.nee, n.connect, n.merge};
}
/// Nothing hits the eye, a point: every strategy samples at least one vertex from its side.
constexpr TechniqueCounts eye_side(const SampleCounts& n) {
  return {0, n.splat, n.connect, n.merge};
}

/// n_j c_j + sum_{i < j} n_i p_i / p_j at vertex `j` of a walk: `connectible` is c_j, `pdf_rev` the
/// density, per steradian, with which the other end's walk continues from j to j - 1, and
/// `mis_partial` the part of the sum that the walk carried to j (PathState).
constexpr double mis_partial_sum(const TechniqueCounts& side, int j, bool connectible,
                                 double pdf_rev, double mis_partial) {
  return (connectible ? side.of(j) : 0.0) + pdf_rev * mis_partial;
}

/// m p_j d_j at vertex `j` of a walk with density `p_fwd` per area there: the technique that merges
/// this vertex, relative to the strategy that connects it.
constexpr double merge_partial(const TechniqueCounts& side, int j, bool mergeable, double p_fwd) {
  return side.merge > 0 && j > 0 && mergeable ? side.merge * p_fwd : 0.0;
}

/// The balance heuristic, own / (own + light + eye): `own` is the number of samples of this
/// strategy; `light` and `eye` are the sums of n_i p_i / p_s over the strategies with fewer
/// vertices on the light's and on the eye's side.
constexpr double mis_weight(double own, double light, double eye) {
  return own / (own + light + eye);
}

/// The power heuristic with exponent 2 (Veach 1997, 9.2.4) if two techniques sample a path:
/// `balance` is the weight of one by the balance heuristic, in [0, 1]; the other's is 1 - balance.
/// Compared with the balance heuristic, the technique with the smaller weight adds less noise. With
/// the many techniques of bidirectional paths the balance heuristic measured better.
constexpr double power_of_two(double balance) {
  const double other = 1 - balance;
  return balance * balance / (balance * balance + other * other);
}

}  // namespace lacuna
