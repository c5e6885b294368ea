#pragma once

#include <optional>
#include <span>

#include "renderer/core/rng.h"
#include "renderer/path/guiding_sample.h"
#include "renderer/path/strategy.h"

namespace lacuna {

/// Where the next ray of a path goes: what walks, connections and weights ask.
///
/// - arrive(v): the walk has come to `v`, a surface with its BSDF; looks up what is needed there.
/// - sample(v, rng, transport): the next direction with its weight f cos / pdf and its density;
/// nothing
///   where the draw fails. Paths from the eye (Transport::radiance) are guided; those from lights
///   may be.
/// - pdf(v, wo, wi, transport): the density per solid angle with which sample() returns unit `wi`
/// for
///   a walk that came from unit `wo`, for any `wo` and `wi`: weights ask it for the reverse walk,
///   too. Over the sphere it integrates to 1 less the probability of failure. Where the BSDF is not
///   zero it is above 0.
/// - learns(), accumulator(), learn(), end(): parts of an iteration learn apart into accumulators,
/// which end()
///   adds up in the order of the parts, so that the state is the same bits for any number of
///   threads.
///
/// sample(), pdf(), arrive() and learn() are const and are called by many threads.
template <class G>
concept Guide = Strategy<G> &&
    requires(G g, const G& k, Vertex& v, const V3f& w, Rng& rng, Transport transport,
             const GuidingSample& sample, typename G::Accumulator& accumulator,
             std::span<const typename G::Accumulator> accumulators, const ThreadPool& pool) {
  k.arrive(v);
  { k.sample(v, rng, transport) } -> std::same_as<std::optional<BsdfSample>>;
  { k.pdf(v, w, w, transport) } -> std::same_as<Pdf<SolidAngle>>;
  { k.learns() } -> std::same_as<bool>;
  { k.accumulator() } -> std::same_as<typename G::Accumulator>;
  k.accumulate(sample, accumulator);
  g.update(accumulators, pool);
};

}  // namespace lacuna
