#pragma once

#include "renderer/visibility/visibility_base.h"

namespace lacuna {

/// Estimates the visibility V between shading points and virtual lights.
///
/// - At, at(): its data of one shading point, made once for each point and pass.
/// - decide(at, block, terms, d): the estimate for the lights of a block (Lanes::size of them;
///   `terms.lit` marks those with a contribution). d.tests: the lights that a shadow ray tests;
///   d.untested: added to the estimate of every light; d.gain: weight of an unoccluded shadow ray.
///   The estimate of a light is untested + (tested ? gain V : 0); its expectation must be V for an
///   unbiased strategy.
/// - hides(): no light of a block illuminates the point.
/// - group(), passes(), begin(): the order of the lights, the passes they are divided into, and the
///   preparation of each pass.
/// - clamps_negative(): negative pixels become black, which is biased.
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
