#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "analysis/regions/borders.h"
#include "analysis/regions/forest_labels.h"
#include "analysis/regions/opening_labels.h"
#include "analysis/regions/portals.h"
#include "analysis/space/distance.h"
#include "analysis/space/memory_limit.h"
#include "tests/analysis/space/soups_and_grids.h"

namespace lacuna {
namespace {

using Imath::V3i;

OpeningForest forest_of(const BitGrid3& domain) {
  return opening_forest(chebyshev_distance(domain, one_thread(), no_memory_limit), one_thread(),
                        no_memory_limit);
}

std::vector<BitGrid3> grids() {
  std::vector<BitGrid3> all = small_grids(61);
  std::mt19937 rng(62);
  for (int i = 0; i < 10; ++i) all.push_back(random_rooms({31, 27, 25}, 20, 8, rng));
  return all;
}

V3i step_of(int side) {
  V3i s(0);
  s[side / 2] = side % 2 == 0 ? -1 : 1;
  return s;
}

/// Def. 10.8 and 10.9 word by word; the number of a region is the rank of its root's first voxel.
std::vector<std::uint32_t> labels_by_definition(const OpeningForest& forest) {
  const std::size_t n = forest.centre.count();
  std::vector<std::uint32_t> root(n, no_region);
  std::uint32_t regions = 0;
  for (std::size_t i = 0; i < n; ++i) {
    if (forest.centre[i] != i || root[i] != no_region) continue;
    std::vector<std::size_t> todo{i};
    root[i] = regions;
    while (!todo.empty()) {
      const std::size_t j = todo.back();
      todo.pop_back();
      for (int side = 0; side < 6; ++side) {
        const V3i w = forest.centre.voxel(j) + step_of(side);
        if (!in_grid(w, forest.centre.size())) continue;
        const std::size_t k = forest.centre.index(w);
        if (forest.centre[k] != k || root[k] != no_region || forest.opening[k] != forest.opening[i])
          continue;
        root[k] = regions;
        todo.push_back(k);
      }
    }
    ++regions;
  }
  std::vector<std::uint32_t> label(n, no_region);
  for (std::size_t i = 0; i < n; ++i) {
    if (forest.centre[i] == no_voxel) continue;
    std::size_t j = i;
    while (forest.centre[j] != j) j = forest.centre[j];
    label[i] = root[j];
  }
  return label;
}

/// The 6-connected pieces of equal label; `piece` takes the piece of each voxel.
template <class Labels>
std::size_t pieces(const Labels& label, Grid3<std::uint32_t>* piece, V3i size) {
  Grid3<std::uint32_t> found(size);
  std::fill_n(found.data(), found.count(), no_region);
  std::uint32_t count = 0;
  for (std::size_t i = 0; i < found.count(); ++i) {
    if (found[i] != no_region || label[i] == no_region) continue;
    std::vector<std::size_t> todo{i};
    found[i] = count;
    while (!todo.empty()) {
      const V3i v = found.voxel(todo.back());
      todo.pop_back();
      for (int side = 0; side < 6; ++side) {
        const V3i w = v + step_of(side);
        if (!in_grid(w, size)) continue;
        const std::size_t k = found.index(w);
        if (found[k] != no_region || label[k] != label[i]) continue;
        found[k] = count;
        todo.push_back(k);
      }
    }
    ++count;
  }
  if (piece != nullptr) *piece = std::move(found);
  return count;
}

/// Voxels in a piece of their region that does not hold its root.
std::vector<bool> stray_voxels(const std::vector<std::uint32_t>& label,
                               const OpeningForest& forest) {
  Grid3<std::uint32_t> piece;
  std::vector<bool> anchored(pieces(label, &piece, forest.centre.size()), false);
  for (std::size_t i = 0; i < label.size(); ++i)
    if (forest.centre[i] == i) anchored[piece[i]] = true;
  std::vector<bool> stray(label.size(), false);
  for (std::size_t i = 0; i < label.size(); ++i)
    stray[i] = piece[i] != no_region && !anchored[piece[i]];
  return stray;
}

TEST(ForestLabels, AreThoseOfTheDefinitionAndConnected) {
  std::uint64_t strays = 0;
  for (const BitGrid3& domain : grids()) {
    const std::vector<std::uint32_t> expected = labels_by_definition(forest_of(domain));
    const std::vector<bool> stray = stray_voxels(expected, forest_of(domain));
    for (const int threads : {1, 4}) {
      const RegionLabels labels = forest_labels(forest_of(domain), ThreadPool(threads));
      std::vector<std::uint64_t> voxels(labels.regions.size(), 0);
      for (std::size_t i = 0; i < expected.size(); ++i) {
        ASSERT_EQ(labels.label[i] == expected[i], !stray[i]) << labels.label.voxel(i);
        ASSERT_EQ(labels.label[i] == no_region, expected[i] == no_region);
        if (expected[i] != no_region) ++voxels[labels.label[i]];
      }
      strays += labels.pieces_joined;
      ASSERT_EQ(pieces(labels.label, nullptr, domain.size()), labels.regions.size())
          << "all are connected";
      std::uint32_t last = 0;
      for (std::uint32_t r = 0; r < labels.regions.size(); ++r) {
        const Region& region = labels.regions[r];
        EXPECT_EQ(region.voxels, voxels[r]);
        EXPECT_EQ(labels.label[region.root], r);
        EXPECT_EQ(region.opening, labels.opening[region.root]);
        EXPECT_TRUE(r == 0 || region.root > last);
        last = region.root;
      }
    }
  }
  EXPECT_GT(strays, 0u) << "none of these grids has a piece that is cut off: the test is void";
}

/// Two rooms and a narrow door between them.
TEST(ForestLabels, OfTwoRoomsWithADoorAreRooms) {
  BitGrid3 domain(V3i(25, 11, 11));
  for (int z = 1; z < 10; ++z)
    for (int y = 1; y < 10; ++y)
      for (int x = 1; x < 24; ++x)
        if (x < 10 || x > 14 || (y == 5 && z == 5)) domain.set(x, y, z);
  const RegionLabels labels = forest_labels(forest_of(domain), one_thread());
  ASSERT_EQ(labels.regions.size(), 3u);
  EXPECT_EQ(labels.regions[labels.label(5, 5, 5)].voxels, 9u * 9 * 9);
  EXPECT_EQ(labels.regions[labels.label(5, 5, 5)].opening, 5u);
  EXPECT_EQ(labels.regions[labels.label(12, 5, 5)].opening, 1u);
  EXPECT_EQ(labels.regions[labels.label(12, 5, 5)].voxels, 5u);
  const Portals portals = find_portals(labels, one_thread(), no_memory_limit);
  ASSERT_EQ(portals.portals.size(), 2u);
  for (const Portal& p : portals.portals) EXPECT_EQ(p.faces(), 1u);
  EXPECT_EQ(portals.of(labels.label(12, 5, 5)).size(), 2u);
}

/// Def. 10.5 and 10.6 word by word.
TEST(OpeningLabels, AreTheFlatZonesOfTheOpeningMap) {
  std::size_t zones = 0, trees = 0;
  for (const BitGrid3& domain : grids()) {
    const OpeningForest forest = forest_of(domain);
    std::vector<std::uint32_t> opening(forest.opening.count(), no_region);
    for (std::size_t i = 0; i < opening.size(); ++i)
      if (forest.centre[i] != no_voxel) opening[i] = forest.opening[i];
    Grid3<std::uint32_t> expected;
    const std::size_t n = pieces(opening, &expected, domain.size());
    const RegionLabels labels = opening_labels(forest_of(domain), four_threads());
    ASSERT_EQ(labels.regions.size(), n);
    std::vector<std::uint64_t> voxels(n, 0);
    for (std::size_t i = 0; i < opening.size(); ++i) {
      ASSERT_EQ(labels.label[i], expected[i]);
      if (expected[i] != no_region) ++voxels[expected[i]];
    }
    for (std::uint32_t r = 0; r < n; ++r) {
      EXPECT_EQ(labels.regions[r].voxels, voxels[r]);
      EXPECT_EQ(labels.regions[r].opening, labels.opening[labels.regions[r].root]);
      EXPECT_EQ(labels.label[labels.regions[r].root], r);
    }
    zones += n;
    trees += forest_labels(forest_of(domain), one_thread()).regions.size();
  }
  EXPECT_GT(zones, trees) << "false positives of Fig. 81";
}

using FaceSet = std::set<std::tuple<std::uint32_t, std::uint8_t>>;

TEST(Portals, AreAllFacesBetweenTwoRegions) {
  for (const BitGrid3& domain : grids()) {
    const RegionLabels labels = forest_labels(forest_of(domain), one_thread());
    std::map<std::pair<std::uint32_t, std::uint32_t>, FaceSet> expected;
    for (std::size_t i = 0; i < labels.label.count(); ++i)
      for (int side = 0; side < 6; ++side) {
        const V3i w = labels.label.voxel(i) + step_of(side);
        if (!in_grid(w, domain.size())) continue;
        const std::uint32_t a = labels.label[i], b = labels.label(w);
        if (a < b && b != no_region)
          expected[{a, b}].insert({static_cast<std::uint32_t>(i), static_cast<std::uint8_t>(side)});
      }
    for (const int threads : {1, 4}) {
      const Portals portals = find_portals(labels, ThreadPool(threads), no_memory_limit);
      ASSERT_EQ(portals.portals.size(), expected.size());
      auto next = expected.begin();
      std::vector<std::vector<std::uint32_t>> of_region(labels.regions.size());
      for (std::uint32_t p = 0; p < portals.portals.size(); ++p, ++next) {
        const Portal& portal = portals.portals[p];
        ASSERT_EQ(std::pair(portal.a, portal.b), next->first);
        ASSERT_EQ(portal.faces(), next->second.size());
        FaceSet found;
        for (std::uint64_t i = 0; i < portal.faces(); ++i)
          found.insert({portals.face(portal, i).voxel, portals.face(portal, i).side});
        ASSERT_EQ(found, next->second);
        of_region[portal.a].push_back(p);
        of_region[portal.b].push_back(p);
      }
      for (std::uint32_t r = 0; r < of_region.size(); ++r)
        ASSERT_TRUE(std::ranges::equal(portals.of(r), of_region[r]));
    }
  }
}

TEST(Borders, AreAllFacesThatLeaveARegion) {
  for (const BitGrid3& domain : grids()) {
    const RegionLabels labels = forest_labels(forest_of(domain), one_thread());
    for (const BorderFaces which : {BorderFaces::portals, BorderFaces::all}) {
      std::vector<FaceSet> expected(labels.regions.size());
      for (std::size_t i = 0; i < labels.label.count(); ++i)
        for (int side = 0; side < 6 && labels.label[i] != no_region; ++side) {
          const V3i w = labels.label.voxel(i) + step_of(side);
          const std::uint32_t b = in_grid(w, domain.size()) ? labels.label(w) : no_region;
          if (b != labels.label[i] && (b != no_region || which == BorderFaces::all))
            expected[labels.label[i]].insert(
                {static_cast<std::uint32_t>(i), static_cast<std::uint8_t>(side)});
        }
      const Borders one = find_borders(labels, which, one_thread(), no_memory_limit);
      const Borders four = find_borders(labels, which, four_threads(), no_memory_limit);
      EXPECT_EQ(one.first, four.first);
      EXPECT_EQ(one.voxels, four.voxels);
      for (std::uint32_t r = 0; r < expected.size(); ++r) {
        ASSERT_EQ(one.faces(r), expected[r].size());
        FaceSet found;
        for (std::uint64_t i = 0; i < one.faces(r); ++i)
          found.insert({one.face(r, i).voxel, one.face(r, i).side});
        ASSERT_EQ(found, expected[r]);
      }
    }
  }
}

TEST(VoxelFace, HasItsPointsInItsPlane) {
  const V3i at(3, 5, 7);
  for (std::uint8_t side = 0; side < 6; ++side) {
    const VoxelFace f{0, side};
    const Imath::V3d centre = f.point(at, 0.5, 0.5);
    EXPECT_EQ(centre, Imath::V3d(at) + Imath::V3d(0.5) + f.normal() * 0.5);
    EXPECT_EQ((f.point(at, 0.1, 0.9) - centre).dot(f.normal()), 0);
    EXPECT_NE(f.point(at, 0.1, 0.9), centre);
  }
}

TEST(Regions, OfAGridWithoutDomainAreNone) {
  const BitGrid3 nothing(V3i(5, 4, 3));
  const RegionLabels labels = forest_labels(forest_of(nothing), one_thread());
  EXPECT_TRUE(labels.regions.empty());
  EXPECT_EQ(labels.label(2, 2, 2), no_region);
  EXPECT_TRUE(find_portals(labels, one_thread(), no_memory_limit).portals.empty());
  EXPECT_TRUE(find_borders(labels, BorderFaces::all, one_thread(), no_memory_limit).voxels.empty());
}

TEST(Regions, AreRefusedBeforeTheyTakeTooMuchMemory) {
  std::mt19937 rng(63);
  const RegionLabels labels =
      forest_labels(forest_of(random_rooms({20, 20, 20}, 20, 6, rng)), one_thread());
  EXPECT_THROW(find_portals(labels, one_thread(), 100), MemoryLimitError);
  EXPECT_THROW(find_borders(labels, BorderFaces::all, one_thread(), 1000), MemoryLimitError);
}

}  // namespace
}  // namespace lacuna
