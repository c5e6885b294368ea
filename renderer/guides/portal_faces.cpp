#include "renderer/guides/portal_faces.h"

#include <cmath>

#include "renderer/core/scene_error.h"
#include "renderer/guides/arriving_power.h"
#include "renderer/guides/named_region.h"
#include "renderer/guides/portal_exits.h"

namespace lacuna {

namespace {

/// The portals of the regions in a grid of labels.
struct PortalGrid {
  const Portals& portals;
  const Grid3<std::uint32_t>& label;
  GridTransform transform;

  /// The centre of face `i` of a portal, in voxels.
  V3d face_centre(const Portal& portal, std::uint64_t i) const {
    const VoxelFace face = portals.face(portal, i);
    return face.point(label.voxel(face.voxel), 0.5, 0.5);
  }
};

V3d middle(const PortalGrid& grid, const Portal& portal) {
  V3d sum(0.0);
  for (std::uint64_t i = 0; i < portal.faces(); ++i) sum += grid.face_centre(portal, i);
  return sum / static_cast<double>(portal.faces());
}

/// The bounds of the voxels on both sides of the portal's faces.
VoxelBox box_around(const PortalGrid& grid, const Portal& portal) {
  VoxelBox box;
  for (std::uint64_t i = 0; i < portal.faces(); ++i) {
    const VoxelFace face = grid.portals.face(portal, i);
    const Imath::V3i voxel = grid.label.voxel(face.voxel);
    box.add(voxel);
    box.add(voxel + Imath::V3i(face.normal()));
  }
  return box;
}

/// The squared distance of `x`, in voxels, from the nearest point of a portal.
double squared_distance(const PortalGrid& grid, const Portal& portal, const V3d& x) {
  double least = HUGE_VAL;
  for (std::uint64_t i = 0; i < portal.faces(); ++i) {
    const int axis = grid.portals.face(portal, i).axis();
    V3d apart = x - grid.face_centre(portal, i);
    for (int a = 0; a < 3; ++a) {  // half a voxel to each side, but flat along its axis
      apart[a] = std::max(0.0, std::abs(apart[a]) - (a == axis ? 0.0 : 0.5));
    }
    least = std::min(least, apart.length2());
  }
  return least;
}

/// The portal nearest to a point of the empty space, the first if several are equally near. Throws
/// SceneError.
std::uint32_t nearest_portal(const PortalGrid& grid, const NamedRegion& place) {
  const std::vector<Portal>& all = grid.portals.portals;
  if (all.empty()) {
    throw SceneError(
        "guide: \"through\" selects no portal: the empty space has none at this resolution");
  }
  std::uint32_t nearest = 0;
  double least = HUGE_VAL;
  for (std::uint32_t p = 0; p < all.size(); ++p) {
    const double distance = squared_distance(grid, all[p], place.point);
    if (distance < least) least = distance, nearest = p;
  }
  return nearest;
}

/// Whether at least half of a portal is visible from `eye`, voxels, tested at some of its faces.
bool mostly_visible(const RayCaster& rays, const V3d& eye, const PortalGrid& grid,
                    const Portal& portal) {
  // Called for each pair of region and portal: stops as soon as the result is decided.
  constexpr std::uint64_t most_tried = 16;
  const std::uint64_t tried = std::min(portal.faces(), most_tried);
  const V3f from(grid.transform.to_world(eye));
  std::uint64_t seen = 0;
  for (std::uint64_t k = 0; k < tried; ++k) {
    const std::uint64_t face = (2 * k + 1) * portal.faces() / (2 * tried);
    const V3d to = grid.transform.to_world(grid.face_centre(portal, face));
    if (!rays.occluded({from, V3f(to) - from, 1.0F})) ++seen;
    if (2 * seen >= tried) return true;
    if (2 * (seen + tried - k - 1) < tried) return false;
  }
  return false;
}

/// The centre of each region's voxels.
std::vector<V3d> centres_of(const RegionLabels& labels) {
  std::vector<V3d> centres(labels.regions.size(), V3d(0.0));
  for (std::size_t i = 0; i < labels.label.count(); ++i) {
    if (labels.label[i] != no_region) {
      centres[labels.label[i]] += V3d(labels.label.voxel(i)) + V3d(0.5);
    }
  }
  for (std::size_t r = 0; r < centres.size(); ++r) {
    centres[r] /= static_cast<double>(labels.regions[r].voxels);
  }
  return centres;
}

}  // namespace

void PortalFaces::prepare(const PrepareContext& context, const SurfaceLookup& lookup) {
  const RegionLabels& labels = context.space.regions();
  portals_ = &context.space.portals();
  const PortalGrid grid{*portals_, labels.label, context.space.voxels().transform};
  voxel_size_ = grid.transform.voxel_size;
  for (const Portal& p : portals_->portals) {
    middles_.push_back(middle(grid, p));
    boxes_.push_back(box_around(grid, p));
  }
  if (settings_.through) {
    const std::uint32_t p = nearest_portal(grid, named_region(*settings_.through, context));
    const double each = 1 / static_cast<double>(portals_->portals[p].faces());
    exits_.assign(labels.regions.size(), {.exits = {{p, 1, each}}, .mass = 1});
  } else {
    find_all_exits(context, lookup);
  }
}

void PortalFaces::find_all_exits(const PrepareContext& context, const SurfaceLookup& lookup) {
  const RegionLabels& labels = context.space.regions();
  const PortalGrid grid{*portals_, labels.label, context.space.voxels().transform};
  const std::size_t regions = labels.regions.size();
  std::vector<double> power(regions, 0.0);
  if (settings_.paths == PortalPaths::lit_regions) {
    power = arriving_power(context.scene, lookup, regions, settings_.light_rays, context.pool);
  } else if (regions > 0) {  // with one destination, all paths lead there, and have mass 1
    power[brightest_part(context.scene, lookup, regions, settings_.light_rays, context.pool)] = 1;
  }
  const std::vector<V3d> centres = centres_of(labels);
  exits_.resize(labels.regions.size());
  context.pool.for_each(static_cast<int>(exits_.size()), [&](int i) {
    const auto r = static_cast<std::uint32_t>(i);
    const V3d eye = V3d(labels.label.voxel(labels.regions[r].root)) + V3d(0.5);
    const auto sees = [&](std::uint32_t p) {
      return settings_.portal == PortalChoice::last &&
             mostly_visible(context.scene.rays(), eye, grid, portals_->portals[p]);
    };
    const double own_size = std::max(1.0, double(labels.regions[r].opening));
    const PortalExits found =
        find_portal_exits({*portals_, centres, middles_}, r, power, own_size, sees);
    exits_[r].mass = found.mass;
    for (const auto& [p, share] : found.exits) {
      const double each = share / static_cast<double>(portals_->portals[p].faces());
      exits_[r].exits.push_back({p, share, each});
    }
  });
}

VoxelFace PortalFaces::sample_face(std::uint32_t region, const V3d&, Rng& rng) const {
  const std::vector<Exit>& exits = exits_[region].exits;
  double left = rng.next_choice();
  std::size_t i = 0;
  while (i + 1 < exits.size() && left >= exits[i].share) left -= exits[i++].share;
  const Portal& portal = portals_->portals[exits[i].portal];
  return portals_->face(portal, rng.below(portal.faces()));
}

std::vector<std::pair<std::string, double>> PortalFaces::statistics() const {
  std::size_t guided = 0, exits = 0;
  for (const Exits& e : exits_) {
    guided += e.mass > 0 ? 1 : 0;
    exits += e.exits.size();
  }
  std::vector<std::pair<std::string, double>> all{
      {"regions", static_cast<double>(exits_.size())},
      {"portals", static_cast<double>(middles_.size())},
      {"guided_regions", static_cast<double>(guided)},
      {"exits_mean", guided > 0 ? static_cast<double>(exits) / static_cast<double>(guided) : 0}};
  if (settings_.through) {
    const Portal& portal = portals_->portals[exits_.front().exits.front().portal];
    all.emplace_back("through_area",
                     static_cast<double>(portal.faces()) * voxel_size_ * voxel_size_);
  }
  return all;
}

}  // namespace lacuna
