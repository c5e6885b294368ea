#include "analysis/regions/opening_labels.h"

#include <algorithm>
#include <utility>

#include "analysis/space/run_components.h"

namespace lacuna {

RegionLabels opening_labels(OpeningForest forest, const ThreadPool& pool) {
  RegionLabels labels;
  labels.label = std::move(forest.centre);
  labels.opening = std::move(forest.opening);
  const Grid3<std::uint16_t>& opening = labels.opening;  // 0 outside the domain
  const RunComponents zones = label_runs(
      opening.size(),
      EqualValueRows([&](Imath::V3i v) { return opening(v); }, std::uint16_t{0}, opening.size().x),
      Connectivity::faces, pool);
  std::fill_n(labels.label.data(), labels.label.count(), no_region);
  labels.regions.resize(zones.count());
  zones.for_each_run([&](const ComponentRun& run, int y, int z) {
    Region& region = labels.regions[run.component];
    if (region.voxels == 0) {
      const std::size_t first = opening.index(run.x0, y, z);
      region.opening = opening[first];
      region.root = static_cast<std::uint32_t>(first);
    }
    region.voxels += static_cast<std::uint64_t>(run.x1 - run.x0);
    std::uint32_t* const row = labels.label.row(y, z);
    std::fill(row + run.x0, row + run.x1, run.component);
  });
  return labels;
}

}  // namespace lacuna
