#include "renderer/emitters/light_tree.h"

#include <immintrin.h>

#include <algorithm>
#include <bit>

namespace lacuna {

namespace {

/// The uniform fraction of each node's selections.
constexpr float uniform_share = 0x1p-16F;
/// Its contribution to the prefix sums of the children's weights, relative to their total, for each
/// number of children.
constexpr auto uniform_sums = [] {
  std::array<std::array<float, 8>, 9> sums{};
  for (std::size_t n = 1; n < sums.size(); ++n) {
    for (std::size_t i = 0; i < 8; ++i) {
      sums[n][i] = uniform_share * static_cast<float>(std::min(i + 1, n)) / static_cast<float>(n);
    }
  }
  return sums;
}();
/// Relative weight of an emitter seen from behind.
constexpr float least_emission = 0x1p-10F;
/// Radius over distance up to which a bundle's emitters are selected by intensity: its appearance
/// then varies by a fourth over the bundle.
constexpr float narrow = 0x1p-3F;
/// Lower bound of squared distances: smaller ones would overflow the weights.
constexpr float least_distance2 = 1e-32F;
/// Smaller sums of weights have no precision for the uniform fraction.
constexpr float least_total = 0x1p-100F;
/// Lower bound of a squared sine, times 127^2, before the square root.
constexpr float least_sine2 = 1e-12F;

/// All ones in the lanes whose bit is set.
__m256 lanes(std::uint8_t bits) {
  const __m256i each = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
  const __m256i set = _mm256_and_si256(_mm256_set1_epi32(bits), each);
  return _mm256_castsi256_ps(_mm256_cmpeq_epi32(set, each));
}

/// Prefix sums of the lanes, non-decreasing despite rounding.
__m256 sums_up_to(__m256 v) {
  const auto shifted = [](__m256 x, auto bytes) {
    return _mm256_castsi256_ps(_mm256_slli_si256(_mm256_castps_si256(x), bytes()));
  };
  v = _mm256_add_ps(v, shifted(v, [] { return 4; }));
  v = _mm256_add_ps(v, shifted(v, [] { return 8; }));
  // The sum of four lanes has another order of additions than the sum of three.
  v = _mm256_max_ps(v, shifted(v, [] { return 4; }));
  const __m256 low = _mm256_permute_ps(_mm256_permute2f128_ps(v, v, 0x08), 0xff);
  return _mm256_add_ps(v, low);
}

/// The largest float not above `v` >= 0: it is below a float if and only if `v` is.
float round_down(double v) {
  return static_cast<float>(
      std::bit_cast<double>(std::bit_cast<std::uint64_t>(v) & ~std::uint64_t{0x1fffffff}));
}

}  // namespace

/// A receiver relative to the children of a node, and their weights for it.
struct LightTree::Geometry {
  __m256 inverse;  // 1 / distance
  __m256 along;    // upper bound of the cosine at the receiver; may exceed 1
  __m256 back;     // upper bound of the cosine of the angle to the axis of emission, times 127
  __m256 weight;   // of each child: see weigh()
};

/// The prefix sums of the weights of a node's children for one receiver, with the uniform fraction.
struct LightTree::Sums {
  alignas(32) std::array<float, 16> up_to;  // [7 + i]: the sum over the children before i
  int count;
  unsigned ends;  // a bit for each child bundle seen under a small angle

  __m256 sums() const { return _mm256_load_ps(&up_to[8]); }
  double before(int i) const { return double(up_to[static_cast<std::size_t>(7 + i)]); }
  double total() const { return before(count); }
  /// The weight of child `i`, > 0.
  double part(int i) const { return before(i + 1) - before(i); }
};

/// The kind of position that a descent is at; enter() computes it from a bit.
enum class LightTree::State : std::uint8_t { at_node, at_entry, at_bundle };

/// The state of one selection. A uniform number is reused level by level: its remainder within the
/// interval of the selected child is the number of the next level, and gets new bits before it
/// becomes coarse.
struct LightTree::Descent {
  const Receiver* at;
  Rng* rng;
  Choice* result;
  double u;             // in [0, 1)
  double bits;          // resolution of `u` times `probability`
  double probability;   // of the descent so far
  double target;        // select_child(): u times the sum of all weights
  int child;            // select_child(): the selected child
  std::uint32_t where;  // index of a node or bundle, or in entries_
  State state;

