#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>
#include <limits>
#include <numbers>

#include "renderer/geometry/scene_data.h"
#include "renderer/gltf/gltf_load.h"
#include "tests/renderer/gltf/expect_near.h"

namespace lacuna {
namespace {

struct Box {
  V3f low{std::numeric_limits<float>::max()};
  V3f high{std::numeric_limits<float>::lowest()};
};

/// The real scenes lie outside of the repository and may be absent; then nothing is asserted.
bool present(const std::filesystem::path& file) {
  if (std::filesystem::exists(file)) return true;
  std::cout << "[ absent   ] " << file.string() << ": nothing was checked\n";
  return false;
}

std::filesystem::path real_scene(const std::string& name) {
  return std::filesystem::path(LACUNA_SOURCE_DIR) / ".." / "shared" / "scenes" / name;
}

Box bounds(const SceneData& scene) {
  Box box;
  for (const Mesh& mesh : scene.meshes) {
    for (const V3f& p : mesh.positions) {
      for (int k = 0; k < 3; ++k) {
        box.low[k] = std::min(box.low[k], p[k]);
        box.high[k] = std::max(box.high[k], p[k]);
      }
    }
  }
  return box;
}

V3f direction(const CameraData& camera) {
  return V3f(static_cast<float>(-camera.to_world[2][0]), static_cast<float>(-camera.to_world[2][1]),
             static_cast<float>(-camera.to_world[2][2]));
}

V3f position(const CameraData& camera) {
  return V3f(static_cast<float>(camera.to_world[3][0]), static_cast<float>(camera.to_world[3][1]),
             static_cast<float>(camera.to_world[3][2]));
}

double emitting_area(const SceneData& scene, const Rgb& radiance) {
  double area = 0;
  for (const Mesh& mesh : scene.meshes) {
    if (scene.materials[mesh.material].emission != radiance) continue;
    for (const auto& t : mesh.triangles) {
      const V3d a(mesh.positions[t[0]]);
      area += (V3d(mesh.positions[t[1]]) - a).cross(V3d(mesh.positions[t[2]]) - a).length() / 2;
    }
  }
  return area;
}

void expect_consistent(const SceneData& scene) {
  for (const Mesh& mesh : scene.meshes) {
    ASSERT_LT(mesh.material, scene.materials.size());
    EXPECT_TRUE(mesh.normals.empty() || mesh.normals.size() == mesh.positions.size());
    for (const auto& uvs : mesh.uvs) {
      EXPECT_TRUE(uvs.empty() || uvs.size() == mesh.positions.size());
    }
    for (const V3f& n : mesh.normals) ASSERT_NEAR(n.length(), 1, 1e-5F);
    for (const auto& t : mesh.triangles) {
      for (const auto v : t) ASSERT_LT(v, mesh.positions.size());
    }
  }
}

// The numbers below are those of the NOTES.md beside each scene.

TEST(RealScenes, Door) {
  const auto file = real_scene("door/scene.glb");
  if (!present(file)) return;
  const SceneData scene = load_gltf(file);
  EXPECT_EQ(scene.triangle_count(), 21722U);
  EXPECT_EQ(scene.dropped_triangles, 0U);
  const Box box = bounds(scene);
  expect_near(box.low, {-206.66F, 0, -396.32F}, 0.01F);
  expect_near(box.high, {179.73F, 145.0F, 230.28F}, 0.01F);
  ASSERT_EQ(scene.cameras.size(), 2U);
  EXPECT_EQ(scene.cameras[0].name, "corner");
  EXPECT_EQ(scene.cameras[1].name, "veach");
  expect_near(position(scene.cameras[0]), {-179.50F, 114.96F, 226.38F}, 0.01F);
  expect_near(direction(scene.cameras[0]), {0.7265F, -0.2077F, -0.6550F}, 1e-4F);
  EXPECT_NEAR(scene.cameras[0].yfov, std::numbers::pi / 4, 1e-6);
  EXPECT_NEAR(emitting_area(scene, Rgb(400000)), 12.466, 0.001);
  EXPECT_EQ(scene.textures.size(), 5U);
  for (const auto& texture : scene.textures) EXPECT_FALSE(texture->decoded());
  expect_consistent(scene);
}

TEST(RealScenes, Corridor) {
  const auto file = real_scene("corridor/scene.glb");
  if (!present(file)) return;
  const SceneData scene = load_gltf(file);
  EXPECT_EQ(scene.triangle_count(), 46U);
  const Box box = bounds(scene);
  expect_near(box.low, {-13.197F, 0, -6.173F}, 0.001F);
  expect_near(box.high, {7.386F, 7.5F, 10.721F}, 0.001F);
  EXPECT_NEAR(emitting_area(scene, Rgb(100000)), 4, 1e-4);
  ASSERT_EQ(scene.cameras.size(), 1U);
  expect_near(direction(scene.cameras[0]), {-0.9993F, 0, -0.0380F}, 1e-4F);
  expect_consistent(scene);
}

TEST(RealScenes, Sponza) {
  const auto file = real_scene("sponza/scene.glb");
  if (!present(file)) return;
  const SceneData scene = load_gltf(file);
  EXPECT_EQ(scene.triangle_count(), 261842U);
  EXPECT_EQ(scene.dropped_triangles, 0U);
  const Box box = bounds(scene);
  expect_near(box.low, {-1921.22F, -126.49F, -1183.25F}, 0.01F);
  expect_near(box.high, {1799.89F, 1429.66F, 1105.70F}, 0.01F);
  ASSERT_EQ(scene.lights.size(), 1U);
  EXPECT_EQ(scene.lights[0].kind, PunctualLight::Kind::directional);
  EXPECT_NEAR(scene.lights[0].intensity.x, 5919.9635F, 0.001F);
  expect_near(scene.lights[0].direction, {0, -0.8944F, -0.4472F}, 1e-4F);
  EXPECT_EQ(std::count_if(scene.materials.begin(), scene.materials.end(),
                          [](const Material& m) { return m.mask; }),
            3);
  ASSERT_EQ(scene.textures.size(), 21U);
  for (const auto& texture : scene.textures) {
    texture->decode();
    EXPECT_GT(texture->bytes(), 0U) << texture->label();
  }
  expect_consistent(scene);
}

TEST(RealScenes, CornellBox) {
  const auto file = real_scene("cornell-box/scene.glb");
  if (!present(file)) return;
  const SceneData scene = load_gltf(file);
  EXPECT_EQ(scene.triangle_count(), 36U);
  const Box box = bounds(scene);
  expect_near(box.low, {-1, 0, -1}, 1e-6F);
  expect_near(box.high, {1, 2, 1}, 1e-6F);
  EXPECT_NEAR(emitting_area(scene, Rgb(17, 12, 4)), 0.1786, 1e-4);
  ASSERT_EQ(scene.cameras.size(), 1U);
  expect_near(position(scene.cameras[0]), {0, 1, 6.8F}, 1e-6F);
  expect_consistent(scene);
}

}  // namespace
}  // namespace lacuna
