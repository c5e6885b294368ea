#include "renderer/guides/portal_exits.h"

#include <map>

#include "renderer/guides/shortest_paths.h"

namespace lacuna {

PortalExits find_portal_exits(const PortalGraph& graph, std::uint32_t region,
                              std::span<const double> power, double least_distance,
                              const std::function<bool(std::uint32_t)>& sees) {
  const std::span<const V3d> centres = graph.centres, middles = graph.middles;
  ShortestPaths paths(centres.size());                 // their edges are portals
  std::vector<std::uint32_t> exit(centres.size(), 0);  // the portal to aim at
  std::vector<char> visible(centres.size(), 0);        // all portals on the way are visible
  std::map<std::uint32_t, double> by_portal;
  double elsewhere = 0;
  const auto other_side = [&](std::uint32_t portal, std::uint32_t of) {
    const Portal& p = graph.portals.portals[portal];
    return p.a == of ? p.b : p.a;
  };
  paths.find(region, [&](std::uint32_t at, double d, const auto& reach) {
    if (at != region) {
      const std::uint32_t last = paths.last[at], before = other_side(last, at);
      const bool first = before == region;
      visible[at] = (first || visible[before] != 0) && sees(last) ? 1 : 0;
      exit[at] = first || visible[at] != 0 ? last : exit[before];
      if (power[at] > 0) {
        const double length = std::max(d, least_distance);
        const double weight = power[at] / (length * length);
        by_portal[exit[at]] += weight;
        elsewhere += weight;
      }
    }
    for (const std::uint32_t p : graph.portals.of(at)) {
      const std::uint32_t next = other_side(p, at);
      reach(next, d + (middles[p] - centres[at]).length() + (centres[next] - middles[p]).length(),
            p);
    }
  });
  PortalExits exits;
  if (!(elsewhere > 0)) return exits;
  exits.mass = elsewhere / (elsewhere + power[region] / (least_distance * least_distance));
  for (const auto& [p, weight] : by_portal) exits.exits.push_back({p, weight / elsewhere});
  return exits;
}

}  // namespace lacuna
