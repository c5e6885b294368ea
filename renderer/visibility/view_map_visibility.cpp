#include "renderer/visibility/view_map_visibility.h"

#include "renderer/core/passes.h"

namespace lacuna {

namespace {

/// Distance of views in front of their surface, in radii of the octree's leaves: on a flat surface
/// no leaf's sphere then rises above the horizon.
constexpr float before_surface = 2;

constexpr std::uint32_t maps_between_stops = 256;

}  // namespace

void ViewMapVisibility::prepare(const PrepareContext& context) {
  const Bounds& box = context.scene.bounds();
  cube_ = octree_cube(box.low, box.high, settings_.levels);
  cell_ = Octree::radius(cube_.side, cube_.levels);
  if (settings_.method != ViewMapMethod::per_view) {
    const std::shared_ptr<const Octree> scene = context.space.octree(settings_.levels);
    Passes passes(context.pool);
    passes.begin("view map scene", scene_seconds_);
    scene_ = std::make_unique<SceneNodes>(*scene, context.pool);
  }
  texels_ = map_texels({settings_.map_size});
  maps_ = std::make_unique<ViewMaps>(settings_.map_size, static_cast<float>(2 * cube_.side));
}

std::vector<BlockRange> ViewMapVisibility::passes(const VplSet& lights) const {
  constexpr double gib = 1 << 30;
  const double most = settings_.memory * gib / double(texels_.size() * sizeof(std::uint16_t));
  std::vector<BlockRange> ranges{{}};
  double views = 0;
  for (std::size_t b = 0; b < lights.blocks(); ++b) {
    const auto more = lights.geometry(b, 0).infinite ? 0.0 : double(lights.count(b));
    if (views > 0 && views + more > most) {
      ranges.back().end = b;
      ranges.push_back({b});
      views = 0;
    }
    views += more;
  }
  return ranges;
}

Counters ViewMapVisibility::begin(const LightPass& pass) {
  Passes passes(pass.context.pool);
  passes.begin("view tree", tree_seconds_);
  lights_ = &pass.terms.lights();
  if (pass.lights.is_first()) leaves_ = 0, passes_ = 0;
  std::vector<View> views;
  first_.assign(lights_->blocks(), 0);
  for (std::size_t b = pass.lights.first; b < std::min(pass.lights.end, lights_->blocks()); ++b) {
    first_[b] = static_cast<std::uint32_t>(views.size());
    if (lights_->geometry(b, 0).infinite) continue;
    for (int i = 0; i < lights_->count(b); ++i) {
      const VplGeometry p = lights_->geometry(b, i);
      views.push_back({p.x + p.n * (before_surface * cell_), p.n});
    }
  }
  const bool single =
      settings_.share == ViewSharing::none && settings_.method != ViewMapMethod::megaviews;
  const auto split =
      settings_.split == ViewSplit::facing ? ViewTree::Split::facing : ViewTree::Split::position;
  views_ = std::make_unique<ViewTree>(
      single ? ViewTree::of_single_views(views)
             : ViewTree(views, cube_.levels, cube_.corner, cube_.side, split));
  passes.begin("view map memory", memory_seconds_);
  leaves_ += views_->leaf_count();
  ++passes_;
  if (!descends()) maps_->resize(views_->leaf_count());
  passes.begin("view maps", map_seconds_);
  Counters counters;
  const auto take = [&](std::uint32_t leaf, std::span<const float> depths) {
    if (leaf % maps_between_stops == 0 && pass.context.stop()) throw IterationStopped{};
    maps_->set(leaf, depths);
  };
  const ThreadPool& pool = pass.context.pool;
  if (settings_.method == ViewMapMethod::per_view) {
    counters.rays += trace_views(pass.context.scene.rays(), *views_, texels_,
                                 settings_.rays == ViewRays::packets, pool, take);
  } else {
    const ManyViewsSettings settings{
        .map_size = settings_.map_size,
        .node_texels = static_cast<float>(settings_.node_texels),
        .cover = static_cast<float>(settings_.cover),
        .share = settings_.method == ViewMapMethod::megaviews,
        .merge = settings_.method != ViewMapMethod::per_view_splats,
        .cull = settings_.cull,
        .boxes = settings_.bounds == ViewBounds::boxes,
        .mips = settings_.filling == ViewFilling::mips,
        .breadth_first = settings_.traversal == ViewTraversal::breadth_first};
    ManyViewsCounts counts;
    unfused_.reset();
    if (descends()) {
      unfused_.emplace(render_unfused(*scene_, *views_, settings, pool, counts));
    } else {
      counts = render_views(*scene_, *views_, settings, pool, take);
    }
    queue_peak_ = std::max(queue_peak_, counts.queue_peak());
    counts_ += counts;
  }
  return counters;
}

float ViewMapVisibility::nearness(std::uint32_t leaf, int texel, Queries& queries) const {
  ++queries.asked;
  if (unfused_) return maps_->coded(unfused_->distance(leaf, texel, queries.read));
  ++queries.read;
  return maps_->nearness(leaf, texel);
}

bool ViewMapVisibility::sees(std::uint32_t leaf, const At& at, Queries& queries) const {
  const V3f d = at.x - views_->node(views_->first_leaf() + leaf).centre;
  const bool rays = settings_.method == ViewMapMethod::per_view;
  // The centres of the surface's leaves lie up to a radius in front of it.
  const float h = -d.dot(at.n) - (rays ? 0 : cell_);
  if (!(h > 0)) return true;
  const int texel = maps_->map().texel(d);
  const MapTexel& t = texels_[static_cast<std::size_t>(texel)];
  // 1 / distance of the surface's plane at the centre of the texel, as rendered by a ray, or by a
  // node that covers the centre. Occluders closer by less than half the texel's width, or half the
  // width of the largest node rendered as one splat, count as lying on the plane.
  const double width = rays ? 1 : std::max(1.0, settings_.node_texels);
  const float inverse = -t.direction.dot(at.n) * static_cast<float>(1 + width / settings_.map_size);
  return maps_->scale() * inverse >= nearness(leaf, texel, queries) * h;
}

void ViewMapVisibility::decide(const At& at, std::size_t block, const Terms& terms,
                               VisibilityEstimate& d) const {
  if (lights_->geometry(block, 0).infinite) return test_all(terms, d);
  d.tests = 0;
  d.untested.v.fill(0);
  Queries queries;
  for_each_bit(terms.lit, [&](int i) {
    const std::uint32_t leaf = views_->leaf_of(first_[block] + static_cast<std::size_t>(i));
    d.untested[i] = sees(leaf, at, queries) ? 1.0F : 0.0F;
  });
  if (!unfused_) return;
  asked_.fetch_add(queries.asked, std::memory_order_relaxed);
  read_.fetch_add(queries.read, std::memory_order_relaxed);
}

std::vector<std::pair<std::string, double>> ViewMapVisibility::statistics() const {
  if (!views_) return {};
  const auto number = [](auto n) { return static_cast<double>(n); };
  const auto splats = number(std::max<std::uint64_t>(1, counts_.splats));
  std::vector<std::pair<std::string, double>> stats{
      {"scene_leaves", number(scene_ ? scene_->leaf_count() : 0)},
      {"view_leaves", number(leaves_)},
      {"view_passes", number(passes_)},
      {"view_map_bytes", number(maps_->bytes())},
      {"view_scene_cpu_seconds", scene_seconds_},
      {"view_tree_cpu_seconds", tree_seconds_},
      {"view_memory_cpu_seconds", memory_seconds_},
      {"view_map_cpu_seconds", map_seconds_},
      {"view_pairs", number(counts_.pairs)},
      {"view_pairs_culled", number(counts_.culled)},
      {"view_splats", number(counts_.splats)},
      {"view_splats_large", number(counts_.large)},
      {"view_splats_large_shared", number(counts_.shared)},
      {"view_texels_filled", number(counts_.filled)},
      {"views_sharing_a_splat", number(counts_.sharing) / splats},
      {"view_queue_peak_pairs", number(queue_peak_)}};
  if (counts_.queue_bytes > 0) {
    stats.emplace_back("view_queue_bytes", number(counts_.queue_bytes));
    stats.emplace_back("view_unfused_bytes", number(counts_.unfused_bytes));
    stats.emplace_back("view_fusion_cpu_seconds", counts_.fusion_seconds);
  }
  if (descends()) {
    stats.emplace_back("view_queries", number(asked_.load()));
    stats.emplace_back("view_texels_queried", number(read_.load()));
  }
  return stats;
}

}  // namespace lacuna
