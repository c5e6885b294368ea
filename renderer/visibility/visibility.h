#pragma once

#include "renderer/visibility/visibility_base.h"

namespace lacuna {

/// Estimates the visibility V between shading points and virtual lights.
///
/// - At, at(): the strategy's data of one shading point, constructed once per point and pass.
/// - decide(at, block, terms, d): the estimate for the lights of a block (Lanes::size lights;
///   `terms.lit` marks those with a contribution). d.tests: the lights to test by a shadow ray;
///   d.untested: added to the estimate of every light; d.gain: weight of an unoccluded shadow ray.
///   The estimate of a light is untested + (tested ? gain V : 0); its expectation must be V for an
///   unbiased strategy.
/// - share(points, states, context): data that the points of a tile have in common, once per tile.
/// - hides(): whether no light of a block illuminates the point.
/// - group(), groups(), passes(), begin(), end(): the order of the lights, their division into
///   passes, the preparation of each pass, and the end of an iteration.
/// - cell(), cells(), rate(): the cell of the empty space, below cells(), that a light or a point
///   lies in, and the rate of visibility learned between the points of a cell and a block of
///   lights.
/// - tested(), seen(): what a strategy learns from the rays of its tests.
/// - clamps_negative(): whether negative pixels become black, which is biased.
///
/// at(), decide() and hides() are const and are called by many threads; their random numbers come
/// from the context's counter-based generator, so the result is bit-identical for any number of
/// threads.
template <class V>
concept Visibility = Strategy<V> &&
    requires(V v, const V& k, const ShadingPoint& point, const Terms& terms,
             const IterationContext& context, VisibilityEstimate& d, typename V::At& at,
             const VplGeometry& light, const VplSet& lights, const LightPass& pass) {
  { k.at(point, context) } -> std::same_as<typename V::At>;
  k.share(std::span(&point, 1), std::span(&at, 1), context);
  k.decide(at, std::size_t{}, terms, d);
  { k.hides(at, std::size_t{}) } -> std::same_as<bool>;
  { k.group(light) } -> std::convertible_to<LightGroup>;
  { k.groups() } -> std::same_as<std::uint64_t>;
  { k.cell(at) } -> std::same_as<std::uint32_t>;
  { k.cell(light) } -> std::same_as<std::uint32_t>;
  { k.cells() } -> std::same_as<std::uint32_t>;
  { k.rate(std::uint32_t{}, std::size_t{}) } -> std::same_as<float>;
  { k.passes(lights) } -> std::same_as<std::vector<BlockRange>>;
  { v.begin(pass) } -> std::same_as<Counters>;
  v.end();
  k.seen(at, k.tested(at, 0));
  { k.clamps_negative() } -> std::same_as<bool>;
};

}  // namespace lacuna
