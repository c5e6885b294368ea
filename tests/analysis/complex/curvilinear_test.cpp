#include "analysis/complex/curvilinear.h"

#include <gtest/gtest.h>

#include <map>
#include <tuple>

#include "analysis/complex/invariants.h"
#include "analysis/space/distance.h"
#include "analysis/space/memory_limit.h"
#include "analysis/space/opening.h"
#include "analysis/space/opening_query.h"
#include "tests/analysis/complex/literal_collapse.h"
#include "tests/analysis/complex/random_voxels.h"

namespace lacuna {
namespace {

using testing::LiteralComplex;
using testing::random_voxels;

/// Everything that thinning is given for a domain.
struct Space {
  BitGrid3 domain;
  Grid3<std::uint16_t> distance;
  OpeningQuery opening;
  SpaceMaps maps;

  explicit Space(BitGrid3 d)
      : domain(std::move(d)),
        distance(l1_distance(domain, ThreadPool(1), no_memory_limit)),
        opening(distance, ThreadPool(1)),
        maps{distance, [this](Imath::V3i v, int r) { return opening.reaches(v, r); }} {}
  Space(const Space&) = delete;
};

BitGrid3 box_with_hole(Imath::V3i size, Imath::V3i low, Imath::V3i high) {
  BitGrid3 g(size);
  for (int z = 0; z < size.z; ++z) {
    for (int y = 0; y < size.y; ++y) {
      for (int x = 0; x < size.x; ++x) {
        const bool hole =
            x >= low.x && y >= low.y && z >= low.z && x < high.x && y < high.y && z < high.z;
        if (!hole) g.set(x, y, z);
      }
    }
  }
  return g;
}

std::vector<BitGrid3> domains() {
  std::vector<BitGrid3> all;
  for (unsigned seed = 1; seed <= 6; ++seed) {
    all.push_back(random_voxels({40, 33, 26}, 0.002 * seed, 5, seed));
    all.push_back(random_voxels({19, 20, 21}, 0.15 * seed, 0, seed));
  }
  all.push_back(box_with_hole({31, 30, 29}, {12, 13, 14}, {15, 16, 17}));
  all.push_back(box_with_hole({60, 20, 20}, {30, 0, 0}, {31, 20, 8}));
  return all;
}

TEST(CurvilinearSkeleton, KeepsTheTopologyUntilItIsPierced) {
  for (const BitGrid3& domain : domains()) {
    const Space s(domain);
    const CubicalComplex whole(domain);
    ThinningReport report;
    const auto [thinned, kept] = thin(domain, s.maps, report);
    const Topology before = topology(whole);
    EXPECT_EQ(topology(thinned), before);
    EXPECT_EQ(thinned.count(3), 0u);
    // Thinning what is thin changes nothing.
    CubicalComplex again = thinned;
    EXPECT_EQ(collapse(again, kept), 0);

    const CubicalComplex graph = curvilinear_skeleton(domain, s.maps, report);
    EXPECT_EQ(graph.count(2) + graph.count(3), 0u);
    const Topology after = topology(graph);
    EXPECT_EQ(after.components, before.components);
    EXPECT_EQ(after.cavities, 0);
    EXPECT_EQ(after.tunnels, before.tunnels);  // opening a cavity makes no tunnel
    EXPECT_GE(report.squares_pierced, static_cast<std::size_t>(before.cavities));
  }
}

TEST(CurvilinearSkeleton, GoesRoundAFloatingObject) {
  // A passage into a room, where a block floats at the far end. With the kept edges alone the
  // surface around the block would shrink to the point where the curve meets it: no node would lie
  // beside the block, nor behind it.
  const Imath::V3i size(81, 25, 25), middle(68, 12, 12);
  BitGrid3 domain(size);
  for (int z = 0; z < size.z; ++z) {
    for (int y = 0; y < size.y; ++y) {
      for (int x = 0; x < size.x; ++x) {
        const int across = std::max(std::abs(y - middle.y), std::abs(z - middle.z));
        const bool block = std::max(across, std::abs(x - middle.x)) <= 3;
        if ((x >= 40 || across <= 4) && !block) domain.set(x, y, z);
      }
    }
  }
  const Space s(std::move(domain));
  ThinningReport report;
  const CubicalComplex graph = curvilinear_skeleton(s.domain, s.maps, report);
  EXPECT_EQ(report.pierce_rounds, 1);
  EXPECT_EQ(report.squares_pierced, 1u);
  std::array<int, 3> nodes{};  // before the block, beside it, behind it
  for (int z = 0; z <= size.z; ++z) {
    for (int y = 0; y <= size.y; ++y) {
      for (int x = 0; x <= size.x; ++x) {
        if (graph.has({x, y, z}, 0)) ++nodes[x < middle.x - 3 ? 0 : x <= middle.x + 4 ? 1 : 2];
      }
    }
  }
  EXPECT_GT(nodes[0], 0);
  EXPECT_GT(nodes[1], 0);
  EXPECT_GT(nodes[2], 0);
}

/// The rule of Alg. 3 by its words: dates from the literal collapse, openings from all balls.
std::map<std::tuple<int, int, int, int>, bool> literal_rule(const BitGrid3& domain,
                                                            const Grid3<std::uint16_t>& d) {
  const Imath::V3i n = domain.size();
  const auto opening = [&](Imath::V3i x) {
    int best = 0;
    for (std::size_t i = 0; i < d.count(); ++i) {
      const Imath::V3i y = d.voxel(i);
      const int gap = std::abs(x.x - y.x) + std::abs(x.y - y.y) + std::abs(x.z - y.z);
      if (gap < d[i]) best = std::max<int>(best, d[i]);
    }
    return best;
  };
  struct Dates {
    int birth = -1, death = -1;
  };
  std::map<std::tuple<int, int, int, int>, Dates> dates;
  LiteralComplex x{CubicalComplex(domain)};
  int date = 0;
  do {
    for (int cz = 0; cz <= n.z; ++cz) {
      for (int cy = 0; cy <= n.y; ++cy) {
        for (int cx = 0; cx <= n.x; ++cx) {
          for (int axis = 0; axis < 3; ++axis) {
            const bool there = x.has({cx, cy, cz}, 1 << axis);
            if (date == 0 && !there) continue;
            if (date > 0 && !dates.contains({cx, cy, cz, axis})) continue;
            Dates& t = dates[{cx, cy, cz, axis}];
            if (t.birth < 0 && (!there || x.is_facet({cx, cy, cz}, 1 << axis))) t.birth = date;
            if (t.death < 0 && !there) t.death = date;
          }
        }
      }
    }
    ++date;
  } while (x.layer([](Imath::V3i, FaceType) { return false; }));
  std::map<std::tuple<int, int, int, int>, bool> kept;
  for (const auto& [edge, t] : dates) {
    const auto& [cx, cy, cz, axis] = edge;
    if (t.birth < 0) continue;  // never a facet: an edge of a closed surface
    int most = 0, decenterness = 0;
    for (int i = 0; i < 4; ++i) {
      Imath::V3i v(cx, cy, cz);
      v[(axis + 1) % 3] -= i & 1;
      v[(axis + 2) % 3] -= i >> 1;
      if (!in_grid(v, n) || d(v) == 0) continue;
      most = std::max<int>(most, d(v));
      decenterness = std::max(decenterness, opening(v) - d(v));
    }
    if (t.death < 0 || t.death - t.birth > decenterness + t.birth - most) kept[edge] = true;
  }
  return kept;
}

TEST(KeepRule, IsLine1OfAlgorithm3) {
  std::size_t some = 0;
  for (unsigned seed = 1; seed <= 3; ++seed) {
    const Space s(random_voxels({13, 12, 11}, 0.006 * seed, 3, seed));
    const CubicalComplex whole(s.domain);
    ThinningReport report;
    const KeptEdges kept = thin(s.domain, s.maps, report).kept;
    std::map<std::tuple<int, int, int, int>, bool> found;
    for (std::size_t b = 0; b < whole.block_count(); ++b) {
      for (int axis = 0; axis < 3; ++axis) {
        for_each_bit(kept.of(b).edges[static_cast<std::size_t>(axis)], [&](int position) {
          const Imath::V3i c = whole.corner(b) + cell_of(position);
          found[{c.x, c.y, c.z, axis}] = true;
        });
      }
    }
    EXPECT_EQ(found, literal_rule(s.domain, s.distance));
    some += found.size();
  }
  EXPECT_GT(some, 10u);
}

TEST(CurvilinearSkeleton, CommutesWithTranslation) {
  std::size_t pierced = 0;
  for (unsigned seed = 1; seed <= 12; ++seed) {
    const Imath::V3i size(22, 19, 20), shift(3, 5, 6), room(31, 30, 29);
    const BitGrid3 small = random_voxels(size, 0.02, 3, seed);
    // Both lie inside a larger grid, so that neither meets its end.
    BitGrid3 a(room), b(room);
    for (int z = 0; z < size.z; ++z) {
      for (int y = 0; y < size.y; ++y) {
        for (int x = 0; x < size.x; ++x) {
          if (!small.get(x, y, z)) continue;
          a.set(x + 1, y + 1, z + 1);
          b.set(Imath::V3i(x + 1, y + 1, z + 1) + shift);
        }
      }
    }
    ThinningReport report;
    const Space sa(a), sb(b);
    const CubicalComplex ga = curvilinear_skeleton(a, sa.maps, report);
    const CubicalComplex gb = curvilinear_skeleton(b, sb.maps, report);
    pierced += report.squares_pierced;
    EXPECT_EQ(ga.count(0), gb.count(0));
    for (int z = 0; z <= size.z + 1; ++z) {
      for (int y = 0; y <= size.y + 1; ++y) {
        for (int x = 0; x <= size.x + 1; ++x) {
          for (const FaceType m : {0, 1, 2, 4}) {
            ASSERT_EQ(ga.has({x, y, z}, m), gb.has(Imath::V3i(x, y, z) + shift, m)) << seed;
          }
        }
      }
    }
  }
  EXPECT_GT(pierced, 10u);
}

TEST(CurvilinearSkeleton, IsTheSameForAnyNumberOfThreads) {
  // Long enough for layers to overlap.
  for (const Imath::V3i& size : {Imath::V3i(40, 300, 30), Imath::V3i(20, 30, 330)}) {
    const Space s(random_voxels(size, 0.0004, 9, 3));
    ThinningReport alone;
    const CubicalComplex expected = curvilinear_skeleton(s.domain, s.maps, alone);
    EXPECT_GT(expected.count(0), 50u);
    for (const int threads : {1, 2, 3, 5}) {
      const ThreadPool some(threads);
      ThinningReport report;
      EXPECT_TRUE(curvilinear_skeleton(s.domain, s.maps, report, &some) == expected) << threads;
      EXPECT_EQ(report.kept_edges, alone.kept_edges);
      EXPECT_EQ(report.layers, alone.layers);
    }
  }
}

TEST(CurvilinearSkeleton, KeepsTheTopologyByTheOtherDistanceToo) {
  const ThreadPool one(1);
  std::size_t differ = 0;
  for (const BitGrid3& domain : domains()) {
    const auto distance = chebyshev_distance(domain, one, no_memory_limit);
    const auto opening = opening_forest(distance, one, no_memory_limit).opening;
    const SpaceMaps maps{distance, [&](Imath::V3i v, int r) { return opening(v) >= r; }};
    ThinningReport report, by_l1;
    EXPECT_EQ(topology(thin(domain, maps, report).complex), topology(CubicalComplex(domain)));
    const CubicalComplex graph = curvilinear_skeleton(domain, maps, report);
    EXPECT_EQ(graph.count(2) + graph.count(3), 0u);
    const Space s(domain);
    if (!(graph == curvilinear_skeleton(domain, s.maps, by_l1))) ++differ;
  }
  EXPECT_GT(differ, 5u);
}

TEST(CurvilinearSkeleton, RefusesBeforeItAllocates) {
  const Space s(box_with_hole({31, 30, 29}, {12, 13, 14}, {15, 16, 17}));
  ThinningReport report;
  try {
    curvilinear_skeleton(s.domain, s.maps, report, nullptr, 100'000);
    FAIL() << "it allowed itself more";
  } catch (const MemoryLimitError& e) {
    EXPECT_NE(std::string(e.what()).find("thinning of a grid of 31 x 30 x 29 voxels"),
              std::string::npos)
        << e.what();
  }
  EXPECT_EQ(report.layers, 0);
}

TEST(CurvilinearSkeleton, OfTheSmallestSpaces) {
  ThinningReport report;
  BitGrid3 one({1, 1, 1});
  one.set(0, 0, 0);
  const Space s(one);
  const CubicalComplex point = curvilinear_skeleton(one, s.maps, report);
  EXPECT_GE(point.count(0), 1u);
  EXPECT_EQ(point.euler(), 1);
  const BitGrid3 none({4, 4, 4});
  const Space empty(none);
  EXPECT_EQ(curvilinear_skeleton(none, empty.maps, report).count(0), 0u);
  // One voxel wide and long: a line of nearly that length.
  BitGrid3 tunnel({1024, 3, 3});
  for (int x = 0; x < 1024; ++x) tunnel.set(x, 1, 1);
  const Space t(tunnel);
  const CubicalComplex line = curvilinear_skeleton(tunnel, t.maps, report);
  EXPECT_EQ(line.euler(), 1);
  EXPECT_GT(line.count(1), 1000u);
  EXPECT_LT(line.count(1), 1030u);
}

}  // namespace
}  // namespace lacuna
