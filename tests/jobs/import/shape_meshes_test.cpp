#include "jobs/import/shape_meshes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lacuna {
namespace {

constexpr double pi = std::numbers::pi;

/// Of the triangles: area vectors (half the cross product of their sides).
std::vector<V3d> area_vectors(const ImportedMesh& mesh) {
  std::vector<V3d> out;
  for (const auto& t : mesh.triangles) {
    const V3d a(mesh.positions[t[0]]), b(mesh.positions[t[1]]), c(mesh.positions[t[2]]);
    out.push_back((b - a).cross(c - a) / 2);
  }
  return out;
}

double area(const ImportedMesh& mesh) {
  double sum = 0;
  for (const V3d& a : area_vectors(mesh)) sum += a.length();
  return sum;
}

void expect_fronts_agree_with_normals(const ImportedMesh& mesh) {
  ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
  ASSERT_EQ(mesh.uvs.size(), mesh.positions.size());
  const auto areas = area_vectors(mesh);
  for (std::size_t i = 0; i < areas.size(); ++i) {
    ASSERT_GT(areas[i].length(), 0);
    for (const auto corner : mesh.triangles[i]) {
      EXPECT_GT(areas[i].normalized().dot(V3d(mesh.normals[corner])), .99) << mesh.name << i;
      EXPECT_NEAR(mesh.normals[corner].length(), 1, 1e-6);
    }
  }
}

TEST(ShapeMeshes, FrontsAndNormalsPointOut) {
  for (const ImportedMesh& mesh :
       {sphere_mesh(), sphere_mesh(-.5, .8, 1), cylinder_mesh(), cylinder_mesh(2), disk_mesh(),
        disk_mesh(.3, 3), rectangle_mesh(), cube_mesh()}) {
    expect_fronts_agree_with_normals(mesh);
  }
}

TEST(ShapeMeshes, AreasAreThoseOfTheSmoothShapes) {
  EXPECT_NEAR(area(sphere_mesh()), 4 * pi, 1e-5);
  EXPECT_NEAR(area(sphere_mesh(-.5, .8, 1)), 1.3, 1e-3);  // phi (z_max - z_min)
  EXPECT_NEAR(area(cylinder_mesh()), 2 * pi, 1e-3);
  EXPECT_NEAR(area(disk_mesh()), pi, 1e-5);
  EXPECT_NEAR(area(disk_mesh(.3, 3)), 1.5 * (1 - .09), 1e-5);
  EXPECT_NEAR(area(rectangle_mesh()), 4, 1e-6);
  EXPECT_NEAR(area(cube_mesh()), 24, 1e-6);
}

/// Of a convex body the area of the shadow in a direction is half the sum of |n . d| dA.
TEST(ShapeMeshes, SilhouetteOfTheSphereIsACircleInAllDirections) {
  const auto areas = area_vectors(sphere_mesh());
  for (int i = 0; i < 60; ++i) {
    const double z = 1 - 2 * (i + .5) / 60, phi = i * 2.4, r = std::sqrt(1 - z * z);
    const V3d d(r * std::cos(phi), r * std::sin(phi), z);
    double shadow = 0;
    for (const V3d& a : areas) shadow += std::abs(a.dot(d)) / 2;
    EXPECT_NEAR(shadow / pi, 1, 1e-4) << d;
  }
}

TEST(ShapeMeshes, CoordinatesOfTheSphereFollowAzimuthAndPolarAngle) {
  const ImportedMesh mesh = sphere_mesh();
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const V3d p = V3d(mesh.positions[i]), n = V3d(mesh.normals[i]);
    EXPECT_NEAR(p.length(), 1, 3e-4);
    EXPECT_NEAR(mesh.uvs[i].y, 1 - std::acos(n.z) / pi, 1e-3);
    if (std::hypot(n.x, n.y) < 1e-6 || mesh.uvs[i].x > .999F) continue;
    const double phi = std::atan2(n.y, n.x);
    EXPECT_NEAR(mesh.uvs[i].x, (phi < -1e-6 ? phi + 2 * pi : phi) / (2 * pi), 1e-5);
  }
}

}  // namespace
}  // namespace lacuna
