#pragma once

#include <functional>
#include <span>
#include <vector>

#include "analysis/regions/portals.h"
#include "renderer/core/vec.h"

namespace lacuna {

/// The regions of the empty space as nodes of a graph whose edges are the portals.
struct PortalGraph {
  const Portals& portals;
  std::span<const V3d> centres;  ///< of the regions, voxels
  std::span<const V3d> middles;  ///< of the portals, voxels
};

/// The portals that rays from one region are sent through.
struct PortalExits {
  struct Exit {
    std::uint32_t portal;
    double share;  ///< > 0; all of them add up to 1
  };
  std::vector<Exit> exits;  ///< by portal, ascending
  double mass = 0;  ///< share of the region's light that comes from other regions, in [0, 1]
};

/// Finds the exits of `region`. A shortest path, from centre to portal to centre, leads to every
/// other region; one portal on each has the weight f / d^2, f = `power` of the region at its end
/// and d the path's length (Noel 2015, 10.4.1 and eq. 164): the last one up to which all are seen,
/// or the first where that is not seen. The region's own power has the distance `least_distance`,
/// and no distance is less; > 0, voxels. `sees(portal)` is called only where all portals before it
/// on the path are seen: if it is always false, rays are sent through the first portal.
PortalExits find_portal_exits(const PortalGraph& graph, std::uint32_t region,
                              std::span<const double> power, double least_distance,
                              const std::function<bool(std::uint32_t)>& sees);

}  // namespace lacuna
