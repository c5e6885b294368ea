#include "jobs/import/pbrt/read_pbrt.h"
#include "renderer/core/scene_error.h"
#include "tests/fuzz/imported_scene.h"
#include "tests/fuzz/input_file.h"
#include "tests/fuzz/target.h"

// A scene file of pbrt: refused with a place, or read as a sound scene.

LACUNA_FUZZ_TARGET(pbrt) {
  using namespace lacuna;
  static const fuzz::InputFile file("scene.pbrt");
  const auto& path = file.holding({data, size});
  try {
    const ImportedScene scene = read_pbrt(path, MissingFiles::skip);
    fuzz::expect_sound(scene);
    fuzz::expect(scene.cameras.size() == 1, "there is a camera");
  } catch (const SceneError& e) {
    fuzz::expect(*e.what() != '\0', "an error says something");
  }
  return 0;
}
