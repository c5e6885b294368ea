#include "renderer/guides/learned_skeleton.h"

#include <algorithm>
#include <numeric>
#include <stdexcept>

#include "renderer/guides/arriving_power.h"
#include "renderer/guides/skeleton_targets.h"

namespace lacuna {

void LearnedSkeleton::prepare(const PrepareContext& context) {
  const RegionLabels& regions = context.space.regions();
  transform_ = context.space.voxels().transform;
  label_ = &regions.label;
  lookup_.emplace(transform_, *label_);
  for (const Region& r : regions.regions)
    scale_.push_back(1 / (std::max<int>(r.opening, 1) * transform_.voxel_size));
  forest_ = CellForest(regions.regions.size());
  region_.resize(forest_.cells());
  std::iota(region_.begin(), region_.end(), 0U);
  spreads_.assign(forest_.cells(), {});
  cells_ = LearnedCells<AimedLobes>(first_lobes(context));
}

/// The initial lobes of each region; empty if no path leads from it to the light.
std::vector<AimedLobes> LearnedSkeleton::first_lobes(const PrepareContext& context) const {
  const SkeletonGraph& graph = context.space.skeleton();
  const Grid3<std::uint32_t>& node_map = context.space.node_map();
  const std::vector<double> importance =
      arriving_power(context.scene, SurfaceLookup(transform_, node_map), graph.nodes(),
                     settings_.light_rays, context.pool);
  std::vector<std::uint32_t> nodes, of_region;
  const std::vector<Region>& regions = context.space.regions().regions;
  for (std::uint32_t r = 0; r < regions.size(); ++r) {
    const std::uint32_t node = node_map[regions[r].root];
    if (node == no_node) continue;
    nodes.push_back(node);
    of_region.push_back(r);
  }
  const auto targets = skeleton_targets(context, importance, ImportanceAim::last, nodes);
  std::vector<AimedLobes> lobes(regions.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const V3f at(transform_.to_world(V3d(graph.corners[nodes[i]])));
    lobes[of_region[i]] = AimedLobes(at, targets[i]);
  }
  return lobes;
}

CellForest::Key LearnedSkeleton::key(std::uint32_t region, const V3f& x, const V3f& n) const {
  const V3f p((V3d(x) - transform_.origin) * scale_[region]);
  return {p.x, p.y, p.z, n.x, n.y, n.z};
}

GuidingCell LearnedSkeleton::cell(const Surface& s, const V3f& w) const {
  const std::optional<Imath::V3i> voxel = lookup_->voxel(V3d(s.x), V3d(s.ng), V3d(w));
  if (!voxel) return {};
  const std::uint32_t region = (*label_)(*voxel);
  const std::uint32_t cell =
      forest_.cell(region, key(region, s.x, dot(s.ng, w) < 0 ? -s.ng : s.ng));
  return {cells_.directions(cell).empty() ? 0.0F : 1.0F, cell};
}

std::vector<std::uint32_t> LearnedSkeleton::update(const TrainingSamples& samples,
                                                   const ThreadPool& pool) {
  pool.for_each(static_cast<int>(cells_.size()), [&](int i) {
    const auto cell = static_cast<std::size_t>(i);
    for (const TrainingSample& s : samples.of(cell)) {
      if (s.pdf > 0) spreads_[cell].add(key(region_[cell], s.x, s.n));
    }
  });
  std::vector<std::uint32_t> origins;
  if (!cells_.update(samples, pool)) return origins;
  forest_.divide(spreads_, cells_.most_vertices(settings_.leaf_vertices), most_learned_cells,
                 [&](std::uint32_t cell) {
                   cells_.divide(cell);
                   region_.push_back(region_[cell]);
                   origins.push_back(cell);
                 });
  spreads_.assign(forest_.cells(), {});
  cells_.next_round(pool);
  return origins;
}

void LearnedSkeleton::save(ByteWriter& out) const {
  forest_.save(out);
  out.put(region_);
  out.put(spreads_);
  cells_.save(out);
}

void LearnedSkeleton::load(ByteReader& in) {
  forest_.load(in, scale_.size());
  std::vector<std::uint32_t> region = in.get_vector<std::uint32_t>();
  std::vector<CellForest::Spread> spreads = in.get_vector<CellForest::Spread>();
  cells_.load(in);
  const bool known = std::all_of(region.begin(), region.end(),
                                 [this](std::uint32_t r) { return r < scale_.size(); });
  const std::size_t n = forest_.cells();
  if (!known || region.size() != n || spreads.size() != n || cells_.size() != n) {
    throw std::runtime_error("saved cells belong to another scene");
  }
  region_ = std::move(region);
  spreads_ = std::move(spreads);
}

std::vector<std::pair<std::string, double>> LearnedSkeleton::statistics() const {
  double guided = 0;
  for (std::size_t c = 0; c < cells_.size(); ++c) guided += cells_.directions(c).empty() ? 0 : 1;
  return {{"regions", static_cast<double>(scale_.size())},
          {"cells", static_cast<double>(cells_.size())},
          {"guided_cells", guided},
          {"rounds", static_cast<double>(cells_.rounds())}};
}

}  // namespace lacuna
