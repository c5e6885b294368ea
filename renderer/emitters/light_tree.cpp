#include "renderer/emitters/light_tree.h"

#include <immintrin.h>

#include <algorithm>
#include <bit>

namespace lacuna {

namespace {

/// The share of each node's choices that is uniform.
constexpr double uniform_share = 0x1p-16;
/// Of one of so many children.
constexpr std::array uniform_parts = [] {
  std::array<double, 9> parts{};
  for (std::size_t n = 1; n < parts.size(); ++n) parts[n] = uniform_share / static_cast<double>(n);
  return parts;
}();
/// Weight of an emitter seen from behind, against one seen from its axis.
constexpr float least_emission = 0x1p-10F;
/// Radius over distance up to which a bundle is drawn from by intensity: what it looks like from
/// there varies by a fourth over the bundle.
constexpr float narrow = 0x1p-3F;
/// Squared distances below it would overflow the weights.
constexpr float least_distance2 = 1e-36F;

__m256 widen(const std::array<std::int8_t, 8>& v) {
  const __m128i bytes = _mm_loadl_epi64(reinterpret_cast<const __m128i*>(v.data()));
  return _mm256_cvtepi32_ps(_mm256_cvtepi8_epi32(bytes));
}

/// 1 / sqrt(v) by one step of Newton's method.
__m256 reciprocal_root(__m256 v) {
  const __m256 y = _mm256_rsqrt_ps(v);
  const __m256 half = _mm256_mul_ps(_mm256_mul_ps(_mm256_set1_ps(0.5F), v), _mm256_mul_ps(y, y));
  return _mm256_mul_ps(y, _mm256_sub_ps(_mm256_set1_ps(1.5F), half));
}

/// All ones in the lanes whose bit is set.
__m256 lanes(std::uint8_t bits) {
  const __m256i each = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
  const __m256i set = _mm256_and_si256(_mm256_set1_epi32(bits), each);
  return _mm256_castsi256_ps(_mm256_cmpeq_epi32(set, each));
}

/// Sums of the lanes up to each, non-decreasing whatever the rounding.
__m256 sums_up_to(__m256 v) {
  const auto shifted = [](__m256 x, auto bytes) {
    return _mm256_castsi256_ps(_mm256_slli_si256(_mm256_castps_si256(x), bytes()));
  };
  v = _mm256_add_ps(v, shifted(v, [] { return 4; }));
  v = _mm256_add_ps(v, shifted(v, [] { return 8; }));
  // The last of four is summed in another order than the third.
  v = _mm256_max_ps(v, shifted(v, [] { return 4; }));
  const __m256 low = _mm256_permute_ps(_mm256_permute2f128_ps(v, v, 0x08), 0xff);
  return _mm256_add_ps(v, low);
}

/// The largest float that is not above `v` >= 0: it is below a float if and only if `v` is.
float round_down(double v) {
  return static_cast<float>(
      std::bit_cast<double>(std::bit_cast<std::uint64_t>(v) & ~std::uint64_t{0x1fffffff}));
}

}  // namespace

/// A receiver as the children of a node see it.
struct LightTree::Geometry {
  __m256 inverse;  // of the distance
  __m256 along;    // the cosine, at most, at the receiver
  __m256 back;     // the cosine, at most, of the angle to the axis of emission
};

/// The weights of a node's children for one receiver, summed.
struct LightTree::Weights {
  __m256 sums;
  alignas(32) std::array<float, 16> up_to;  // [7 + i]: the sum of the children before i
  int count;
  unsigned ends;  // a bit for each child that is a bundle and is seen under a small angle