  Descent() = default;
  Descent(const Receiver& receiver, double uniform, Rng& numbers, Choice& choice)
      : at(&receiver),
        rng(&numbers),
        result(&choice),
        u(uniform),
        bits(0x1p-53),
        probability(1),
        target(0),
        child(0),
        where(0),
        state(State::at_node) {}

  /// Adds bits to `u` if its resolution is coarser than `coarse`.
  void refine(double coarse) {
    if (bits > coarse * probability) [[unlikely]] {
      u += bits / probability * rng->next_choice();
      bits *= 0x1p-53;
    }
    u = std::min(u, 1 - 0x1p-53);
  }
};

[[gnu::always_inline]] inline LightTree::Geometry LightTree::geometry(const LightNode& node,
                                                                      const Receiver& at) {
  const __m256 dx = node.centres(0, at.x.x);
  const __m256 dy = node.centres(1, at.x.y);
  const __m256 dz = node.centres(2, at.x.z);
  const __m256 r = node.radii();
  const auto dot3 = [&](__m256 x, __m256 y, __m256 z) {
    return _mm256_fmadd_ps(dz, z, _mm256_fmadd_ps(dy, y, _mm256_mul_ps(dx, x)));
  };
  const __m256 distance2 = _mm256_max_ps(_mm256_max_ps(dot3(dx, dy, dz), _mm256_mul_ps(r, r)),
                                         _mm256_set1_ps(least_distance2));
  // To 12 bits: a weight may have any error that is equal in all evaluations.
  const __m256 inverse = _mm256_rsqrt_ps(distance2);
  const __m256 sign = _mm256_set1_ps(-0.0F);
  __m256 along = dot3(_mm256_set1_ps(at.n.x), _mm256_set1_ps(at.n.y), _mm256_set1_ps(at.n.z));
  if (at.both_sides) along = _mm256_andnot_ps(sign, along);
  __m256 back = dot3(LightNode::signed_bytes(node.back[0]), LightNode::signed_bytes(node.back[1]),
                     LightNode::signed_bytes(node.back[2]));
  if (node.both_sides != 0) [[unlikely]]
    back = _mm256_andnot_ps(_mm256_and_ps(lanes(node.both_sides), sign), back);
  // At a point of the sphere, a cosine is at most that at the centre plus r / d.
  along = _mm256_mul_ps(_mm256_add_ps(along, r), inverse);
  back = _mm256_mul_ps(_mm256_fmadd_ps(r, _mm256_set1_ps(127), back), inverse);
  return {inverse, along, back, _mm256_setzero_ps()};
}

[[gnu::always_inline]] inline void LightTree::weigh(const LightNode& node, const Receiver& at,
                                                    Geometry& g) {
  const __m256 one = _mm256_set1_ps(1);
  const __m256 received =
      _mm256_max_ps(_mm256_min_ps(g.along, one), _mm256_set1_ps(at.least_cosine));
  // Cosines and sines are times 127. Within the cone of axes the angle is 0.
  const __m256 cos_spread = LightNode::signed_bytes(node.cos_spread);
  const __m256 cosine = _mm256_min_ps(g.back, cos_spread);
  const __m256 sine2 = _mm256_max_ps(_mm256_fnmadd_ps(cosine, cosine, _mm256_set1_ps(127 * 127)),
                                     _mm256_set1_ps(least_sine2));
  const __m256 sine = _mm256_mul_ps(sine2, _mm256_rsqrt_ps(sine2));
  __m256 beyond = _mm256_fmadd_ps(cosine, cos_spread,
                                  _mm256_mul_ps(sine, LightNode::signed_bytes(node.sin_spread)));
  if (node.spots) [[unlikely]] {
    const __m256 reach =
        _mm256_mul_ps(LightNode::signed_bytes(node.cos_reach), _mm256_set1_ps(127));
    beyond = _mm256_and_ps(beyond, _mm256_cmp_ps(beyond, reach, _CMP_GE_OQ));
  }
  const __m256 emitted = _mm256_max_ps(beyond, _mm256_set1_ps(127 * 127 * least_emission));
  g.weight = _mm256_mul_ps(_mm256_mul_ps(emitted, received),
                           _mm256_mul_ps(node.intensities(), _mm256_mul_ps(g.inverse, g.inverse)));
}

[[gnu::always_inline]] inline void LightTree::add_up(const LightNode& node, const Geometry& g,
                                                     Sums& s) {
  s.count = node.count;
  s.ends = node.bundles;
  if (s.ends != 0) {
    const __m256 angle = _mm256_mul_ps(node.radii(), g.inverse);
    s.ends &= static_cast<unsigned>(
        _mm256_movemask_ps(_mm256_cmp_ps(angle, _mm256_set1_ps(narrow), _CMP_LE_OQ)));
  }
  __m256 sums = sums_up_to(g.weight);
  const auto total = [&] {
    return _mm256_permutevar8x32_ps(sums, _mm256_set1_epi32(node.count - 1));
  };
  __m256 all = total();
  if (!(_mm256_cvtss_f32(all) >= least_total)) [[unlikely]] {  // too distant for float precision
    sums = sums_up_to(node.intensities());
    all = total();
  }
  s.up_to[7] = 0;
  _mm256_store_ps(&s.up_to[8],
                  _mm256_fmadd_ps(all, _mm256_loadu_ps(uniform_sums[node.count].data()), sums));
}

[[gnu::always_inline]] inline void LightTree::sum_up(const LightNode& node, const Receiver& at,
                                                     Sums& s) {
  Geometry g = geometry(node, at);
  weigh(node, at, g);
  add_up(node, g, s);
}

/// Selects a child.
[[gnu::always_inline]] inline void LightTree::select_child(const Sums& s, Descent& d) {
  d.target = d.u * s.total();  // below the sum despite rounding: floats have 24 bits
  const __m256 passed = _mm256_cmp_ps(s.sums(), _mm256_set1_ps(round_down(d.target)), _CMP_LE_OQ);
  d.child = std::popcount(static_cast<unsigned>(_mm256_movemask_ps(passed)));
}

/// Moves to the selected child.
[[gnu::always_inline]] inline void LightTree::enter(const Sums& s, Descent& d) const {
  const LightNode& node = nodes_[d.where];
  const int i = d.child;
  const double part = s.part(i);
  d.u = (d.target - s.before(i)) / part;
  d.probability *= part / s.total();
  // Without a branch: the end of a descent is unpredictable.
  const std::uint32_t place = d.where * width + static_cast<std::uint32_t>(i);
  const std::uint32_t is_node = 0U - (node.nodes >> i & 1U);
  const std::uint32_t next = (node.node(i) & is_node) | (d.where & ~is_node);
  d.where = (next & is_node) | (place & ~is_node);
  d.state = static_cast<State>(is_node + 1);
  // Prefetch the next node, and its entries, one of which may be next; an entry has both already.
  const auto* lines = reinterpret_cast<const char*>(nodes_.data() + next);
  for (std::size_t k = 0; k < sizeof(LightNode); k += 64) _mm_prefetch(lines + k, _MM_HINT_T0);
  _mm_prefetch(entries_.data() + std::size_t{next} * width, _MM_HINT_T0);
  if ((s.ends >> i & 1) != 0) {
    d.state = State::at_bundle;
    _mm_prefetch(&bundle_of_[d.where], _MM_HINT_T0);
  }
  d.refine(0x1p-25);
}

/// Ends a descent: at an entry, or in a bundle by intensity.
void LightTree::end(Descent& d) const {
  if (d.state == State::at_bundle) {
    const Bundle& bundle = bundles_[bundle_of_[d.where]];
    d.refine(0x1p-44);  // bits for the table's bins, and for parts of bins down to 2^-32
    const AliasTable::Sample sample = bundle.by_intensity.sample(d.u);
    d.probability *= double(sample.pmf.value);
    d.u = std::min(d.u, 1 - 0x1p-53);
    *d.result = {bundle.entries[sample.index], d.probability, d.u};
  } else {
    *d.result = {entries_[d.where], d.probability, d.u};
  }
}

LightTree::Choice LightTree::choose(const Receiver& at, double u, Rng& rng) const {
  Choice result;
  Descent d(at, u, rng, result);
  while (d.state == State::at_node) {
    const LightNode& node = nodes_[d.where];
    Sums s;
    sum_up(node, at, s);
    select_child(s, d);
    enter(s, d);
  }
  end(d);
  return result;
}

void LightTree::choose(std::span<Request> requests) const {
  // Each level takes five loops, each short enough for the processor to overlap several descents.
  // When a descent ends, the next request takes its place, so the loops keep their length.
  constexpr std::size_t together = 16;
  std::array<Descent, together> descents;
  std::array<Geometry, together> geometries;
  std::array<Sums, together> sums;
  std::array<std::size_t, together> ended;
  std::size_t n = std::min(together, requests.size());
  std::size_t next = n;
  const auto start = [](Request& r) { return Descent(r.at, r.u, *r.rng, r.result); };
  for (std::size_t k = 0; k < n; ++k) descents[k] = start(requests[k]);
  while (n > 0) {
    for (std::size_t k = 0; k < n; ++k) {
      geometries[k] = geometry(nodes_[descents[k].where], *descents[k].at);
    }
    for (std::size_t k = 0; k < n; ++k) {
      weigh(nodes_[descents[k].where], *descents[k].at, geometries[k]);
    }
    for (std::size_t k = 0; k < n; ++k) {
      add_up(nodes_[descents[k].where], geometries[k], sums[k]);
    }
    for (std::size_t k = 0; k < n; ++k) select_child(sums[k], descents[k]);
    std::size_t m = 0;
    for (std::size_t k = 0; k < n; ++k) {
      enter(sums[k], descents[k]);
      ended[m] = k;
      m += descents[k].state == State::at_node ? 0 : 1;
    }
    // In reverse order: the descent that fills a gap has not ended.
    while (m-- > 0) {
      Descent& d = descents[ended[m]];
      end(d);
      d = next < requests.size() ? start(requests[next++]) : descents[--n];
    }
  }
}

double LightTree::probability(std::uint32_t entry, const Receiver& at) const {
  if (entry >= places_.size() || places_[entry] == none) return 0;
  // From the root, multiplying in the same order as choose().
  constexpr int most = 64;  // see LightTreeBuilder
  std::array<std::uint32_t, most> way;
  int n = 0;
  for (std::uint32_t place = places_[entry]; place != none; place = parents_[place / width]) {
    const auto* lines = reinterpret_cast<const char*>(&nodes_[place / width]);
    for (std::size_t k = 0; k < sizeof(LightNode); k += 64) _mm_prefetch(lines + k, _MM_HINT_T0);
    way[static_cast<std::size_t>(n++)] = place;
  }
  double p = 1;
  while (n-- > 0) {
    const std::uint32_t place = way[static_cast<std::size_t>(n)];
    const LightNode& node = nodes_[place / width];
    Sums s;
    sum_up(node, at, s);
    const auto child = static_cast<int>(place % width);
    p *= s.part(child) / s.total();
    if ((s.ends >> child & 1) != 0) {
      const Bundle& bundle = bundles_[bundle_of_[node.node(child)]];
      return p * double(bundle.by_intensity.pmf(member_of_[entry]).value);
    }
  }
  return p;
}

}  // namespace lacuna
