#include "renderer/connections/probabilistic_connections.h"

#include <numeric>

namespace lacuna {

namespace {

/// Uniform in [0, 1), a multiple of 2^-53, the resolution needed for sums of very different
/// weights.
double fine_number(Rng& rng) {
  const std::uint64_t high = rng.next_u32();
  return static_cast<double>(((high << 32) | rng.next_u32()) >> 11) * 0x1p-53;
}

}  // namespace

void JointDistribution::append(std::span<const double> weights) {
  tables_.emplace_back(weights);
  cumulative_.push_back(cumulative_.back() + std::accumulate(weights.begin(), weights.end(), 0.0));
}

JointDistribution::Sample JointDistribution::sample(int longest, Rng& rng) const {
  const double at = fine_number(rng) * total(longest);
  const auto first = cumulative_.begin() + 1;
  const auto last = first + longest;
  auto found = std::upper_bound(first, last, at);
  // Only rounding leads to `last`: then take the longest length of positive weight.
  if (found == last) found = std::lower_bound(first, last, total(longest));
  const int s = static_cast<int>(found - cumulative_.begin());
  return {s, tables_[place(s) - 1].sample(rng)};
}

void ProbabilisticConnections::begin(const IterationContext& context, const LightVertices& lights,
                                     const CellStatistics&, Counters& counters) {
  counts_.assign(1, 0);
  for (int s = 1; s <= lights.longest(); ++s) counts_.push_back(counts_.back() + lights.count(s));
  records_.place(context, lights, settings_.record_density, lights.longest(), counters);
  require_distributions(ProbabilisticConnectionsSettings::name, records_.size(),
                        AliasTable::bytes_each, lights);
  joint_of_records_.resize(records_.size());
  std::vector<std::uint64_t> rays(records_.size());
  context.pool.for_each(static_cast<int>(records_.size()), [&](int i) {
    const auto k = static_cast<std::size_t>(i);
    rays[k] = build(records_[k], joint_of_records_[k], context, lights);
  });
  counters.shadow_rays += std::accumulate(rays.begin(), rays.end(), std::uint64_t{0});
}

std::uint64_t ProbabilisticConnections::build(const EyeRecords::Record& record,
                                              JointDistribution& joint,
                                              const IterationContext& context,
                                              const LightVertices& lights) const {
  std::uint64_t rays = 0;
  joint.clear();
  for (int s = 1; s <= lights.longest(); ++s) {
    context.check_stop();
    const RecordContributions c =
        contributions_to(record, context, lights, s, {.weighted = settings_.weighted});
    rays += c.rays;
    joint.append(c.full);
  }
  return rays;
}

JointDistribution::Sample ProbabilisticConnections::sample_uniform_vertex(int longest,
                                                                          Rng& rng) const {
  const std::size_t at = rng.below(vertices_up_to(longest));
  const auto found = std::upper_bound(counts_.begin(), counts_.end(), at);
  return {static_cast<int>(found - counts_.begin()), static_cast<std::uint32_t>(at - *(found - 1))};
}

JointDistribution::Sample ProbabilisticConnections::sample_vertex(const CellLookup& lookup,
                                                                  int longest, Rng& rng) const {
  if (lookup.n == 0 || rng.decide(static_cast<float>(settings_.uniform))) {
    return sample_uniform_vertex(longest, rng);
  }
  const JointDistribution& joint = joint_of_records_[lookup.index[rng.below(lookup.n)]];
  return joint.empty(longest) ? sample_uniform_vertex(longest, rng) : joint.sample(longest, rng);
}

VertexSample ProbabilisticConnections::probability(const CellLookup& lookup, int longest,
                                                   const JointDistribution::Sample& d) const {
  const double same = 1 / static_cast<double>(vertices_up_to(longest));
  double by_records = 0;  // mean over the records; records of weight 0 sample uniformly
  double uniform = lookup.n == 0 ? 1 : double(static_cast<float>(settings_.uniform));
  const double each = lookup.n == 0 ? 0 : (1 - uniform) / static_cast<double>(lookup.n);
  for (std::size_t k = 0; k < lookup.n; ++k) {
    const JointDistribution& joint = joint_of_records_[lookup.index[k]];
    if (joint.empty(longest)) {
      uniform += each;
    } else {
      by_records += each * joint.pmf(longest, d);
    }
  }
  const std::uint8_t distribution = by_records >= uniform * same ? 0 : 1;
  return {d.index, static_cast<float>(by_records + uniform * same), distribution};
}

}  // namespace lacuna
