#include "renderer/guides/learned_skeleton.h"

#include <algorithm>
#include <numeric>
#include <stdexcept>

#include "renderer/guides/arriving_power.h"
#include "renderer/guides/skeleton_lobes.h"

namespace lacuna {

namespace {

constexpr std::array<std::size_t, 4> doublings{1, 3, 5, 7};  // of the lobes' strength
/// One of so many vertices tells where they lie, and how well each choice of a cell would do.
constexpr std::uint32_t counted_share = 4;

}  // namespace

struct LearnedSkeleton::SampleAccumulator final : Accumulator {
  Cells::Accumulator cells;
  std::unordered_map<std::uint32_t, CellForest::Spread> spreads;  // by cell
  Tuning::Accumulator tuning;
  std::uint64_t met = 0;  // samples
  double bytes() const override { return cells.bytes() + map_bytes(spreads) + tuning.bytes(); }
};

std::vector<float> LearnedSkeleton::distributions() {
  std::vector<float> all;
  all.reserve(doublings.size() + 1);
  for (const std::size_t k : doublings) all.push_back(LobeSet::powers()[k]);
  all.push_back(-1);
  return all;
}

Tuning LearnedSkeleton::new_tuning(std::size_t cells) const {
  return {distributions(), settings_.probability, cells, Tuning::Directions::learned};
}

bool LearnedSkeleton::samples_learned(std::uint32_t cell) const {
  return tuning_.strength(cell) < 0;
}

void LearnedSkeleton::prepare(const PrepareContext& context) {
  const SkeletonGraph& graph = context.space.skeleton();
  const RegionLabels& regions = context.space.regions();
  transform_ = context.space.voxels().transform;
  node_map_ = &context.space.node_map();
  label_ = &regions.label;
  lookup_.emplace(transform_, *label_);
  for (const Region& r : regions.regions)
    scale_.push_back(1 / (std::max<int>(r.opening, 1) * transform_.voxel_size));
  const SurfaceLookup nodes(transform_, *node_map_);
  lobes_ = skeleton_lobes(
      context,
      arriving_power(context.scene, nodes, graph.nodes(), settings_.light_rays, context.pool),
      ImportanceAim::last);
  forest_ = CellForest(regions.regions.size());
  region_.resize(forest_.cells());
  std::iota(region_.begin(), region_.end(), 0U);
  spreads_.assign(forest_.cells(), {});
  cells_ = Cells(forest_.cells());
  tuning_ = new_tuning(forest_.cells());
}

CellForest::Key LearnedSkeleton::key(std::uint32_t region, const V3f& x, const V3f& n) const {
  const V3f p((V3d(x) - transform_.origin) * scale_[region]);
  return {p.x, p.y, p.z, n.x, n.y, n.z};
}

GuidingCell LearnedSkeleton::cell(const Surface& s, const V3f& w) const {
  const std::optional<Imath::V3i> voxel = lookup_->voxel(V3d(s.x), V3d(s.ng), V3d(w));
  if (!voxel) return {};
  const std::size_t at = label_->index(*voxel);
  const std::uint32_t region = (*label_)[at];
  const std::uint32_t cell =
      forest_.cell(region, key(region, s.x, dot(s.ng, w) < 0 ? -s.ng : s.ng));
  const std::uint32_t node = (*node_map_)[at];
  const bool known = samples_learned(cell) ? !cells_.directions(cell).empty()
                                           : node != no_node && !lobes_[node].empty();
  return {known ? tuning_.probability(cell) : 0.0F, cell, node};
}

std::optional<V3f> LearnedSkeleton::sample(const GuidedVertex& at, Rng::FinePoint u, Rng&) const {
  const std::uint32_t cell = at.cell.index;
  if (samples_learned(cell)) return cells_.directions(cell).sample(at.x(), u);
  return lobes_[at.cell.node].sample(at.x(), tuning_.strength(cell), u);
}

Pdf<SolidAngle> LearnedSkeleton::pdf(const GuidedVertex& at, const V3f& w) const {
  const std::uint32_t cell = at.cell.index;
  if (samples_learned(cell)) return cells_.directions(cell).pdf(at.x(), w);
  return lobes_[at.cell.node].pdf(at.x(), w, tuning_.strength(cell));
}

std::unique_ptr<GuidingDistribution::Accumulator> LearnedSkeleton::accumulator() const {
  return std::make_unique<SampleAccumulator>();
}

void LearnedSkeleton::accumulate(const GuidingSample& sample, Accumulator& accumulator) const {
  auto& own = static_cast<SampleAccumulator&>(accumulator);
  const Vertex& v = sample.v;
  const auto [probability, cell, node] = v.guiding_cell;
  if (cell >= cells_.size()) return;
  if (sample.radiance > 0) {
    const float arriving = sample.radiance * abs_dot(v.surface.ns, sample.wi);
    Cells::accumulate(cell, sample, arriving, own.cells);
  }
  if (own.met++ % counted_share != 0) return;
  own.spreads[cell].add(key(region_[cell], v.surface.x, v.side()));
  if (!tuning_.wants(cell)) return;
  std::array<float, doublings.size() + 1> densities{};
  if (node != no_node && !lobes_[node].empty()) {
    const auto of_lobes = lobes_[node].pdf_of_powers(v.surface.x, sample.wi);
    for (std::size_t i = 0; i < doublings.size(); ++i) densities[i] = of_lobes[doublings[i]];
  }
  const AimedLobes& learned = cells_.directions(cell);
  if (!learned.empty()) densities.back() = learned.pdf(v.surface.x, sample.wi).value;
  tuning_.accumulate(sample, cell, densities, own.tuning);
}

void LearnedSkeleton::record_noise(double variance, double by_bsdf,
                                   Accumulator& accumulator) const {
  static_cast<SampleAccumulator&>(accumulator)
      .tuning.noise.add(variance / double{counted_share}, by_bsdf / double{counted_share});
}

void LearnedSkeleton::update(std::span<const std::unique_ptr<Accumulator>> accumulators,
                             const ThreadPool& pool, double iterations) {
  std::vector<const Cells::Accumulator*> cells;
  std::vector<const Tuning::Accumulator*> tuning;
  for (const auto& a : accumulators) {
    const auto& own = static_cast<const SampleAccumulator&>(*a);
    cells.push_back(&own.cells);
    tuning.push_back(&own.tuning);
    for (const auto& [cell, spread] : own.spreads) spreads_[cell].add(spread);
  }
  tuning_.update(tuning, iterations);
  if (!cells_.update(cells, pool, iterations)) return;
  if (cells_.rounds() > 0) tuning_.stop_if_useless();
  const double most = cells_.most_vertices(settings_.leaf_vertices) / double{counted_share};
  forest_.divide(spreads_, most, most_learned_cells, [this](std::uint32_t cell) {
    cells_.divide(cell);
    tuning_.divide(cell);
    region_.push_back(region_[cell]);
  });
  spreads_.assign(forest_.cells(), {});
  tuning_.fade(0.5);
  cells_.next_round(pool);
}

void LearnedSkeleton::save(ByteWriter& out) const {
  forest_.save(out);
  out.put(region_);
  out.put(spreads_);
  cells_.save(out);
  tuning_.save(out);
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
  tuning_ = new_tuning(forest_.cells());
  tuning_.load(in);
}

std::vector<std::pair<std::string, double>> LearnedSkeleton::statistics() const {
  double learned = 0, lobes = 0, shares = 0;
  for (std::uint32_t c = 0; c < cells_.size(); ++c) {
    if (!tuning_.guides(c)) continue;
    (samples_learned(c) ? learned : lobes) += 1;
    shares += double(tuning_.probability(c));
  }
  return {{"regions", static_cast<double>(scale_.size())},
          {"cells", static_cast<double>(cells_.size())},
          {"cells_of_lobes", lobes},
          {"cells_of_learned_directions", learned},
          {"mean_probability", shares / std::max(1.0, learned + lobes)},
          {"rounds", static_cast<double>(cells_.rounds())}};
}

}  // namespace lacuna
