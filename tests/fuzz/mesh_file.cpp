#include <string>

#include "jobs/import/mesh_normals.h"
#include "jobs/import/mitsuba/mesh_files.h"
#include "jobs/import/ply_mesh.h"
#include "renderer/core/scene_error.h"
#include "tests/fuzz/imported_scene.h"
#include "tests/fuzz/target.h"

// A file as a mesh, by its first byte: PLY, one of Mitsuba's own (0x1C), else OBJ. Refused, or a
// sound mesh.

namespace {

lacuna::ImportedMesh mesh_of(std::span<const std::uint8_t> bytes) {
  using namespace lacuna;
  const std::uint8_t first = bytes.empty() ? 0 : bytes[0];
  if (first == 'p') return ply_mesh(bytes, "mesh.ply");
  if (first == 0x1C) return mitsuba::serialized_mesh(bytes, 0, "mesh.serialized");
  auto file = mitsuba::obj_file({bytes.begin(), bytes.end()}, "mesh.obj");
  return file.parts.empty() ? ImportedMesh() : std::move(file.parts[0].mesh);
}

}  // namespace

LACUNA_FUZZ_TARGET(mesh_file) {
  using namespace lacuna;
  try {
    ImportedMesh mesh = mesh_of({data, size});
    fuzz::expect_sound(mesh);
    add_smooth_normals(mesh);
    orient_by_normals(mesh);
    fuzz::expect_sound(mesh);
  } catch (const SceneError& e) {
    fuzz::expect(*e.what() != '\0', "an error says something");
  }
  return 0;
}
