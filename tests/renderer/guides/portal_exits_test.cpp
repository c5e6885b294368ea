// The portals that rays are sent through, against all simple paths over the regions, and which of
// the two choices of a portal is which.

#include "renderer/guides/portal_exits.h"

#include <gtest/gtest.h>

#include <map>
#include <random>

#include "renderer/guides/portal_faces.h"
#include "tests/renderer/guides/guided_scene.h"
#include "tests/renderer/path/scenes.h"

namespace lacuna {
namespace {

/// Regions at random places, and portals about halfway between some of them. The last region is
/// alone.
struct RandomRegions {
  RandomRegions(std::uint32_t n, std::mt19937& random) {
    std::uniform_real_distribution<double> place(0, 40), off(-3, 3);
    for (std::uint32_t i = 0; i < n; ++i)
      centres.emplace_back(place(random), place(random), place(random));
    std::vector<std::vector<std::uint32_t>> of(n);
    for (std::uint32_t a = 0; a + 1 < n; ++a) {
      for (std::uint32_t b = a + 1; b + 1 < n; ++b) {
        if (random() % 2 == 0) continue;
        for (const std::uint32_t r : {a, b})
          of[r].push_back(static_cast<std::uint32_t>(portals.portals.size()));
        portals.portals.push_back({.a = a, .b = b});
        middles.push_back((centres[a] + centres[b]) * 0.5 +
                          V3d(off(random), off(random), off(random)));
      }
    }
    portals.first.push_back(0);
    for (const auto& its : of) {
      portals.of_region.insert(portals.of_region.end(), its.begin(), its.end());
      portals.first.push_back(static_cast<std::uint32_t>(portals.of_region.size()));
    }
  }
  PortalGraph graph() const { return {portals, centres, middles}; }

