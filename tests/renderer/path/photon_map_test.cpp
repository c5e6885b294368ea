#include "renderer/path/photon_map.h"

#include <gtest/gtest.h>

#include "renderer/path/guide.h"
#include "tests/renderer/path/scenes.h"

namespace lacuna {
namespace {

/// A diffuse surface vertex at `x`, that light reaches from `wp`.
Vertex diffuse_vertex(const V3f& x, const V3f& ng, const V3f& wp) {
  SurfaceParams grey;
  grey.base_color = Rgb(0.5F);
  grey.metallic = grey.transmission = grey.f90 = 0;
  grey.f0 = Rgb(0, 0, 0);
  Vertex v;
  v.kind = Vertex::Kind::surface;
  v.surface.x = x;
  v.surface.ng = v.surface.ns = ng;
  v.wp = wp;
  v.throughput = Rgb(1, 1, 1);
  v.p_fwd = Pdf<Area>(1.0F);
  v.bsdf.emplace(grey, ng, ng);
  return v;
}

// At the edge of two walls, in a disc that reaches over both, and on both sides of a thin one.
TEST(PhotonMap, MergesOnOneSideOfOneSurface) {
  const V3f up(0, 0, 1), down(0, 0, -1), aside(1, 0, 0);
  PhotonMap map;
  map.begin(1);
  map.keep(0, diffuse_vertex({0.1F, 0, 0}, up, up), 1);
  map.keep(0, diffuse_vertex({0.1F, 0, 0}, down, down), 2);
  map.keep(0, diffuse_vertex({0, 0, 0.1F}, aside, aside), 3);
  map.arrange(0.5, ThreadPool(1));
  ASSERT_EQ(map.size(), 3U);
  const Vertex v = diffuse_vertex({0.05F, 0, 0}, up, up);
  const Guide guide{};
  const SurfaceEndpoint eye{v, 1, Transport::radiance, guide};
  Rng rng(1, 0, 0, Rng::Purpose::test);
  double of_this_side = 0;
  map.for_each_at(v, rng, [&](const Photon& p, float, float) {
    EXPECT_NE(p.index, 3) << "lies on the other wall";
    if (p.index == 1) of_this_side += double(merged(eye, p).x);
    if (p.index == 2) {
      EXPECT_EQ(merged(eye, p), Rgb(0, 0, 0)) << "lies behind the wall";
    }
  });
  EXPECT_NEAR(of_this_side, 0.5 / 3.14159265, 1e-6);
}

// Also of many more than a look-up within the radius visits.
TEST(PhotonMap, VisitsTheNearest) {
  constexpr std::size_t n = 25 * PointGrid::most_candidates, wanted = 10;
  const V3f up(0, 0, 1);
  Rng rng(2, 0, 0, Rng::Purpose::test);
  PhotonMap map;
  map.begin(1);
  std::vector<float> distances;
  for (std::size_t i = 0; i < n; ++i) {
    const V3f x(rng.next() - 0.5F, rng.next() - 0.5F, 0);
    map.keep(0, diffuse_vertex(x, up, up), 1);
    distances.push_back(x.length2());
  }
  std::sort(distances.begin(), distances.end());
  map.arrange_nearest(1, ThreadPool(2));
  std::vector<PointTree::Found> found(wanted + 1);
  std::vector<double> visited;
  const double disc2 =
      map.for_each_nearest(diffuse_vertex(V3f(0), up, up), found,
                           [&](const Photon&, double d2) { visited.push_back(d2); });
  EXPECT_EQ(float(disc2), distances[wanted]);
  ASSERT_EQ(visited.size(), wanted);
  std::sort(visited.begin(), visited.end());
  for (std::size_t k = 0; k < wanted; ++k) {
    EXPECT_FLOAT_EQ(float(visited[k] * disc2), distances[k]);
  }
}

class PhotonMapInScene : public testing::Test {
 protected:
  PhotonMapInScene() : data_(test::load({"coated"})) {}

  SceneData data_;
  const ThreadPool pool_{1};
  const Camera camera_{data_.cameras.front(), 16, 16};
  const Scene scene_ = test::lit_scene(std::move(data_));
  const Guide guide_{};
};

TEST_F(PhotonMapInScene, RestoresThePathsThatItKept) {
  const LightPathSetting setting{scene_, camera_, 6, 7, {1, 1, 1, 256, 2}};
  using Batch = LightBatch;
  Batch batch(setting, guide_), restored(setting, guide_);
  std::vector<Rng> rngs;
  for (std::uint64_t i = 0; i < std::uint64_t{Batch::size}; ++i) {
    rngs.emplace_back(3, 0, i, Rng::Purpose::light_path);
  }
  Counters counters;
  batch.walk(rngs, counters);
  PhotonMap map;
  map.begin(Batch::size);
  for (std::size_t i = 0; i < rngs.size(); ++i) map.keep_path(i, batch, i);
  int compared = 0;
  for (std::size_t i = 0; i < rngs.size(); ++i) {
    map.restore_path(i, restored, i);
    ASSERT_LE(restored.length(i), batch.length(i));
    for (int s = 1; s < batch.length(i); ++s) {
      const Vertex& v = batch.vertex(i, s);
      if (!batch.connectible(i, s) || is_black(v.throughput)) continue;
      ASSERT_LT(s, restored.length(i));
      ASSERT_TRUE(restored.connectible(i, s));
      const Vertex& r = restored.vertex(i, s);
      EXPECT_EQ(r.surface.x, v.surface.x);
      EXPECT_EQ(r.wp, v.wp);
      EXPECT_EQ(r.throughput, v.throughput);
      EXPECT_EQ(r.p_fwd.value, v.p_fwd.value);
      EXPECT_EQ(r.prev_connectible, v.prev_connectible);
      EXPECT_EQ(r.mis_partial, v.mis_partial);
      ++compared;
    }
  }
  EXPECT_GT(compared, 100) << "the test has no power";
}

TEST_F(PhotonMapInScene, ShrinksItsRadiusAsItsScheduleSays) {
  const std::function<bool()> stop = [] { return false; };
  const auto radius = [&](RadiusUnit unit, std::uint64_t iteration) {
    return merge_radius({.radius = 0.25, .radius_unit = unit, .alpha = 0.5},
                        {scene_, camera_, pool_, 1, iteration, stop});
  };
  EXPECT_DOUBLE_EQ(radius(RadiusUnit::absolute, 0), 0.25);
  EXPECT_DOUBLE_EQ(radius(RadiusUnit::scene, 0), 0.25 * scene_.bounds().radius());
  for (const RadiusUnit unit : {RadiusUnit::absolute, RadiusUnit::scene, RadiusUnit::pixels}) {
    EXPECT_GT(radius(unit, 0), 0);
    EXPECT_NEAR(radius(unit, 15) / radius(unit, 0), 0.5, 1e-9);  // 16^(-1/4)
  }
}

}  // namespace
}  // namespace lacuna
