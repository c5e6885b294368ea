#include <cmath>

#include "jobs/import/pbrt/pbrt_import.h"
#include "renderer/core/scene_error.h"
#include "tests/fuzz/input_file.h"

// A scene file of pbrt: refused with a place, or shapes of triangles that are there, with a
// material.

namespace lacuna::fuzz {
namespace {

bool is_finite(const M44d& m) {
  for (int i = 0; i < 16; ++i) {
    if (!std::isfinite(m[i / 4][i % 4])) return false;
  }
  return true;
}

void check(const ImportedScene& scene) {
  for (const ImportedShape& s : scene.shapes) {
    expect(s.mesh != nullptr && s.material != nullptr, "a shape has a mesh and a material");
    const std::size_t n = s.mesh->positions.size();
    expect(s.mesh->normals.empty() || s.mesh->normals.size() == n, "normals are those of points");
    expect(s.mesh->uvs.empty() || s.mesh->uvs.size() == n, "so are texture coordinates");
    for (const auto& t : s.mesh->triangles) {
      expect(t[0] < n && t[1] < n && t[2] < n, "a triangle's points are there");
    }
    expect(is_finite(s.to_world), "a shape has a place");
  }
  expect(scene.cameras.size() == 1 && is_finite(scene.cameras[0].to_world), "there is a camera");
  expect(scene.picture.resolution[0] > 0 && scene.picture.resolution[1] > 0,
         "a picture has pixels");
}

}  // namespace
}  // namespace lacuna::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace lacuna;
  static const fuzz::InputFile file("scene.pbrt");
  const auto& path = file.holding({data, size});
  try {
    fuzz::check(import_pbrt(path, MissingFiles::skip));
  } catch (const SceneError& e) {
    fuzz::expect(*e.what() != '\0', "an error says something");
  }
  return 0;
}