  float before(int i) const { return up_to[static_cast<std::size_t>(7 + i)]; }
  float total() const { return before(count); }
  /// The weight of child `i`.
  double part(int i) const { return double(before(i + 1)) - double(before(i)); }
  double probability(int i) const {
    return uniform_parts[static_cast<std::size_t>(count)] +
           (1 - uniform_share) * (part(i) / double(total()));
  }
};

/// The state of one choice. A uniform number is used level by level: what is left of it within the
/// chosen child's interval is the number of the next level, and is filled up with new bits before
/// it gets coarse.
struct LightTree::Descent {
  const Receiver* at;
  Rng* rng;
  double u;                // in [0, 1)
  double grain = 0x1p-53;  // what `u` is a multiple of
  double probability = 1;
  std::uint32_t node = 0;
  bool done = false;    // `node` is an entry, or a bundle
  bool bundle = false;  // draw() has still to be called
};

[[gnu::always_inline]] inline LightTree::Geometry LightTree::geometry(const Node& node,
                                                                      const Receiver& at) {
  const auto load = [](const std::array<float, width>& v) { return _mm256_load_ps(v.data()); };
  const __m256 dx = _mm256_sub_ps(load(node.x), _mm256_set1_ps(at.x.x));
  const __m256 dy = _mm256_sub_ps(load(node.y), _mm256_set1_ps(at.x.y));
  const __m256 dz = _mm256_sub_ps(load(node.z), _mm256_set1_ps(at.x.z));
  const __m256 r = load(node.r);
  const auto dot3 = [&](__m256 x, __m256 y, __m256 z) {
    return _mm256_fmadd_ps(dz, z, _mm256_fmadd_ps(dy, y, _mm256_mul_ps(dx, x)));
  };
  const __m256 distance2 = _mm256_max_ps(_mm256_max_ps(dot3(dx, dy, dz), _mm256_mul_ps(r, r)),
                                         _mm256_set1_ps(least_distance2));
  const __m256 inverse = reciprocal_root(distance2);
  // To a point of the sphere, the cosine is at most that of the centre plus r / d.
  const auto most_cosine = [&](__m256 along) {
    return _mm256_min_ps(_mm256_mul_ps(_mm256_add_ps(along, r), inverse), _mm256_set1_ps(1));
  };
  const __m256 sign = _mm256_set1_ps(-0.0F);
  __m256 along = dot3(_mm256_set1_ps(at.n.x), _mm256_set1_ps(at.n.y), _mm256_set1_ps(at.n.z));
  if (at.both_sides) along = _mm256_andnot_ps(sign, along);
  __m256 back = dot3(widen(node.axis[0]), widen(node.axis[1]), widen(node.axis[2]));
  back = _mm256_mul_ps(back, _mm256_set1_ps(-1.0F / 127));
  back = _mm256_andnot_ps(_mm256_and_ps(lanes(node.both_sides), sign), back);
  return {inverse, most_cosine(along), most_cosine(back)};
}

[[gnu::always_inline]] inline void LightTree::weigh(const Node& node, const Receiver& at,
                                                    const Geometry& g, Weights& w) {
  const __m256 one = _mm256_set1_ps(1);
  const __m256 received = _mm256_max_ps(g.along, _mm256_set1_ps(at.least_cosine));
  // Cosines and sines are stored times 127.
  const __m256 unit = _mm256_set1_ps(1.0F / 127);
  const __m256 sine2 =
      _mm256_max_ps(_mm256_fnmadd_ps(g.back, g.back, one), _mm256_set1_ps(least_distance2));
  const __m256 sine = _mm256_mul_ps(sine2, _mm256_rsqrt_ps(sine2));
  const __m256 cos_spread = widen(node.cos_spread);
  const __m256 beyond =
      _mm256_fmadd_ps(g.back, cos_spread, _mm256_mul_ps(sine, widen(node.sin_spread)));
  const __m256 reached = _mm256_cmp_ps(beyond, widen(node.cos_reach), _CMP_GE_OQ);
  __m256 emitted = _mm256_max_ps(_mm256_mul_ps(_mm256_and_ps(beyond, reached), unit),
                                 _mm256_set1_ps(least_emission));
  const __m256 within =
      _mm256_cmp_ps(_mm256_mul_ps(g.back, _mm256_set1_ps(127)), cos_spread, _CMP_GE_OQ);
  emitted = _mm256_blendv_ps(emitted, one, within);
  const __m256 intensity = _mm256_load_ps(node.intensity.data());
  const __m256 weight =
      _mm256_mul_ps(_mm256_mul_ps(emitted, received),
                    _mm256_mul_ps(intensity, _mm256_mul_ps(g.inverse, g.inverse)));
  w.count = node.count;
  w.sums = sums_up_to(weight);
  w.ends = node.bundles;
  if (w.ends != 0) {
    const __m256 angle = _mm256_mul_ps(_mm256_load_ps(node.r.data()), g.inverse);
    w.ends &= static_cast<unsigned>(
        _mm256_movemask_ps(_mm256_cmp_ps(angle, _mm256_set1_ps(narrow), _CMP_LE_OQ)));
  }
  w.up_to[7] = 0;
  _mm256_store_ps(&w.up_to[8], w.sums);
  if (!(w.total() > 0)) [[unlikely]] {  // too far away for floats
    w.sums = sums_up_to(intensity);
    _mm256_store_ps(&w.up_to[8], w.sums);
  }
}

[[gnu::always_inline]] inline void LightTree::descend(const Weights& w, Descent& d) const {
  const Node& node = nodes_[d.node];
  int i = 0;
  if (d.u < uniform_share) [[unlikely]] {
    const double at = d.u * (w.count / uniform_share);
    i = std::min(static_cast<int>(at), w.count - 1);
    d.u = at - i;
    d.grain *= w.count / uniform_share;
  } else {
    const double scale = double(w.total()) * (1 / (1 - uniform_share));
    // Below the total, whatever the rounding.
    const double at = std::min((d.u - uniform_share) * scale, double(w.total()) * (1 - 0x1p-53));
    const __m256 passed = _mm256_cmp_ps(w.sums, _mm256_set1_ps(round_down(at)), _CMP_LE_OQ);
    i = std::popcount(static_cast<unsigned>(_mm256_movemask_ps(passed)));
    const double per_part = 1 / w.part(i);
    d.u = (at - double(w.before(i))) * per_part;
    d.grain *= scale * per_part;
  }
  d.probability *= w.probability(i);
  d.node = node.child[static_cast<std::size_t>(i)];
  d.done = (node.leaves >> i & 1) != 0;
  if (d.done) {
    d.u = std::clamp(d.u, 0.0, 1 - 0x1p-53);
    return;
  }
  if ((w.ends >> i & 1) != 0) {
    d.done = d.bundle = true;
    __builtin_prefetch(&bundle_of_[d.node]);
    return;
  }
  const auto* next = reinterpret_cast<const char*>(&nodes_[d.node]);
  for (std::size_t k = 0; k < sizeof(Node); k += 64) _mm_prefetch(next + k, _MM_HINT_T0);
  if (d.grain > 0x1p-25) [[unlikely]] {
    d.u += d.grain * d.rng->next_choice();
    d.grain *= 0x1p-53;
  }
  d.u = std::min(d.u, 1 - 0x1p-53);
}

/// Ends a descent at a bundle.
void LightTree::draw(Descent& d) const {
  if (!d.bundle) return;
  const Bundle& bundle = bundles_[bundle_of_[d.node]];
  constexpr double coarse = 0x1p-44;  // tables have bins, and parts of bins down to 2^-32
  if (d.grain > coarse) [[unlikely]]
    d.u += d.grain * d.rng->next_choice();
  d.u = std::clamp(d.u, 0.0, 1 - 0x1p-53);
  const AliasTable::Draw drawn = bundle.by_intensity.sample(d.u);
  d.probability *= double(drawn.pmf.value);
  d.node = bundle.entries[drawn.index];
  d.u = std::min(d.u, 1 - 0x1p-53);
}

LightTree::Choice LightTree::choose(const Receiver& at, double u, Rng& rng) const {
  Descent d{&at, &rng, u};
  while (!d.done) {
    Weights w;
    weigh(nodes_[d.node], at, geometry(nodes_[d.node], at), w);
    descend(w, d);
  }
  draw(d);
  return {d.node, d.probability, d.u};
}

void LightTree::choose(std::span<Request> requests) const {
  // A level in three loops: each is short enough for the processor to work on several descents at
  // once.
  constexpr std::size_t together = 16;
  std::array<Descent, together> descents;
  std::array<Geometry, together> geometries;
  std::array<Weights, together> weights;
  std::array<std::size_t, together> going{};
  for (std::size_t first = 0; first < requests.size(); first += together) {
    std::size_t n = std::min(together, requests.size() - first);
    const auto all = n;
    for (std::size_t k = 0; k < n; ++k) {
      Request& r = requests[first + k];
      descents[k] = {&r.at, r.rng, r.u};
      going[k] = k;
    }
    while (n > 0) {
      for (std::size_t k = 0; k < n; ++k) {
        const Descent& d = descents[going[k]];
        geometries[k] = geometry(nodes_[d.node], *d.at);
      }
      for (std::size_t k = 0; k < n; ++k) {
        const Descent& d = descents[going[k]];
        weigh(nodes_[d.node], *d.at, geometries[k], weights[k]);
      }
      std::size_t left = 0;
      for (std::size_t k = 0; k < n; ++k) {
        descend(weights[k], descents[going[k]]);
        going[left] = going[k];
        left += descents[going[k]].done ? 0 : 1;
      }
      n = left;
    }
    for (std::size_t k = 0; k < all; ++k) {
      draw(descents[k]);
      requests[first + k].result = {descents[k].node, descents[k].probability, descents[k].u};
    }
  }
}

double LightTree::probability(std::uint32_t entry, const Receiver& at) const {
  if (entry >= places_.size() || places_[entry] == none) return 0;
  // From the root on, as choose() multiplies.
  constexpr int most = 64;  // see LightTreeBuilder
  std::array<std::uint32_t, most> way;
  int n = 0;
  for (std::uint32_t place = places_[entry]; place != none; place = parents_[place / width]) {
    const auto* node = reinterpret_cast<const char*>(&nodes_[place / width]);
    for (std::size_t k = 0; k < sizeof(Node); k += 64) _mm_prefetch(node + k, _MM_HINT_T0);
    way[static_cast<std::size_t>(n++)] = place;
  }
  double p = 1;
  while (n-- > 0) {
    const std::uint32_t place = way[static_cast<std::size_t>(n)];
    const Node& node = nodes_[place / width];
    Weights w;
    weigh(node, at, geometry(node, at), w);
    const auto child = static_cast<int>(place % width);
    p *= w.probability(child);
    if ((w.ends >> child & 1) != 0) {
      const Bundle& bundle = bundles_[bundle_of_[node.child[place % width]]];
      return p * double(bundle.by_intensity.pmf(member_of_[entry]).value);
    }
  }
  return p;
}

}  // namespace lacuna
