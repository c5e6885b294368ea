#include <span>

#include "jobs/import/tga_picture.h"
#include "renderer/core/scene_error.h"
#include "renderer/images/image_read.h"
#include "tests/fuzz/expect.h"
#include "tests/fuzz/target.h"

// A TGA or a PFM, by its first byte: refused, or as many values as its size asks for.

LACUNA_FUZZ_TARGET(picture_file) {
  using namespace lacuna;
  const std::span bytes(data, size);
  try {
    if (size > 0 && bytes[0] == 'P') {
      const FloatImage p = read_pfm(bytes, "input");
      fuzz::expect(p.rgb.size() == 3 * std::size_t(p.width) * std::size_t(p.height),
                   "PFM is whole");
    } else {
      const CodePicture p = read_tga(bytes, "input");
      const auto pixels = std::size_t(p.width) * std::size_t(p.height);
      fuzz::expect(p.codes.size() == pixels * std::size_t(p.channels), "TGA is whole");
    }
  } catch (const SceneError&) {
  }
  return 0;
}
