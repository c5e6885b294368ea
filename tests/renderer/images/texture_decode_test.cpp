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
  const auto rgba = decode_texture(file, "test").rgba;
  return {rgba.begin(), rgba.end()};
}

std::string refusal(const Bytes& file) {
  return test::refusal_of([&] { decode_texture(file, "wood"); });
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
    const Rgba8Image image = decode_texture(test::jpeg_seed(name), name);
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
                                       std::string("RIFF\x1a\0\0\0WAVEfmt ", 16),
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
    expect_contains(refusal(Bytes(file.begin(), file.end())),
                    "wood: neither a PNG nor a JPEG, WebP or TIFF");
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

/// libwebp's: red, half transparent green, blue of alpha 64, (200, 100, 50); two rows of two.
const Bytes lossless{0x52, 0x49, 0x46, 0x46, 0x3c, 0x00, 0x00, 0x00, 0x57, 0x45, 0x42, 0x50,
                     0x56, 0x50, 0x38, 0x4c, 0x30, 0x00, 0x00, 0x00, 0x2f, 0x01, 0x40, 0x00,
                     0x10, 0x1f, 0x20, 0x10, 0x48, 0x92, 0xdd, 0x1f, 0x61, 0x0d, 0x81, 0x00,
                     0xc1, 0xff, 0x98, 0x2b, 0x02, 0x01, 0x82, 0x25, 0xff, 0x6f, 0x04, 0x02,
                     0xc4, 0x1a, 0x65, 0xd2, 0x85, 0x99, 0x3b, 0x52, 0x05, 0x35, 0x6d, 0x1b,
                     0xb0, 0xf8, 0x4d, 0x3a, 0x22, 0xfa, 0x1f, 0x1c};
/// The same, lossy, with a canvas and a chunk of alpha.
const Bytes lossy{
    0x52, 0x49, 0x46, 0x46, 0x76, 0x00, 0x00, 0x00, 0x57, 0x45, 0x42, 0x50, 0x56, 0x50, 0x38, 0x58,
    0x0a, 0x00, 0x00, 0x00, 0x10, 0x00, 0x00, 0x00, 0x01, 0x00, 0x00, 0x01, 0x00, 0x00, 0x41, 0x4c,
    0x50, 0x48, 0x05, 0x00, 0x00, 0x00, 0x00, 0xff, 0x80, 0x40, 0xff, 0x00, 0x56, 0x50, 0x38, 0x20,
    0x4a, 0x00, 0x00, 0x00, 0x70, 0x02, 0x00, 0x9d, 0x01, 0x2a, 0x02, 0x00, 0x02, 0x00, 0x00, 0x00,
    0x00, 0x25, 0xa0, 0x02, 0x74, 0xba, 0x01, 0xf8, 0x01, 0xfa, 0x00, 0x03, 0x32, 0x95, 0xdf, 0x00,
    0x00, 0xfe, 0xfe, 0xc1, 0xff, 0xfd, 0x67, 0xff, 0xcc, 0x7f, 0x76, 0x43, 0xff, 0x92, 0x6f, 0xff,
    0xd5, 0x27, 0x5a, 0xe9, 0x62, 0xb4, 0x2b, 0x7f, 0x63, 0xff, 0xf7, 0x0c, 0x00, 0x26, 0x37, 0x6f,
    0xfe, 0xe1, 0x87, 0xff, 0xe6, 0x44, 0xef, 0x36, 0xd5, 0xdf, 0xfe, 0x62, 0x00, 0x00};

TEST(TextureDecode, WebpWithAlphaThatIsNotMultipliedIn) {
  EXPECT_EQ(texels(lossless),
            (Bytes{255, 0, 0, 255, 0, 255, 0, 128, 0, 0, 255, 64, 200, 100, 50, 255}));
  // As libwebp itself decodes it.
  EXPECT_EQ(texels(lossy),
            (Bytes{138, 55, 17, 255, 214, 131, 93, 128, 93, 10, 0, 64, 186, 103, 65, 255}));
  EXPECT_EQ(texels_of_texture(lossless, "test"), 4U);
  EXPECT_EQ(texels_of_texture(lossy, "test"), 4U);
}

/// Two texels of `channels` integers of `bits`, as make_tiff() puts four bytes into a float.
Bytes integer_tiff(std::uint32_t channels, std::uint32_t bits, const std::vector<float>& four_bytes,
                   const std::vector<test::TiffEntry>& more = {}) {
  std::vector<test::TiffEntry> entries{{258, std::vector<std::uint32_t>(channels, bits)},
                                       {339, std::vector<std::uint32_t>(channels, 1)}};
  entries.insert(entries.end(), more.begin(), more.end());
  return test::make_tiff(2, 1, static_cast<int>(channels), four_bytes, entries);
}

TEST(TextureDecode, TiffOfIntegers) {
  const auto bytes = [](std::uint32_t b) { return std::bit_cast<float>(b); };
  const std::vector<float> two{bytes(0x40030201), bytes(0x80060504)};
  EXPECT_EQ(texels(integer_tiff(4, 8, two, {{338, {2}}})), (Bytes{1, 2, 3, 64, 4, 5, 6, 128}));
  EXPECT_EQ(texels(integer_tiff(1, 16, {bytes(0x01010000 * 7 + 257 * 9)})),
            (Bytes{9, 9, 9, 255, 7, 7, 7, 255}));
  EXPECT_EQ(texels_of_texture(integer_tiff(4, 8, two), "test"), 2U);
  expect_contains(refusal(integer_tiff(4, 8, two, {{338, {1}}})), "wood: has alpha that is mult");
  expect_contains(refusal(integer_tiff(4, 8, two, {{274, {3}}})), "has orientation 3; allowed: 1");
  expect_contains(refusal(test::make_tiff(1, 1, 1, {1.0F})),
                  "has 32-bit floats; allowed: 8- and 16-bit unsigned integers");
}

TEST(TextureDecode, WebpThatIsCutOrAnAnimationIsRefused) {
  for (std::size_t n = 12; n + 1 < lossy.size(); ++n) {
    EXPECT_NE(refusal(cut(lossy, n)), "accepted") << n << " bytes";
  }
  for (std::size_t n = 12; n < lossless.size(); ++n) {
    EXPECT_NE(refusal(cut(lossless, n)), "accepted") << n << " bytes";
  }
  Bytes changed = lossy;
  changed[20] |= 2;
  expect_contains(refusal(changed), "wood: is an animation; allowed: one image");
  changed = lossy;
  changed[24] = 7;
  expect_contains(refusal(changed), "its frame is not as large as its canvas");
  changed = lossless;
  changed[20] = 0;
  expect_contains(refusal(changed), "its frame has no signature");
}

}  // namespace
}  // namespace lacuna
