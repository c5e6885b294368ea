#include <gtest/gtest.h>

#include "renderer/geometry/surface.h"
#include "tests/renderer/scene/scene_parts.h"

namespace lacuna {
namespace {

/// Flat and smooth, plain and textured meshes, and the last one as an instance.
SceneData triangles_of_all_kinds() {
  test::SceneParts parts;
  Material wood = test::diffuse(Rgb(0.5F));
  wood.base_color_texture.texture = 0;
  const auto plain = parts.material(test::lamp(Rgb(1), true)), textured = parts.material(wood);
  SceneData& data = parts.data;
  for (const bool smooth : {false, true}) {
    for (const auto material : {plain, textured}) {
      parts.quad({0.1F, 0.2F, 0.3F}, {1, 0.3F, 0}, {0.25F, 1, 0.7F}, material);
      Mesh& mesh = data.meshes.back();
      if (smooth) mesh.normals = {V3f(0, 0, 1), V3f(1, 0, 0), V3f(0.6F, 0, 0.8F), V3f(0, 1, 0)};
    }
  }
  data.meshes.back().uvs[1] = {{0, 0}, {0, 2}, {3, 0}, {4, 4}};
  data.prototypes.push_back({3, 1});
  M44d stretched;
  stretched.setScale(V3d(1, 2, 3));
  data.instances.emplace_back(stretched, 0);
  data.bound_ray_errors();
  return std::move(data);
}

TEST(TriangleTable, ComputesTheBitsThatItDoesNotStore) {
  const SceneData data = triangles_of_all_kinds();
  const ThreadPool pool(2);
  const std::size_t records = data.stored_triangles() * sizeof(TriangleRecord);
  const TriangleTable all(data, pool), only_records(data, pool, records), none(data, pool, 0);
  EXPECT_TRUE(all.stored());
  EXPECT_FALSE(only_records.stored());
  EXPECT_FALSE(none.stored());
  for (Hit hit{.u = 0.3F, .v = 0.6F}; hit.mesh < data.meshes.size(); ++hit.mesh) {
    if (hit.mesh == data.prototypes[0].first_mesh) hit.instance = 0;
    for (hit.triangle = 0; hit.triangle < 2; ++hit.triangle) {
      const TriangleShape shape = placed_triangle(data, all, hit);
      const Surface expected = Surface::of_any(data, all, hit, shape.at(hit.u, hit.v));
      for (const TriangleTable* table : {&only_records, &none}) {
        const TriangleShape same = placed_triangle(data, *table, hit);
        EXPECT_EQ(same.corners, shape.corners);
        EXPECT_EQ(same.plane_error, shape.plane_error);
        const Surface s = Surface::of_any(data, *table, hit, expected.x);
        EXPECT_EQ(s.ng, expected.ng);
        EXPECT_EQ(s.ns, expected.ns);
        EXPECT_EQ(s.offset, expected.offset);
        EXPECT_EQ(s.uv, expected.uv);
        EXPECT_EQ(s.material, expected.material);
        EXPECT_EQ(s.emits_behind, expected.emits_behind);
      }
    }
  }
}

}  // namespace
}  // namespace lacuna
