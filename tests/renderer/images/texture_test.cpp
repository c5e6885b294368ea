#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "renderer/geometry/scene_data.h"
#include "tests/renderer/images/test_images.h"

namespace lacuna {
namespace {

using Encoding = Texture::Encoding;
using Wrap = Texture::Wrap;
using test::encode8;

Texture decoded(const test::Bytes& image, Encoding encoding = Encoding::linear,
                Wrap wrap_s = Wrap::repeat, Wrap wrap_t = Wrap::repeat) {
  Texture texture("test", image, encoding, wrap_s, wrap_t);
  texture.decode();
  return texture;
}

/// Four texels in a row: 0, 51, 102, 255.
test::Bytes ramp() { return encode8(4, 1, 1, {0, 51, 102, 255}); }

/// The value at the centre of texel `i` of the ramp's row, which may lie outside of 0..3.
float at_texel(const Texture& texture, int i) {
  return texture.lookup({(static_cast<float>(i) + 0.5F) / 4, 0.5F}).rgb.x;
}

TEST(Texture, CentresOfTexelsAreExact) {
  const Texture t = decoded(ramp());
  EXPECT_FLOAT_EQ(at_texel(t, 0), 0);
  EXPECT_FLOAT_EQ(at_texel(t, 1), 0.2F);
  EXPECT_FLOAT_EQ(at_texel(t, 2), 0.4F);
  EXPECT_FLOAT_EQ(at_texel(t, 3), 1);
  EXPECT_FLOAT_EQ(t.lookup({0.5F, 0.5F}).rgb.x, 0.3F);  // half way between the middle texels
}

TEST(Texture, WrapModes) {
  const Texture repeat = decoded(ramp(), Encoding::linear, Wrap::repeat);
  const Texture mirrored = decoded(ramp(), Encoding::linear, Wrap::mirrored);
  const Texture clamp = decoded(ramp(), Encoding::linear, Wrap::clamp);
  const std::vector<float> row{0, 0.2F, 0.4F, 1};
  for (int i = -8; i < 12; ++i) {
    const auto period = static_cast<std::size_t>((i + 8) % 4);
    const auto two = static_cast<std::size_t>((i + 8) % 8);
    EXPECT_NEAR(at_texel(repeat, i), row[period], 1e-6F) << i;
    EXPECT_NEAR(at_texel(mirrored, i), row[two < 4 ? two : 7 - two], 1e-6F) << i;
    EXPECT_NEAR(at_texel(clamp, i), row[static_cast<std::size_t>(std::clamp(i, 0, 3))], 1e-6F) << i;
  }
  // At the border itself: half of each neighbour when repeating, the border texel otherwise.
  EXPECT_NEAR(repeat.lookup({0, 0.5F}).rgb.x, 0.5F, 1e-6F);
  EXPECT_NEAR(mirrored.lookup({1, 0.5F}).rgb.x, 1, 1e-6F);
  EXPECT_NEAR(clamp.lookup({1, 0.5F}).rgb.x, 1, 1e-6F);
}

TEST(Texture, TheAxesWrapOnTheirOwnAndVPointsDown) {
  const Texture t =
      decoded(encode8(2, 2, 1, {0, 51, 102, 255}), Encoding::linear, Wrap::clamp, Wrap::repeat);
  EXPECT_NEAR(t.lookup({0.25F, 0.25F}).rgb.x, 0, 1e-6F);
  EXPECT_NEAR(t.lookup({0.75F, 0.25F}).rgb.x, 0.2F, 1e-6F);
  EXPECT_NEAR(t.lookup({0.25F, 0.75F}).rgb.x, 0.4F, 1e-6F);
  EXPECT_NEAR(t.lookup({1.25F, 1.25F}).rgb.x, 0.2F, 1e-6F);
}

TEST(Texture, SrgbIsDecodedBeforeInterpolation) {
  const Texture t = decoded(encode8(2, 1, 3, {0, 10, 188, 255, 11, 128}), Encoding::srgb,
                            Wrap::clamp, Wrap::clamp);
  const Rgb left = t.lookup({0.25F, 0}).rgb;
  const Rgb right = t.lookup({0.75F, 0}).rgb;
  EXPECT_FLOAT_EQ(left.x, 0);
  EXPECT_NEAR(left.y, 10 / 255.0 / 12.92, 1e-7);  // the linear piece
  EXPECT_NEAR(left.z, 0.502886, 1e-5);
  EXPECT_FLOAT_EQ(right.x, 1);
  EXPECT_NEAR(right.y, 0.00334654, 1e-7);  // just above the bend
  EXPECT_NEAR(right.z, 0.215861, 1e-6);
  EXPECT_NEAR(t.lookup({0.5F, 0}).rgb.x, 0.5F, 1e-6F) << "bytes must not be averaged";
}

TEST(Texture, AlphaIsLinearAndNotMultipliedIn) {
  const Texture t = decoded(encode8(1, 1, 4, {255, 188, 128, 51}), Encoding::srgb);
  const Rgba c = t.lookup({0, 0});
  EXPECT_FLOAT_EQ(c.rgb.x, 1);
  EXPECT_NEAR(c.rgb.y, 0.502886, 1e-5);
  EXPECT_NEAR(c.rgb.z, 0.215861, 1e-6);
  EXPECT_FLOAT_EQ(c.a, 0.2F);
}

TEST(Texture, GreyAndGreyAlpha) {
  const Rgba grey = decoded(encode8(1, 1, 1, {51})).lookup({0, 0});
  EXPECT_EQ(grey.rgb, Rgb(0.2F));
  EXPECT_EQ(grey.a, 1.0F);
  const Rgba alpha = decoded(encode8(1, 1, 2, {51, 102})).lookup({0, 0});
  EXPECT_EQ(alpha.rgb, Rgb(0.2F));
  EXPECT_EQ(alpha.a, 0.4F);
}

TEST(Texture, SixteenBitsAreRounded) {
  test::Bytes pixel;
  for (const int v : {0, 257 * 100, 65535}) test::put_big(pixel, static_cast<std::uint64_t>(v), 2);
  const test::Bytes png = test::make_png(1, 1, {.bits = 16}, {pixel});
  const Rgb c = decoded(png).lookup({0, 0}).rgb;
  EXPECT_FLOAT_EQ(c.x, 0);
  EXPECT_FLOAT_EQ(c.y, 100 / 255.0F);
  EXPECT_FLOAT_EQ(c.z, 1);
}

TEST(Texture, JpegIsRead) {
  const Texture t = decoded(test::jpeg_seed("flat.jpg"));
  EXPECT_NEAR(t.lookup({0.3F, 0.6F}).rgb.x, 0.4F, 0.01F);
}

TEST(Texture, AnyCoordinateIsSafe) {
  constexpr float inf = std::numeric_limits<float>::infinity();
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  constexpr float max = std::numeric_limits<float>::max();
  for (const Wrap wrap : {Wrap::repeat, Wrap::mirrored, Wrap::clamp}) {
    const Texture t = decoded(encode8(2, 2, 1, {51, 102, 153, 204}), Encoding::linear, wrap, wrap);
    for (const float u : {inf, -inf, nan}) {
      EXPECT_FLOAT_EQ(t.lookup({u, 0.75F}).rgb.x, 0.2F);
      EXPECT_FLOAT_EQ(t.lookup({0.75F, u}).rgb.x, 0.2F);
    }
    for (const float u : {max, -max, 1e10F, -1e10F, -1e-9F, 1 - 1e-7F, 2 - 1e-7F, 0.0F, -0.0F, 1.0F,
                          -1e-40F, 16777217.0F}) {
      for (const V2f& uv : {V2f(u, 0.5F), V2f(0.5F, u), V2f(u, u)}) {
        const float value = t.lookup(uv).rgb.x;
        EXPECT_GE(value, 0.2F - 1e-6F) << uv;
        EXPECT_LE(value, 0.8F + 1e-6F) << uv;
      }
    }
  }
}

TEST(Texture, DecodingTwiceIsHarmless) {
  Texture t("test", ramp(), Encoding::linear, Wrap::clamp, Wrap::clamp);
  EXPECT_FALSE(t.decoded());
  EXPECT_EQ(t.bytes(), 0U);
  t.decode();
  t.decode();
  EXPECT_TRUE(t.decoded());
  EXPECT_EQ(t.bytes(), 16U);
}

TEST(Texture, TooLargeIsRefusedBeforeReading) {
  const std::vector<std::uint8_t> row(16385, 7);
  Texture wide("wide.png", encode8(16385, 1, 1, row), Encoding::linear, Wrap::clamp, Wrap::clamp);
  try {
    wide.decode();
    FAIL();
  } catch (const SceneError& e) {
    EXPECT_NE(std::string(e.what()).find("wide.png: is 16385 x 1 texels; allowed: up to 16384"),
              std::string::npos)
        << e.what();
  }
}

}  // namespace
}  // namespace lacuna
