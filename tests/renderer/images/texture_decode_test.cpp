#include "renderer/images/texture_decode.h"

#include <gtest/gtest.h>

#include "tests/renderer/images/refusals.h"
#include "tests/renderer/images/test_images.h"

namespace lacuna {
namespace {

using test::Bytes;
using test::expect_contains;
using test::make_png;

Bytes texels(const Bytes& file) {
  const auto rgba = decode_png_or_jpeg(file, "test").rgba;
  return {rgba.begin(), rgba.end()};
}

std::string refusal(const Bytes& file) {
  return test::refusal_of([&] { decode_png_or_jpeg(file, "wood"); });
}

Bytes cut(const Bytes& bytes, std::size_t length) {
  return {bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(length)};
}

/// Four grey texels of `bits` bits each, in one row.
Bytes packed_grey(int bits, const Bytes& row) {
  return make_png(4, 1, {.bits = bits, .colour_type = 0}, {row});
}

TEST(TextureDecode, EveryDepthOfGrey) {
  EXPECT_EQ(texels(packed_grey(1, {0x50})),
            (Bytes{0, 0, 0, 255, 255, 255, 255, 255, 0, 0, 0, 255, 255, 255, 255, 255}));
  EXPECT_EQ(texels(packed_grey(2, {0x1b})),
            (Bytes{0, 0, 0, 255, 85, 85, 85, 255, 170, 170, 170, 255, 255, 255, 255, 255}));
  EXPECT_EQ(texels(packed_grey(4, {0x05, 0xaf})),
            (Bytes{0, 0, 0, 255, 85, 85, 85, 255, 170, 170, 170, 255, 255, 255, 255, 255}));
  EXPECT_EQ(texels(packed_grey(8, {0, 1, 254, 255})),
            (Bytes{0, 0, 0, 255, 1, 1, 1, 255, 254, 254, 254, 255, 255, 255, 255, 255}));
  // 16 bits are rounded: 128 and 129 of 257 lie on both sides of a half.
  EXPECT_EQ(texels(packed_grey(16, {0, 128, 0, 129, 255, 126, 255, 255})),
            (Bytes{0, 0, 0, 255, 1, 1, 1, 255, 254, 254, 254, 255, 255, 255, 255, 255}));
}

TEST(TextureDecode, PalettesAndTransparency) {
  const Bytes palette{10, 20, 30, 40, 50, 60, 70, 80, 90};
  const test::PngKind kind{
      .bits = 2, .colour_type = 3, .chunks = {{"PLTE", palette}, {"tRNS", {255, 7}}}};
  EXPECT_EQ(texels(make_png(3, 1, kind, {{0x18}})),
            (Bytes{10, 20, 30, 255, 40, 50, 60, 7, 70, 80, 90, 255}));
  // One colour that is transparent: (1, 2, 3) of RGB, 5 of grey.
  EXPECT_EQ(
      texels(make_png(2, 1, {.chunks = {{"tRNS", {0, 1, 0, 2, 0, 3}}}}, {{1, 2, 3, 1, 2, 4}})),
      (Bytes{1, 2, 3, 0, 1, 2, 4, 255}));
  EXPECT_EQ(texels(make_png(2, 1, {.colour_type = 0, .chunks = {{"tRNS", {0, 5}}}}, {{5, 6}})),
            (Bytes{5, 5, 5, 0, 6, 6, 6, 255}));
}

TEST(TextureDecode, AlphaIsNotMultipliedInAndGammaIsLeftAside) {
  const Bytes row{200, 100, 50, 0, 9, 8, 7, 128};
  Bytes gamma;
  test::put_big(gamma, 100000, 4);  // linear
  EXPECT_EQ(texels(make_png(2, 1, {.colour_type = 6}, {row})), row);
  EXPECT_EQ(texels(make_png(2, 1, {.colour_type = 6, .chunks = {{"gAMA", gamma}}}, {row})), row);
  EXPECT_EQ(
      texels(make_png(2, 1, {.colour_type = 6, .chunks = {{"bKGD", {0, 1, 0, 2, 0, 3}}}}, {row})),
      row);
}

TEST(TextureDecode, Interlaced) {
  // 3 x 3: texel (x, y) is 10 y + x. Passes 1, 4, 5, 6, 7 have texels in them.
  const std::vector<Bytes> passes{{0}, {2}, {20, 22}, {1}, {21}, {10, 11, 12}};
  const Bytes rgba = texels(make_png(3, 3, {.colour_type = 0, .interlaced = true}, passes));
  ASSERT_EQ(rgba.size(), 36U);
  for (std::size_t i = 0; i < 9; ++i) EXPECT_EQ(rgba[4 * i], 10 * (i / 3) + i % 3) << i;
}

TEST(TextureDecode, JpegsOfOneAndThreeChannels) {
  for (const char* name : {"flat.jpg", "grey.jpg", "rgb.jpg", "rgb_large.jpg"}) {
    const Rgba8Image image = decode_png_or_jpeg(test::jpeg_seed(name), name);
    ASSERT_EQ(image.rgba.size(), 4U * static_cast<unsigned>(image.width * image.height)) << name;
    for (std::size_t i = 3; i < image.rgba.size(); i += 4) ASSERT_EQ(image.rgba[i], 255);
  }
  const Bytes flat = texels(test::jpeg_seed("flat.jpg"));
  EXPECT_EQ(flat[0], 102);
  EXPECT_EQ(flat[1], 102);
}

TEST(TextureDecode, OtherFormatsAreRefusedUnseen) {
  const std::vector<std::string> files{"GIF89a",
                                       "8BPS",
                                       std::string("RIFF\x1a\0\0\0WEBPVP8 ", 16),
                                       "DDS |",
                                       std::string("\0\0\0\x18"
                                                   "ftypmp42",
                                                   12),
                                       "BM",
                                       "II*",
                                       "\x76\x2f\x31\x01",
                                       "#?RADIANCE\n",
                                       ""};
  for (const std::string& file : files) {
    expect_contains(refusal(Bytes(file.begin(), file.end())), "wood: neither a PNG nor a JPEG");
  }
}

TEST(TextureDecode, CutFilesAreRefusedWhereverTheyAreCut) {
  const Bytes png = test::encode8(40, 24, 3, Bytes(40 * 24 * 3, 7));
  for (std::size_t n = 8; n < png.size(); n += 7) {
    expect_contains(refusal(cut(png, n)), "wood: is corrupt: it ends early");
  }
  const Bytes jpeg = test::jpeg_seed("rgb_large.jpg");
  for (std::size_t n = 3; n < jpeg.size(); ++n) {
    expect_contains(refusal(cut(jpeg, n)), "wood: is corrupt: it ends early");
  }
}

TEST(TextureDecode, APngThatSaysTooMuchIsRefused) {
  const Bytes one = test::encode8(1, 1, 3, {1, 2, 3});
  const auto with = [&one](std::size_t at, const Bytes& bytes) {
    Bytes png = one;
    std::copy(bytes.begin(), bytes.end(), png.begin() + static_cast<std::ptrdiff_t>(at));
    return png;
  };
  expect_contains(refusal(with(16, {0, 0, 0x40, 1})), "is 16385 x 1 texels; allowed: up to 16384");
  expect_contains(refusal(with(16, {0xff, 0xff, 0xff, 0xff})), "is 4294967295 x 1 texels");
  expect_contains(refusal(with(20, {0, 0, 0, 0})), "is 1 x 0 texels");
  expect_contains(refusal(with(16, {0, 0, 0x40, 0, 0, 0, 0x40, 0})),
                  "bytes cannot hold its 16384 x 16384 texels");
  expect_contains(refusal(with(24, {3})), "has 3 bits a channel; allowed: 1, 2, 4, 8, 16");
  expect_contains(refusal(with(25, {5})), "has colour type 5; allowed: 0, 2, 3, 4, 6");
  expect_contains(refusal(with(29, {0, 0, 0, 0})), "wood: is corrupt: ");  // another checksum
  expect_contains(refusal(with(8, {0xff, 0xff, 0xff, 0xff})), "it ends early");
}

TEST(TextureDecode, AJpegThatSaysTooMuchIsRefused) {
  const Bytes jpeg = test::jpeg_seed("rgb.jpg");
  const Bytes frame{0xFF, 0xC0, 0, 17, 8};
  const auto at = std::search(jpeg.begin(), jpeg.end(), frame.begin(), frame.end());
  ASSERT_NE(at, jpeg.end());
  const auto with = [&](std::ptrdiff_t offset, const Bytes& bytes) {
    Bytes changed = jpeg;
    std::copy(bytes.begin(), bytes.end(), changed.begin() + (at - jpeg.begin()) + offset);
    return changed;
  };
  expect_contains(refusal(with(4, {12})), "has 12 bits a channel; allowed: 8");
  expect_contains(refusal(with(5, {0x40, 1})), "texels; allowed: up to 16384");
  expect_contains(refusal(with(5, {0, 0})), "x 0 texels");
  expect_contains(refusal(with(9, {4})), "is a CMYK JPEG; allowed: grey and RGB");
  expect_contains(refusal(with(9, {2})), "has 2 channels; allowed: 1 and 3");
  expect_contains(refusal(with(1, {0xC3})), "is coded as frame type 3");
  // More rows than there is data for: the library would make them up.
  expect_contains(refusal(with(5, {0x3f, 0})), "wood: is corrupt: ");
}

TEST(TextureDecode, AJpegOfVeryManyScansIsRefused) {
  const Bytes jpeg = test::jpeg_seed("grey.jpg");
  const Bytes scan{0xFF, 0xDA};
  const auto at = std::search(jpeg.begin(), jpeg.end(), scan.begin(), scan.end());
  Bytes many(jpeg.begin(), at);
  for (int i = 0; i < 501; ++i) many.insert(many.end(), at, jpeg.end() - 2);
  many.insert(many.end(), jpeg.end() - 2, jpeg.end());
  expect_contains(refusal(many), "has more than 500 scans");
}

TEST(TextureDecode, WhatMakesNoTexelsNeverReachesTheLibrary) {
  // Text, profiles and camera data, all of them nonsense.
  const Bytes nonsense(40, 0xFF);
  const Bytes row{1, 2, 3};
  const test::PngKind kind{.chunks = {{"iCCP", nonsense}, {"zTXt", nonsense}, {"eXIf", nonsense}}};
  EXPECT_EQ(texels(make_png(1, 1, kind, {row})), (Bytes{1, 2, 3, 255}));
  const Bytes jpeg = test::jpeg_seed("flat.jpg");
  Bytes more(jpeg.begin(), jpeg.begin() + 2);
  for (const std::uint8_t marker : {0xE1, 0xE2, 0xED, 0xFE}) {
    more.insert(more.end(), {0xFF, marker, 0, 42});
    more.insert(more.end(), nonsense.begin(), nonsense.end());
  }
  more.insert(more.end(), jpeg.begin() + 2, jpeg.end());
  EXPECT_EQ(texels(more), texels(jpeg));
}

}  // namespace
}  // namespace lacuna
