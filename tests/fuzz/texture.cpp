#include "renderer/images/texture_means.h"

#include "renderer/geometry/scene_data.h"
#include "tests/fuzz/expect.h"
#include "tests/fuzz/target.h"

// A PNG or JPEG of a scene: refused, or texels that can be looked up anywhere.

LACUNA_FUZZ_TARGET(texture) {
  using namespace lacuna;
  Texture texture("input", {data, data + size}, Texture::Encoding::srgb, Texture::Wrap::repeat,
                  Texture::Wrap::mirrored);
  try {
    texture.decode();
  } catch (const SceneError&) {
    return 0;
  }
  fuzz::expect(texture.decoded() && texture.bytes() % 4 == 0, "a texture has RGBA texels");
  const auto is_colour = [](const Rgba& c) {
    return c.rgb.x >= 0 && c.rgb.x <= 1 && c.a >= 0 && c.a <= 1;
  };
  for (const V2f& uv : {V2f(0, 0), V2f(1, 1), V2f(0.3F, -7.7F), V2f(3e38F, -3e38F)}) {
    fuzz::expect(is_colour(texture.lookup(uv)), "a texel lies in [0, 1]");
  }
  const V3d mean = TextureMeans(texture).whole();
  fuzz::expect(mean.x >= 0 && mean.x <= 1.001, "so does the mean, up to rounding");
  return 0;
}
