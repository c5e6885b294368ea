#include "renderer/scene/points_in_surfaces.h"

#include <gtest/gtest.h>

#include "renderer/core/rng.h"
#include "tests/renderer/scene/scene_parts.h"

namespace lacuna {
namespace {

using test::SceneParts;

/// A closed box around `o`, of side `size`.
SceneParts closed_box(const V3f& o, float size) {
  SceneParts p;
  const auto white = p.material(test::diffuse(Rgb(0.5F)));
  const V3f half(size / 2);
  p.box(o - half, o + half, false, white);
  for (Mesh& m : p.data.meshes) m.name = "wall";
  return p;
}

/// Tilted so that no normal is along an axis; corners are rounded.
void tilt(SceneData& data) {
  const V3d a = V3d(1, 2, 3).normalized(), b = a.cross(V3d(0, 1, 0)).normalized(), c = a.cross(b);
  for (Mesh& mesh : data.meshes) {
    for (V3f& x : mesh.positions) x = V3f(a * double(x.x) + b * double(x.y) + c * double(x.z));
  }
}

void add_lamp(SceneParts& p, const V3f& x) {
  p.light(PunctualLight::Kind::point, x, {0, -1, 0}, Rgb(1));
  p.data.lights.back().name = "lamp";
}

TEST(LightsInSurfaces, AreFound) {
  for (const float size : {1e-3F, 1.0F, 1e4F}) {
    for (const float away : {0.0F, 1.0F, 100.0F}) {
      const V3f o(away * size);
      for (const bool in : {false, true}) {
        SceneParts p = closed_box(o, size);
        add_lamp(p, o + V3f(0.1F, in ? 0.5F : 0.49F, 0.2F) * size);
        add_lamp(p, o);
        const Scene scene = test::lit_scene(std::move(p.data));
        const auto said = lights_in_surfaces(scene);
        ASSERT_EQ(said.size(), in ? 1U : 0U) << size << ", " << away;
        if (!in) continue;
        for (const char* word : {"1 of 2 lights", "\"lamp\"", "\"wall\"", "both"}) {
          EXPECT_NE(said[0].find(word), std::string::npos) << said[0];
        }
        EXPECT_EQ(scene.data().lights[0].contact->count, 1);
      }
    }
  }
}

// Whatever way a ray takes from a point of a surface, it does not meet that surface.
TEST(LightsInSurfaces, SendRaysToBothSides) {
  Rng rng(1, 0, 0, Rng::Purpose::test);
  for (const float away : {0.0F, 10.0F}) {
    for (int i = 0; i < 200; ++i) {
      SceneParts p = closed_box(V3f(away), 1);
      tilt(p.data);
      const auto at = rng.next2();
      const Mesh& mesh = p.data.meshes[static_cast<std::size_t>(i) % 6];
      const V3f x = TriangleShape(mesh, 0).at(at.x * 0.5F, at.y * 0.5F);
      const Scene scene = test::lit_scene(std::move(p.data));
      const auto contact = scene.find_contact(x);
      ASSERT_TRUE(contact) << i << " at " << x;
      for (int k = 0; k < 100; ++k) {
        const V3f w = V3f(rng.next() - 0.5F, rng.next() - 0.5F, rng.next() - 0.5F).normalized();
        if (abs_dot(w, contact->planes[0].ng) < 1e-3F) continue;
        const V3f from = contact->origin(x, w);
        Hit hit;
        const bool met = scene.rays().intersect({from, w}, hit);
        const bool inwards = dot(w, contact->planes[0].ng) > 0;
        EXPECT_EQ(met, inwards) << i;
        if (met) {
          EXPECT_GT(hit.t, 1e-5F) << i;
        }
      }
    }
  }
}

TEST(LightsInSurfaces, CornersHaveThreePlanes) {
  SceneParts p = closed_box(V3f(0), 2);
  add_lamp(p, {1, 1, 0.3F});
  add_lamp(p, {1, 1, 1});
  const Scene scene = test::lit_scene(std::move(p.data));
  ASSERT_TRUE(scene.data().lights[0].contact);
  EXPECT_EQ(scene.data().lights[0].contact->count, 2);
  ASSERT_TRUE(scene.data().lights[1].contact);
  EXPECT_EQ(scene.data().lights[1].contact->count, 3);
}

/// A camera at `from` that looks towards `to`; what it lay in, and what is warned of.
struct Left {
  std::optional<SurfaceContact> contact = {};
  V3f position = {};
  std::vector<std::string> said = {};
};
Left leave(const V3d& from, const V3d& to, double yfov) {
  SceneParts p = closed_box(V3f(0), 2);
  p.eye(from, to, yfov);
  CameraData camera = p.data.cameras[0];
  const Scene scene = test::lit_scene(std::move(p.data));
  Left left{.contact = leave_surfaces(camera, scene)};
  const Camera seen(camera, 16, 16);
  left.position = seen.position();
  if (left.contact) left.said = look_back(seen, *left.contact, scene);
  return left;
}

TEST(CamerasInSurfaces, AreMovedOffThem) {
  const Left free = leave({0, 0, 0.5}, {0, 0, 0}, 0.8);
  EXPECT_FALSE(free.contact);
  EXPECT_EQ(free.position, V3f(0, 0, 0.5F));
  const Left on = leave({0.1, 0.2, 1}, {0, 0, 0}, 0.8);
  ASSERT_TRUE(on.contact);
  EXPECT_LT(on.position.z, 1);
  EXPECT_GT(on.position.z, 1 - 1e-4F);
  EXPECT_TRUE(on.said.empty());
  const Left along = leave({0.1, 0.2, 1}, {0.9, 0.2, 0.9}, 0.8);
  ASSERT_EQ(along.said.size(), 1U);
  EXPECT_NE(along.said[0].find("\"wall\""), std::string::npos) << along.said[0];
}

}  // namespace
}  // namespace lacuna
