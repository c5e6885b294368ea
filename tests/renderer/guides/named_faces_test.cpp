// A portal, or a region's border, that all points share.

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "renderer/core/scene_error.h"
#include "tests/renderer/guides/density_check.h"
#include "tests/renderer/guides/guided_scene.h"
#include "tests/renderer/path/scenes.h"

namespace lacuna {
namespace {

using test::GuidedScene;
using test::PathScene;

constexpr int resolution = 48;

SceneData ajar() { return load_gltf(test::own_scene("ajar.glb")); }

PortalsGuideSettings through_portal(const std::array<double, 3>& point) {
  PortalsGuideSettings s;
  s.probability = {0.5};
  s.through = point;
  return s;
}

/// The density of `w` at `x`, in voxels, of a point that is uniform on the portal: face by face,
/// with none of the traversal of voxels in it.
double density_by_faces(const Portals& portals, const Portal& portal,
                        const Grid3<std::uint32_t>& label, const V3d& x, const V3d& w) {
  double sum = 0;
  for (std::uint64_t i = 0; i < portal.faces(); ++i) {
    const VoxelFace face = portals.face(portal, i);
    const V3d corner = face.point(label.voxel(face.voxel), 0, 0);
    const int a = face.axis(), b = (a + 1) % 3, c = (a + 2) % 3;
    const double t = (corner[a] - x[a]) / w[a];
    if (!(t > 0)) continue;
    const V3d at = x + t * w;
    const bool inside =
        at[b] > corner[b] && at[b] < corner[b] + 1 && at[c] > corner[c] && at[c] < corner[c] + 1;
    if (inside) sum += t * t / std::abs(w[a]);
  }
  return sum / static_cast<double>(portal.faces());
}

/// The portal that has the most guided vertices in the one of its regions that has fewer.
Portal between_vertices(GuidedScene& scene) {
  std::map<std::uint32_t, std::size_t> vertices;
  for (const Vertex& v : scene.guided_vertices(200)) {
    ++vertices[v.guiding_cell.index];
  }
  const std::vector<Portal>& all = scene.space().portals().portals;
  return *std::max_element(all.begin(), all.end(), [&](const Portal& p, const Portal& q) {
    return std::min(vertices[p.a], vertices[p.b]) < std::min(vertices[q.a], vertices[q.b]);
  });
}

// From vertices in both of its regions, and in others.
TEST(NamedFaces, ThePortalHasItsDensityFromEveryRegion) {
  const auto any = test::portal_point(ajar, std::nullopt, resolution);
  ASSERT_TRUE(any);
  GuidedScene first(ajar, through_portal(*any), 0, std::nullopt, resolution);
  const Portal portal = between_vertices(first);
  const auto point = test::point_of(first, portal);
  GuidedScene scene(ajar, through_portal(point), 0, std::nullopt, resolution);
  const Portals& portals = scene.space().portals();
  const Grid3<std::uint32_t>& label = scene.space().regions().label;
  const GridTransform& grid = scene.space().voxels().transform;
  std::array<std::size_t, 3> vertices{};
  for (const Vertex& v : scene.guided_vertices(200)) {
    const std::uint32_t region = v.guiding_cell.index;
    const std::size_t where = region == portal.a ? 0 : region == portal.b ? 1 : 2;
    EXPECT_EQ(v.guiding_cell.probability, 1);
    if (++vertices[where] > 4) continue;
    SCOPED_TRACE(testing::Message() << "region " << region << " at " << v.surface.x);
    const GuidedVertex at{v.surface, *v.bsdf, v.wp, v.guiding_cell};
    Rng rng(17, vertices[where], where, Rng::Purpose::test);
    std::size_t drawn = 0, wrong = 0;
    for (int i = 0; i < 500; ++i) {
      const auto w = scene.directions().sample(at, rng.next_fine_point(), rng);
      if (!w) continue;
      ++drawn;
      const double expected =
          density_by_faces(portals, portal, label, grid.to_grid(V3d(v.surface.x)), V3d(*w));
      const double stated = double(scene.directions().pdf(at, *w).value);
      wrong += std::abs(stated - expected) > 1e-4 * expected ? 1 : 0;
    }
    EXPECT_GT(drawn, 490U);
    EXPECT_LE(wrong, 5U);  // through the edge of a face, by rounding
  }
  for (const std::size_t n : vertices) EXPECT_GT(n, 0U);
}

// `through` is in the coordinates of the file, which are others where the scene lies far away.
TEST(NamedFaces, ThePointIsInTheFilesCoordinates) {
  const auto point = test::portal_point(ajar, std::nullopt, resolution);
  ASSERT_TRUE(point);
  const auto moved = [] {
    SceneData data = ajar();
    data.origin = V3d(1e4, -2e4, 3e4);
    return data;
  };
  EXPECT_THROW(GuidedScene(moved, through_portal(*point), 0, std::nullopt, resolution), SceneError);
  const auto there = test::portal_point(moved, std::nullopt, resolution);
  ASSERT_TRUE(there);
  const GuidedScene here(ajar, through_portal(*point), 0, std::nullopt, resolution);
  const GuidedScene far(moved, through_portal(*there), 0, std::nullopt, resolution);
  for (const Vertex& v : here.guided_vertices(4)) {
    const GuidedVertex at{v.surface, *v.bsdf, v.wp, v.guiding_cell};
    Rng rng(18, 0, 0, Rng::Purpose::test);
    const auto w = here.directions().sample(at, rng.next_fine_point(), rng);
    ASSERT_TRUE(w);
    EXPECT_GT(here.directions().pdf(at, *w).value, 0);
    EXPECT_EQ(here.directions().pdf(at, *w).value, far.directions().pdf(at, *w).value);
  }
}

/// Why a scene refuses to be guided; empty: it does not.
std::string refusal(const std::function<SceneData()>& make, const GuideSettings& guide,
                    int voxels = resolution) {
  try {
    const GuidedScene scene(make, guide, 0, std::nullopt, voxels);
    return "";
  } catch (const SceneError& e) {
    return e.what();
  }
}

TEST(NamedFaces, PointsThatNameNoneAreRefused) {
  // A room of 2 by 2 by 2 with a solid block of 1 by 1 by 1 in it.
  const auto room = [] {
    test::SceneParts p;
    const auto wall = p.material(test::diffuse(Rgb(0.7F, 0.6F, 0.5F)));
    p.box({-1, -1, -1}, {1, 1, 1}, false, wall);
    p.box({-0.9F, -0.9F, -0.9F}, {0.1F, 0.1F, 0.1F}, true, wall);
    p.quad({-0.4F, 0.95F, -0.4F}, {0.8F, 0, 0}, {0, 0, 0.8F}, p.material(test::lamp(Rgb(6, 7, 8))));
    p.eye({0.5, 0.5, 0.9}, {0, 0, -1}, 1.5);
    return std::move(p.data);
  };
  FaceIrradianceGuideSettings border;
  const std::vector<std::pair<std::array<double, 3>, std::string>> points{
      {{0, 0, 40}, "it lies outside the scene's grid"},
      {{0.1, 0, 0}, "a surface intersects its voxel, whose side is"},
      {{-0.4, -0.4, -0.4},
       "neither the camera nor a light is in its connected part of the empty space"},
  };
  for (const auto& [point, why] : points) {
    border.through = point;
    for (const GuideSettings& guide :
         {GuideSettings(border), GuideSettings(through_portal(point))}) {
      const std::string text = refusal(room, guide);
      EXPECT_NE(text.find("\"through\" ["), std::string::npos) << text;
      EXPECT_NE(text.find(why), std::string::npos) << text;
    }
  }
  border.through = {0.5, 0.5, 0.5};
  EXPECT_EQ(refusal(room, border), "");
  // An empty room is one region.
  const auto empty = [] {
    test::SceneParts p;
    p.box({-1, -1, -1}, {1, 1, 1}, false, p.material(test::lamp(Rgb(6, 7, 8))));
    p.eye({0, 0, 0.5}, {0, 0, -1}, 1.5);
    return std::move(p.data);
  };
  EXPECT_NE(refusal(empty, through_portal({0, 0, 0})).find("selects no portal"), std::string::npos);
  EXPECT_EQ(refusal(empty, border), "");
}

// 10.4.1 as published: one portal in each region but the light's, and no light that lowers the
// guide's probability.
TEST(PortalPaths, LeadToTheRegionWithTheLight) {
  PortalsGuideSettings settings;
  settings.mixing = 0;
  const auto of = [&](PortalPaths paths) {
    settings.paths = paths;
    GuidedScene scene(ajar, settings, 0, std::nullopt, 96);  // the door is open at this resolution
    std::map<std::string, double> all;
    for (const auto& [name, value] : scene.directions().statistics()) all[name] = value;
    all["least"] = 1;
    for (const Vertex& v : scene.guided_vertices(200)) {
      all["least"] = std::min(all["least"], double(v.guiding_cell.probability));
    }
    return all;
  };
  auto one = of(PortalPaths::light_region), mixed = of(PortalPaths::lit_regions);
  EXPECT_EQ(one["exits_mean"], 1);
  EXPECT_EQ(one["guided_regions"], one["regions"] - 1);
  EXPECT_NEAR(one["least"], 1, 1e-6);
  EXPECT_GT(mixed["exits_mean"], 1);
  EXPECT_LT(mixed["least"], 0.99);
}

}  // namespace
}  // namespace lacuna
