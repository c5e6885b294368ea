#include <string_view>

#include "jobs/import/mitsuba/read_mitsuba.h"
#include "renderer/core/scene_error.h"
#include "tests/fuzz/imported_scene.h"
#include "tests/fuzz/target.h"

// A scene file of Mitsuba that names no others: refused with a place, or read as a sound scene.

LACUNA_FUZZ_TARGET(mitsuba) {
  using namespace lacuna;
  try {
    fuzz::expect_sound(read_mitsuba_text({reinterpret_cast<const char*>(data), size}));
  } catch (const SceneError& e) {
    fuzz::expect(*e.what() != '\0', "an error says something");
  }
  return 0;
}
