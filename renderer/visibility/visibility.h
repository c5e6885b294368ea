#pragma once

#include "renderer/visibility/visibility_base.h"

namespace lacuna {

/// What is taken for V between shading points and virtual lights.
///
/// - At, at(): what it knows of one shading point; made once for each point and pass.
/// - decide(at, block, terms, d): for the lights of a block (Lanes::size of them, of which
///   `terms.lit` would give something): d.tests, those that a ray is sent to; d.untested, the V
///   taken for the others; d.gain, by which the answer of a ray counts. With E the probability of a
///   test, an unbiased choice has E[tests] gain V + (1 - E[tests]) untested = V.
/// - hides(): the point gets nothing from a block, whatever its lights would give.
/// - group(), passes(), begin(): the order of the lights, how many are treated at a time, and what
/// is
///   built for them in each iteration.
/// - clamps_negative(): pixels below zero become black, which is biased.
///
/// at(), decide() and hides() are const and are called by many threads; what is random in them
/// comes from the context's counter-based generator, so that the bits do not depend on the threads.
template <class V>
concept Visibility = Strategy<V> &&
    requires(V v, const V& k, const ShadingPoint& point, const Terms& terms,
             const IterationContext& context, VisibilityEstimate& d, typename V::At& at,
             const VplGeometry& light, const VplSet& lights, const LightPass& pass) {
  { k.at(point, context) } -> std::same_as<typename V::At>;
  k.decide(at, std::size_t{}, terms, d);
  { k.hides(at, std::size_t{}) } -> std::same_as<bool>;
  { k.group(light) } -> std::same_as<std::uint32_t>;
  { k.passes(lights) } -> std::same_as<std::vector<BlockRange>>;
  { v.begin(pass) } -> std::same_as<Counters>;
  { k.clamps_negative() } -> std::same_as<bool>;
};

}  // namespace lacuna
