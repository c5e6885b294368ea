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

/// The portals through which rays from one region are sent.
struct PortalExits {
  struct Exit {
    std::uint32_t portal;
    double share;  ///< probability, > 0; the sum over all exits is 1
  };
  std::vector<Exit> exits;  ///< in ascending order of `portal`
  double mass = 0;  ///< fraction of the region's light that comes from other regions, in [0, 1]
};

/// Finds the exits of `region`. A shortest path, from centre to portal to centre, leads to every
/// other region. One portal on each path gets the weight f / d^2, with f = `power` of the region at
/// its end and d the path's length (Noel 2015, 10.4.1 and eq. 164): the last portal up to which all
/// are visible, or the first portal if it is not visible. The region's own power has the distance
/// `least_distance` > 0, voxels, the lower bound of all distances. `sees(portal)` is called only if
/// all earlier portals of the path are visible; if it is always false, rays are sent through the
/// first portal.
PortalExits find_portal_exits(const PortalGraph& graph, std::uint32_t region,
                              std::span<const double> power, double least_distance,
                              const std::function<bool(std::uint32_t)>& sees);

}  // namespace lacuna
