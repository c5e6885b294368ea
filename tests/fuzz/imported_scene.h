#pragma once

#include <cmath>

#include "jobs/import/imported_scene.h"
#include "tests/fuzz/expect.h"

namespace lacuna::fuzz {

inline bool is_finite(const M44d& m) {
  for (int i = 0; i < 16; ++i) {
    if (!std::isfinite(m[i / 4][i % 4])) return false;
  }
  return true;
}

inline void expect_sound(const ImportedMesh& mesh) {
  const std::size_t n = mesh.positions.size();
  expect(mesh.normals.empty() || mesh.normals.size() == n, "normals are those of points");
  expect(mesh.uvs.empty() || mesh.uvs.size() == n, "so are texture coordinates");
  expect(mesh.colors.empty() || mesh.colors.size() == n, "so are colours");
  for (const auto& t : mesh.triangles) {
    expect(t[0] < n && t[1] < n && t[2] < n, "a triangle's points are there");
  }
}

/// Shapes of triangles that are there, with a material; cameras and a picture.
inline void expect_sound(const ImportedScene& scene) {
  for (const ImportedShape& s : scene.shapes) {
    expect(s.mesh != nullptr && s.material != nullptr, "a shape has a mesh and a material");
    expect_sound(*s.mesh);
    expect(is_finite(s.to_world), "a shape has a place");
  }
  for (const ImportedCamera& camera : scene.cameras) {
    expect(is_finite(camera.to_world), "a camera has a place");
  }
  expect(scene.picture.resolution[0] > 0 && scene.picture.resolution[1] > 0,
         "a picture has pixels");
}

}  // namespace lacuna::fuzz
