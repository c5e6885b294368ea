#include "renderer/view_maps/node_maps.h"

#include <gtest/gtest.h>

#include "analysis/space/memory_limit.h"
#include "renderer/core/rng.h"
#include "tests/analysis/artefacts/entries.h"
#include "tests/renderer/path/scenes.h"
#include "tests/statistics.h"

namespace lacuna {
namespace {

using statistics::Moments;

Scene scene_of(SceneData data) {
  static const ThreadPool pool(2);
  return Scene(std::move(data), {}, std::nullopt, pool);
}

struct HitPoint {
  V3f x, n;  // n towards `from`
};

/// What rays from `from` meet.
std::vector<HitPoint> points_around(const Scene& scene, const V3f& from, int rays) {
  Rng rng(7, 0, 0, Rng::Purpose::test);
  std::vector<HitPoint> points;
  for (int i = 0; i < rays; ++i) {
    const V3f d = V3f(rng.next() - 0.5F, rng.next() - 0.5F, rng.next() - 0.5F).normalized();
    Hit hit;
    const Ray ray{from, d};
    if (!scene.rays().intersect(ray, hit)) continue;
    const Surface s = scene.surface(ray, hit);
    points.push_back({s.x, dot(s.ng, d) > 0 ? -s.ng : s.ng});
  }
  return points;
}

bool sees(const Scene& scene, const V3f& place, const HitPoint& p) {
  const V3f start = offset_origin(p.x, p.n, 0x1p-19F * p.x.length(), p.n);
  return dot(place - p.x, p.n) > 0 && !scene.rays().occluded({start, place - start, 1.0F});
}

/// Places around corners: each is seen from the one before.
std::vector<V3f> places_from(const Scene& scene, const V3f& eye) {
  std::vector<V3f> places{eye};
  while (places.size() < 8) {
    const V3f from = places.back();
    const auto met = points_around(scene, from, static_cast<int>(3 * places.size()));
    if (!met.empty()) places.push_back(from + (met.back().x - from) * 0.8F);
    if (places.back() == from) places.push_back(eye);
  }
  return places;
}

const ThreadPool pool(2);

NodeMaps node_maps_of(const Scene& scene, const std::vector<V3f>& places, int size) {
  return trace_node_maps(scene, places, size, pool, no_memory_limit);
}

// Across the seams of the cube, with filters that lie on two faces or three.
TEST(NodeMaps, OfAnEmptyRoomSeeAllOfIt) {
  test::SceneParts parts;
  parts.box({-1, -2, -3}, {1.5F, 2, 4}, false, parts.material(test::diffuse(Rgb(0.5F))));
  parts.eye({0, 0, 0}, {0, 0, -1}, 1);
  const Scene scene = scene_of(std::move(parts.data));
  const V3f place(0.1F, -0.2F, 0.3F);
  const NodeMaps maps = node_maps_of(scene, {place}, 64);
  for (const int filter : {1, 2, 5, 7}) {
    const NodeView view(maps, 0, place, filter);
    Moments whole;
    for (const HitPoint& p : points_around(scene, {-0.7F, 1, 2}, 20000)) {
      const float seen = view.visible_fraction(p.x, p.n);
      EXPECT_GE(seen, 0.2F) << p.x << " filter " << filter;  // in a corner, a quarter of it
      EXPECT_LE(seen, 1.00001F);
      whole.add(seen > 0.9999F ? 1 : 0);
      EXPECT_EQ(view.visible_fraction(p.x, -p.n), 0) << "from behind";
    }
    EXPECT_GT(statistics::t_test_at_least(whole, 1 - 0.04 * (filter + 1)), 1 - 1e-4)
        << "filter " << filter << ": " << whole.mean() << " +- " << whole.standard_error();
  }
}

class NodeMapsIn : public testing::TestWithParam<const char*> {};

TEST_P(NodeMapsIn, SeeWhatRaysSee) {
  const SceneData data = test::load({GetParam()});
  const V3f eye(data.cameras.front().to_world.translation());
  const Scene scene = scene_of(test::load({GetParam()}));
  const std::vector<V3f> places = places_from(scene, eye);
  const NodeMaps maps = node_maps_of(scene, places, 128);
  ASSERT_EQ(maps.points(), places.size());
  int seen = 0, unseen = 0;
  Moments wrong;  // shares of the points around one place: those of one place are not independent
  for (std::size_t k = 0; k < places.size(); ++k) {
    const NodeView view(maps, k, places[k], 1);
    Moments of_place;
    for (const V3f& from : places) {
      for (const HitPoint& p : points_around(scene, from, 800)) {
        const bool expected = sees(scene, places[k], p);
        (expected ? seen : unseen) += 1;
        of_place.add((view.visible_fraction(p.x, p.n) > 0.5F) != expected ? 1 : 0);
      }
    }
    wrong.add(of_place.mean());
  }
  EXPECT_GT(std::min(seen, unseen), 500);
  EXPECT_LT(statistics::t_test_at_least(wrong, 0.025), 0.01)
      << wrong.mean() << " +- " << wrong.standard_error();
}

INSTANTIATE_TEST_SUITE_P(All, NodeMapsIn, testing::Values("ajar", "atrium"),
                         [](const auto& s) { return std::string(s.param); });

// Lights without a surface: points in empty space, and directions to what is infinitely far.
TEST(NodeMaps, SeePointsAndTheSkyAsRaysDo) {
  const SceneData data = test::load({"atrium"});
  const V3f eye(data.cameras.front().to_world.translation());
  const Scene scene = scene_of(test::load({"atrium"}));
  const std::vector<V3f> places = places_from(scene, eye);
  const NodeMaps maps = node_maps_of(scene, places, 128);
  Rng rng(8, 0, 0, Rng::Purpose::test);
  int clear = 0, hidden = 0;
  Moments wrong_points, wrong_directions;  // shares of each place
  for (std::size_t k = 0; k < places.size(); ++k) {
    const NodeView view(maps, k, places[k], 1);
    EXPECT_EQ(view.visible_fraction(places[k]), 1) << "the place itself";
    Moments points, directions;
    for (int i = 0; i < 4000; ++i) {
      const V3f d = V3f(rng.next() - 0.5F, rng.next() - 0.5F, rng.next() - 0.5F).normalized();
      const V3f to = d * (12 * rng.next());
      const bool sees_point = !scene.rays().occluded({places[k], to, 1.0F});
      points.add((view.visible_fraction(places[k] + to) > 0.5F) != sees_point ? 1 : 0);
      const bool sees_sky = !scene.rays().occluded({places[k], d});
      directions.add((view.open(d) > 0.5F) != sees_sky ? 1 : 0);
      for (const bool sees : {sees_point, sees_sky}) (sees ? clear : hidden) += 1;
    }
    wrong_points.add(points.mean());
    wrong_directions.add(directions.mean());
  }
  EXPECT_GT(std::min(clear, hidden), 4000);
  for (const Moments& wrong : {wrong_points, wrong_directions}) {
    EXPECT_LT(statistics::t_test_at_least(wrong, 0.025), 0.01)
        << wrong.mean() << " +- " << wrong.standard_error();
  }
}

TEST(NodeMaps, ScaleWithTheScene) {
  const auto room = [](float scale) {
    test::SceneParts parts;
    const auto wall = parts.material(test::diffuse(Rgb(0.5F)));
    parts.box(V3f(-1, -1, -1) * scale, V3f(1, 1, 1) * scale, false, wall);
    parts.box(V3f(0.2F, -1, 0.2F) * scale, V3f(0.5F, 0.3F, 0.4F) * scale, true, wall);
    parts.eye({0, 0, 0}, {0, 0, -1}, 1);
    return scene_of(std::move(parts.data));
  };
  const V3f place(-0.3F, 0.1F, -0.2F);
  const NodeMaps expected = node_maps_of(room(1), {place}, 32);
  for (const float scale : {0x1p-20F, 0x1p30F}) {
    EXPECT_EQ(node_maps_of(room(scale), {place * scale}, 32).texels, expected.texels) << scale;
  }
}

TEST(NodeMaps, RefuseMoreMemoryThanThereIs) {
  const Scene scene = scene_of(test::load({"cornell"}));
  const std::vector<V3f> places(4, V3f(0.0F));
  try {
    trace_node_maps(scene, places, 1024, pool, 1 << 20);
    FAIL();
  } catch (const MemoryLimitError& e) {
    EXPECT_NE(std::string(e.what()).find("map_size"), std::string::npos) << e.what();
  }
}

/// A file of `maps`, read again.
NodeMaps trip(const NodeMaps& maps, std::optional<EntryRefusal>& refusal) {
  const TemporaryFolder tmp;
  const ArtefactKey key = key_of("");
  const auto file = put_entry(tmp.path(), key,
                              pack_entry(key, "", [&](ArtefactWriter& out) { encode(out, maps); }));
  EntryHeader header;
  NodeMaps read;
  refusal = read_entry(file, key, header, [&](ArtefactReader& in) { read = decode<NodeMaps>(in); });
  return read;
}

TEST(NodeMaps, ComeBackFromDisk) {
  const Scene scene = scene_of(test::load({"cornell"}));
  const NodeMaps maps = node_maps_of(scene, {V3f(0.1F), V3f(0.2F)}, 8);
  std::optional<EntryRefusal> refusal;
  const NodeMaps read = trip(maps, refusal);
  EXPECT_FALSE(refusal);
  EXPECT_EQ(read.size, maps.size);
  EXPECT_EQ(read.scale, maps.scale);
  EXPECT_EQ(read.texels, maps.texels);
  for (const auto& spoil : std::vector<std::function<void(NodeMaps&)>>{
           [](NodeMaps& m) { m.size = 0; }, [](NodeMaps& m) { m.size = 1 << 20; },
           [](NodeMaps& m) { m.size = 9; }, [](NodeMaps& m) { m.scale = -1; },
           [](NodeMaps& m) { m.scale = std::numeric_limits<float>::quiet_NaN(); },
           [](NodeMaps& m) { m.texels.pop_back(); }, [](NodeMaps& m) { m.texels.clear(); }}) {
    NodeMaps hostile = maps;
    spoil(hostile);
    trip(hostile, refusal);
    ASSERT_TRUE(refusal);
    EXPECT_EQ(refusal->fault, EntryFault::undecodable);
  }
}

}  // namespace
}  // namespace lacuna
