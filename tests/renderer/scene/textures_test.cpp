#include <gtest/gtest.h>

#include "renderer/core/scene_error.h"
#include "renderer/images/guards.h"
#include "tests/renderer/images/refusals.h"
#include "tests/renderer/images/test_images.h"
#include "tests/renderer/scene/scene_parts.h"

namespace lacuna {
namespace {

/// The head of a PNG of so many texels a side, and nothing else.
test::Bytes png_head(std::uint32_t side) {
  test::Bytes png{0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
  test::Bytes header;
  test::put_big(header, side, 4);
  test::put_big(header, side, 4);
  header.insert(header.end(), {8, 2, 0, 0, 0});
  test::put_chunk(png, "IHDR", header);
  return png;
}

/// What a scene of `n` such textures is refused for.
std::string refusal(int n, std::uint32_t side) {
  test::SceneParts parts;
  for (int i = 0; i < n; ++i) {
    Material m = test::diffuse(Rgb(1));
    m.base_color_texture.texture = i;
    parts.data.textures.push_back(
        std::make_unique<Texture>("wood", png_head(side), Texture::Encoding::srgb,
                                  Texture::Wrap::repeat, Texture::Wrap::repeat));
    parts.quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, parts.material(m));
  }
  const ThreadPool pool(1);
  return test::refusal_of(
      [&] { Scene(std::move(parts.data), {.materials = true}, std::nullopt, pool); });
}

TEST(SceneTextures, HaveALimitTogether) {
  static_assert(max_scene_texels == 536'870'912);
  test::expect_contains(refusal(3, 16384), "805306368 texels together; allowed: up to 536870912");
  test::expect_contains(refusal(33, 4096), "553648128 texels together");
  // At the limit they are looked at one by one: these are cut off.
  test::expect_contains(refusal(2, 16384), "wood: is corrupt");
}

}  // namespace
}  // namespace lacuna