  std::vector<V3d> centres, middles;
  Portals portals;
};

/// The portals of a path, and its length.
struct RegionPath {
  std::vector<std::uint32_t> portals;
  double length = HUGE_VAL;
};

/// Lengthens `path`, which ends in `at` and has come through `visited`, in every way, and keeps the
/// shortest to each region.
void try_all_paths(const RandomRegions& g, std::uint32_t at, const RegionPath& path,
                   std::vector<bool> visited, std::vector<RegionPath>& shortest) {
  if (path.length < shortest[at].length) shortest[at] = path;
  visited[at] = true;
  for (std::uint32_t p = 0; p < g.portals.portals.size(); ++p) {
    const auto [a, b] = std::pair(g.portals.portals[p].a, g.portals.portals[p].b);
    if (a != at && b != at) continue;
    const std::uint32_t next = a == at ? b : a;
    if (visited[next]) continue;
    RegionPath longer = path;
    longer.portals.push_back(p);
    longer.length += (g.middles[p] - g.centres[at]).length();
    longer.length += (g.centres[next] - g.middles[p]).length();
    try_all_paths(g, next, longer, visited, shortest);
  }
}

/// Of a portal on a path, whether a region sees it.
using SeesPortal = std::function<bool(std::uint32_t)>;

/// The sums of f / d^2 of each exit portal, target by target.
std::map<std::uint32_t, double> weights_by_definition(const RandomRegions& g, std::uint32_t region,
                                                      const std::vector<double>& power,
                                                      double least, const SeesPortal& sees) {
  std::vector<RegionPath> shortest(g.centres.size());
  try_all_paths(g, region, {{}, 0}, std::vector<bool>(g.centres.size()), shortest);
  std::map<std::uint32_t, double> weights;
  for (std::uint32_t target = 0; target < g.centres.size(); ++target) {
    const RegionPath& path = shortest[target];
    if (target == region || path.length == HUGE_VAL || power[target] == 0) continue;
    std::size_t seen = 0;
    while (seen < path.portals.size() && sees(path.portals[seen])) ++seen;
    const std::uint32_t exit = path.portals[seen == 0 ? 0 : seen - 1];
    const double d = std::max(path.length, least);
    weights[exit] += power[target] / (d * d);
  }
  return weights;
}

TEST(PortalExits, AreThoseOfAllShortestPaths) {
  std::mt19937 random(5);
  int none = 0, beyond = 0, near = 0;
  for (int round = 0; round < 60; ++round) {
    const RandomRegions g(8, random);
    std::vector<double> power(g.centres.size());
    for (double& f : power) f = random() % 3 == 0 ? double(random() % 1000) : 0.0;
    power.back() = 5;                       // out of reach
    for (const int often : {0, 1, 3, 4}) {  // of four portals, how many a region sees
      for (std::uint32_t region = 0; region < g.centres.size(); ++region) {
        const double least = 1 + double(random() % 40);
        const SeesPortal sees = [&](std::uint32_t p) {
          return int((region * 7 + p * 13 + p / 3) % 4) < often;
        };
        const auto expected = weights_by_definition(g, region, power, least, sees);
        const PortalExits found = find_portal_exits(g.graph(), region, power, least, sees);
        double sum = 0;
        for (const auto& [portal, weight] : expected) sum += weight;
        ASSERT_EQ(found.exits.size(), expected.size());
        for (const PortalExits::Exit& e : found.exits) {
          ASSERT_TRUE(expected.contains(e.portal));
          const double share = expected.at(e.portal) / sum;
          EXPECT_NEAR(e.share, share, 1e-12 * share);
          const Portal& p = g.portals.portals[e.portal];
          beyond += p.a != region && p.b != region ? 1 : 0;
          EXPECT_TRUE(often > 0 || p.a == region || p.b == region);
        }
        const double own = power[region] / (least * least);
        const double mass = sum > 0 ? sum / (sum + own) : 0;
        EXPECT_NEAR(found.mass, mass, 1e-12);
        none += sum > 0 ? 0 : 1;
        near += own > 0 && sum > 0 ? 1 : 0;
      }
    }
  }
  EXPECT_GT(none, 100) << "regions without any light elsewhere";
  EXPECT_GT(beyond, 500) << "exits that are not on the region's border";
  EXPECT_GT(near, 100) << "regions with light of their own";
}

// A region's own distance bounds all others.
TEST(PortalExits, AreNoNearerThanTheLeastDistance) {
  std::mt19937 random(6);
  RandomRegions g(3, random);
  g.portals.portals = {{.a = 0, .b = 1}};
  g.portals.first = {0, 1, 2, 2};
  g.portals.of_region = {0, 0};
  g.centres = {V3d(0, 0, 0), V3d(2, 0, 0), V3d(50, 0, 0)};
  g.middles = {V3d(1, 0, 0)};
  const auto mass = [&](double least) {
    const std::vector<double> power{3, 5, 7};
    return find_portal_exits(g.graph(), 0, power, least, [](std::uint32_t) { return true; }).mass;
  };
  EXPECT_NEAR(mass(1), (5 / 4.0) / (5 / 4.0 + 3), 1e-14);
  EXPECT_NEAR(mass(2), 5 / 8.0, 1e-14);
  EXPECT_NEAR(mass(10), 5 / 8.0, 1e-14);
}

/// The exits of a region, as the guide's density sums over them.
FaceParts exits_of(const PortalFaces& faces, std::uint32_t region) {
  FaceParts parts;
  faces.add_parts(region, V3d(0.0), 1.0, parts);
  return parts;
}

TEST(PortalFaces, SendRaysThroughTheNextPortalOrTheLastOneSeen) {
  int guided = 0, own = 0, beyond = 0, lit = 0;
  for (const char* name : {"ajar", "bends", "atrium"}) {
    SCOPED_TRACE(name);
    PortalsGuideSettings settings;
    test::GuidedScene scene([&] { return load(test::PathScene{name}); }, settings, 0, std::nullopt);
    SpaceAnalysis& space = scene.context().space;
    const RegionLabels& labels = space.regions();
    const Portals& portals = space.portals();
    const SurfaceLookup lookup(space.voxels().transform, labels.label);
    for (const PortalChoice choice : {PortalChoice::next, PortalChoice::last}) {
      settings.portal = choice;
      PortalFaces faces(settings);
      faces.prepare(scene.context(), lookup);
      for (std::uint32_t r = 0; r < labels.regions.size(); ++r) {
        EXPECT_GE(faces.mass(r), 0);
        EXPECT_LE(faces.mass(r), 1);
        lit += faces.mass(r) > 0 && faces.mass(r) < 1 ? 1 : 0;
        double sum = 0;
        for (const FacePart& part : exits_of(faces, r)) {
          const Portal& p = portals.portals[part.index];
          sum += part.weight * static_cast<double>(p.faces());
          const bool on_border = p.a == r || p.b == r;
          ++(on_border ? own : beyond);
          EXPECT_TRUE(on_border || choice == PortalChoice::last) << "region " << r;
        }
        EXPECT_NEAR(sum, faces.mass(r) > 0 ? 1 : 0, 1e-12);
        guided += faces.mass(r) > 0 ? 1 : 0;
      }
    }
  }
  EXPECT_GT(guided, 10);
  EXPECT_GT(lit, 2);
  EXPECT_GT(own, 10);
  EXPECT_GT(beyond, 5);
}

}  // namespace
}  // namespace lacuna
