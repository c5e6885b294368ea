#pragma once

#include <optional>
#include <span>

#include "renderer/core/rng.h"
#include "renderer/path/guiding_sample.h"
#include "renderer/path/strategy.h"

namespace lacuna {

/// Samples the next direction of a path, and evaluates the density of any direction.
///
/// - on_hit(v): called when a walk reaches the surface `v` and its BSDF is set. Stores the guiding
///   cell in `v`.
/// - prefetch(v), or none: called when the surface and wp of `v` are known, before its BSDF is.
/// - sample(v, rng, transport): a direction with its weight f cos / pdf and its density; nothing
///   where the sample fails. Eye paths (Transport::radiance) are guided; light paths may be.
/// - pdf(v, wo, wi, transport): the density per steradian with which sample() returns unit `wi` for
///   a walk that arrived from unit `wo`. Defined for any `wo` and `wi`, because MIS weights need
///   the reverse densities. Its integral over the sphere is 1 less the probability of failure. It
///   is above 0 wherever the BSDF is. pdf(v, wo, wi, transport, bsdf): the same where the density
///   of `wi` by the BSDF is known.
/// - learns(), accumulator(), accumulate(), update(): each part of an iteration accumulates its
///   samples separately. update() adds the accumulators in the order of the parts, so the state has
///   the same bits for any number of threads.
///
/// - has_expected: whether expected(v) and guides(transport) exist. The first is the luminance that
///   an eye path of throughput 1 is expected to gather behind the connectible vertex `v`; below 0
///   while that is unknown. Walks use it for roulette and splitting of paths whose transport the
///   guide guides(). record(v, value, accumulator) adds the value of one path.
///
/// - sample_first_edge(lights, e, rng) and leaving_pdf(e, w), both or neither: the first edge of a
///   light path from the point `e` on an emitter, and its density per steradian. Without them light
///   paths leave as emitters emit.
///
/// sample(), pdf(), on_hit() and accumulate() are const and are called by many threads.
template <class G>
concept Guide = Strategy<G> &&
    requires(G g, const G& k, Vertex& v, const V3f& w, Rng& rng, Transport transport,
             const GuidingSample& sample, typename G::Accumulator& accumulator,
             std::span<typename G::Accumulator> accumulators, const ThreadPool& pool,
             double iterations) {
  k.on_hit(v);
  { k.sample(v, rng, transport) } -> std::same_as<std::optional<BsdfSample>>;
  { k.pdf(v, w, w, transport) } -> std::same_as<Pdf<SolidAngle>>;
  { k.pdf(v, w, w, transport, Pdf<SolidAngle>()) } -> std::same_as<Pdf<SolidAngle>>;
  { k.learns() } -> std::same_as<bool>;
  { G::has_expected } -> std::convertible_to<bool>;
  { k.accumulator() } -> std::same_as<typename G::Accumulator>;
  k.accumulate(sample, accumulator);
  g.update(accumulators, pool, iterations);
};

}  // namespace lacuna
