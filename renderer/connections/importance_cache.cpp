#include "renderer/connections/importance_cache.h"

#include <numeric>

namespace lacuna {

void ImportanceCacheConnections::begin(const IterationContext& context, const LightVertices& lights,
                                       const CellStatistics&, Counters& counters) {
  records_.place(context, lights, settings_.record_density, record_depth_, counters);
  require_distributions("importance_cache", records_.size(), ResamplingTable::bytes_each, lights);
  cells_of_records_.resize(records_.size());
  std::vector<std::uint64_t> rays(records_.size());
  context.pool.for_each(static_cast<int>(records_.size()), [&](int i) {
    const auto k = static_cast<std::size_t>(i);
    rays[k] = build(records_[k], cells_of_records_[k], context, lights);
  });
  counters.shadow_rays += std::accumulate(rays.begin(), rays.end(), std::uint64_t{0});
}

std::uint64_t ImportanceCacheConnections::build(const EyeRecords::Record& record,
                                                ResamplingCell& cell,
                                                const IterationContext& context,
                                                const LightVertices& lights) const {
  const WantedContributions wanted{
      .full = settings_.full, .unshadowed = settings_.unshadowed, .bounded = settings_.bounded};
  std::uint64_t rays = 0;
  for (int s = 1; s <= lights.longest(); ++s) {
    context.check_stop();
    const RecordContributions c = contributions_to(record, context, lights, s, wanted);
    rays += c.rays;
    const std::vector<double> same(lights.count(s), 1.0);
    const std::array<std::span<const double>, 4> all{c.full, c.unshadowed, c.bounded, same};
    cell.set(s, ResamplingTable(all, settings_.combination));
  }
  return rays;
}

}  // namespace lacuna
