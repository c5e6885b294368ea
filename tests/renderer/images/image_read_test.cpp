#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "renderer/images/image_read.h"
#include "tests/renderer/images/refusals.h"
#include "tests/renderer/images/test_images.h"

namespace lacuna {
namespace {

std::filesystem::path write_channels(const TemporaryFolder& folder,
                                     const std::vector<std::string>& channels,
                                     const std::vector<float>& pixels, int width, int height) {
  return test::write_exr_file(folder, "image.exr", channels, pixels, width, height);
}

std::string image_refusal(const std::filesystem::path& file, const std::string& layer = "") {
  return test::refusal_of([&] { read_float_image(file, layer); });
}

using test::expect_contains;

TEST(ImageRead, ExrWithLayersInAnyOrder) {
  const TemporaryFolder folder;
  const auto file = write_channels(folder, {"B", "half_a.G", "R", "G", "half_a.B", "A", "half_a.R"},
                                   {3, 20, 1, 2, 30, 9, 10, 6, 50, 4, 5, 60, 9, 40}, 2, 1);
  const FloatImage plain = read_float_image(file);
  EXPECT_EQ(plain.width, 2);
  EXPECT_EQ(plain.height, 1);
  EXPECT_EQ(plain.at(0, 0), Rgb(1, 2, 3));
  EXPECT_EQ(plain.at(1, 0), Rgb(4, 5, 6));
  EXPECT_EQ(plain.least_alpha, 9);
  const FloatImage half = read_float_image(file, "half_a");
  EXPECT_EQ(half.at(0, 0), Rgb(10, 20, 30));
  EXPECT_EQ(half.at(1, 0), Rgb(40, 50, 60));
  EXPECT_FALSE(half.least_alpha);
  expect_contains(image_refusal(file, "half_b"),
                  "lacks channel half_b.R, half_b.G, half_b.B; it has");
}

// White of luminance 2, and red: of CIE XYZ the rows of the matrix of ITU-R BT.709-6.
TEST(ImageRead, XyzBecomesRgb) {
  const TemporaryFolder folder;
  const auto file = write_channels(
      folder, {"Z", "A", "X", "Y", "s.Z", "s.X", "s.Y"},
      {2 * 1.0890578F, 9, 2 * 0.9504559F, 2, 0.0193308F, 0.4123908F, 0.2126390F}, 1, 1);
  const Rgb white = read_float_image(file).at(0, 0), red = read_float_image(file, "s").at(0, 0);
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(white[k], 2, 1e-5);
    EXPECT_NEAR(red[k], k == 0 ? 1 : 0, 1e-6);
    EXPECT_GE(red[k], 0) << "rounding is no negative light";
  }
  EXPECT_NO_THROW(require_radiance(read_float_image(file, "s"), "sky"));
  const auto green = write_channels(folder, {"X", "Y", "Z"}, {0.1F, 0.8F, 0.1F}, 1, 1);
  EXPECT_LT(read_float_image(green).at(0, 0).x, -0.1F) << "more green than the primaries hold";
}

TEST(ImageRead, OneOfSeveralChannelsIsNoGrey) {
  const TemporaryFolder folder;
  for (const std::vector<std::string>& channels : {std::vector<std::string>{"Y", "RY", "BY"},
                                                   {"X", "Y", "A"},
                                                   {"R", "Y", "A"},
                                                   {"diffuse.R", "diffuse.G", "diffuse.B"},
                                                   {"Z", "A", "r"}}) {
    const std::string message = image_refusal(write_channels(folder, channels, {1, 2, 3}, 1, 1));
    expect_contains(message, "image.exr: lacks channel ");
    for (const std::string& name : channels) expect_contains(message, name);
  }
  EXPECT_EQ(read_float_image(write_channels(folder, {"A", "Y", "Z"}, {1, 2, 3}, 1, 1)).at(0, 0),
            Rgb(2))
      << "grey with its depth";
}

TEST(ImageRead, RgbOfOtherPrimariesIsRefused) {
  const TemporaryFolder folder;
  const auto write = [&](const std::vector<float>& xy, const std::string& channel) {
    std::string value(32, '\0');
    std::memcpy(value.data(), xy.data(), 32);
    return test::write_exr_file(folder, "a.exr", {channel + "R", channel + "G", channel + "B"},
                                {1, 2, 3}, 1, 1,
                                {.attributes = {{{"chromaticities", "chromaticities", value}}}});
  };
  const std::vector<float> aces{.7347F, .2653F, 0, 1, .0001F, -.077F, .32168F, .33767F};
  expect_contains(image_refusal(write(aces, "")),
                  "a.exr: has channel \"R\" of the primaries and white 0.7347 0.2653 0 1 0.0001 "
                  "-0.077 0.3217 0.3377; allowed: those of Rec. 709, 0.64 0.33 0.3");
  expect_contains(image_refusal(write(aces, "half_a."), "half_a"), "has channel \"half_a.R\"");
  const std::vector<float> rec709{.64F, .33F, .3F, .6F, .15F, .06F, .3127F, .329F};
  EXPECT_EQ(read_float_image(write(rec709, "")).at(0, 0), Rgb(1, 2, 3));
}

TEST(ImageRead, GreyAndMissingChannels) {
  const TemporaryFolder folder;
  EXPECT_EQ(read_float_image(write_channels(folder, {"Y"}, {0.5F, 7}, 1, 2)).at(0, 1), Rgb(7));
  expect_contains(image_refusal(write_channels(folder, {"R", "B"}, {1, 2}, 1, 1)),
                  "lacks channel G; it has");
}

constexpr const char* hdr_header = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n";

std::filesystem::path write_hdr(const TemporaryFolder& folder, const std::string& size,
                                const test::Bytes& pixels) {
  return folder.write("image.hdr",
                      hdr_header + size + "\n" + std::string(pixels.begin(), pixels.end()));
}

/// One pixel (1, 1, 1) under these lines. Where the last is "\\r" all line ends are CRLF.
std::filesystem::path write_white(const TemporaryFolder& folder, const std::string& lines) {
  const std::string end = lines.ends_with('\r') ? "\r\n" : "\n";
  return folder.write("white.hdr",
                      "#?RADIANCE" + end + lines + "\n-Y 1 +X 1" + end + "\x80\x80\x80\x81");
}

TEST(ImageRead, RadianceHdr) {
  const TemporaryFolder folder;
  const FloatImage image = read_float_image(write_hdr(folder, "-Y 2 +X 2",
                                                      {128, 64, 32, 129, 128, 64, 32, 139,  //
                                                       128, 128, 128, 130, 9, 9, 9, 0}));
  EXPECT_EQ(image.at(0, 0), Rgb(1, 0.5F, 0.25F));
  EXPECT_EQ(image.at(1, 0), Rgb(1024, 512, 256));
  EXPECT_EQ(image.at(0, 1), Rgb(2, 2, 2));
  EXPECT_EQ(image.at(1, 1), Rgb(0, 0, 0));
}

TEST(ImageRead, RadianceHdrInRuns) {
  const TemporaryFolder folder;
  // A row of nine: each channel by itself, red as 3 different and 6 alike.
  const test::Bytes by_channel{2, 2, 0, 9, 3, 128, 64, 32, 134, 16, 137, 128, 137, 0, 137, 129};
  FloatImage image = read_float_image(write_hdr(folder, "-Y 1 +X 9", by_channel));
  for (int x = 0; x < 9; ++x) {
    EXPECT_EQ(image.at(x, 0), Rgb(x == 0 ? 1 : x == 1 ? 0.5F : x == 2 ? 0.25F : 0.125F, 1, 0)) << x;
  }
  // The old form: a pixel, itself twice again, then 256 times more.
  const test::Bytes old{128, 128, 128, 129, 1, 1, 1, 2, 1, 1, 1, 1};
  image = read_float_image(write_hdr(folder, "-Y 1 +X 259", old));
  for (int x = 0; x < 259; ++x) EXPECT_EQ(image.at(x, 0), Rgb(1, 1, 1)) << x;
  for (std::size_t n = 0; n < by_channel.size(); ++n) {
    const test::Bytes cut(by_channel.begin(), by_channel.begin() + static_cast<std::ptrdiff_t>(n));
    expect_contains(image_refusal(write_hdr(folder, "-Y 1 +X 9", cut)), "it ends early");
  }
  expect_contains(image_refusal(write_hdr(folder, "-Y 1 +X 8", {2, 2, 0, 8, 137})),
                  "beyond its row");
  expect_contains(image_refusal(write_hdr(folder, "-Y 1 +X 8", {2, 2, 0, 9, 137})),
                  "another length");
  expect_contains(image_refusal(write_hdr(folder, "-Y 1 +X 2", {1, 1, 1, 2})), "beyond its row");
}

TEST(ImageRead, RadianceHdrOfOtherKindsIsRefused) {
  const TemporaryFolder folder;
  for (const char* size : {"+Y 2 +X 2", "-Y 2 +X 2 ", "-Y 2", "", "-Y 2 +X 99999999"}) {
    expect_contains(image_refusal(write_hdr(folder, size, {})), "-Y HEIGHT +X WIDTH");
  }
  for (const char* size : {"-Y 0 +X 2", "-Y 2 +X 40000", "-Y 2 +X -3"}) {
    expect_contains(image_refusal(write_hdr(folder, size, {})), "up to 32768 a side");
  }
  for (const auto& [line, allowed] :
       {std::pair("FORMAT=32-bit_rle_xyze", "FORMAT=32-bit_rle_rgbe"),
        {"EXPOSURE=0", "above 0"},
        {"EXPOSURE=-1", "above 0"},
        {"EXPOSURE=abc", "a number above 0"},
        {"EXPOSURE=1 2", "a number above 0"},
        {"EXPOSURE=1e999", "a number above 0"},
        {"COLORCORR=1 2", "three numbers above 0"},
        {"COLORCORR=1 0 1", "above 0"},
        {"GAMMA=2.2", "1: linear values"},
        {"PRIMARIES=.64 .33", "eight coordinates"},
        {"PRIMARIES=.7347 .2653 0 1 .0001 -.077 .32168 .33767",
         "0.64 0.33 0.29 0.6 0.15 0.06 0.3333 0.3333, or 0.64 0.33 0.3 0.6 0.15 0.06 0.3127"}}) {
    const std::string message = image_refusal(write_white(folder, std::string(line) + "\n"));
    expect_contains(message,
                    "white.hdr: has \"" + std::string(line) + "\" in its header; allowed: ");
    expect_contains(message, allowed);
  }
  expect_contains(image_refusal(write_white(folder, "EXPOSURE=1e-300\nEXPOSURE=1e-300\n")),
                  "a product within double precision");
}

// Stored values are the light times all EXPOSURE and COLORCORR lines (Radiance file formats).
TEST(ImageRead, RadianceHdrIsDividedByWhatItsHeaderMultiplied) {
  const TemporaryFolder folder;
  const auto white = [&](const std::string& lines) {
    return read_float_image(write_white(folder, lines)).at(0, 0);
  };
  EXPECT_EQ(white(""), Rgb(1)) << "no FORMAT is the usual one";
  EXPECT_EQ(white("EXPOSURE=0.5\nFORMAT=32-bit_rle_rgbe\nEXPOSURE= 8\n"), Rgb(0.25F));
  EXPECT_EQ(white("COLORCORR=0.5 2 4\nCOLORCORR= 1 1 2\nEXPOSURE=1e1\n"),
            Rgb(0.2F, 0.05F, 0.0125F));
  EXPECT_EQ(white("\tEXPOSURE=2\n# EXPOSURE=2\nVIEW= -vtv\n"), Rgb(1)) << "of other pictures";
  EXPECT_EQ(white("GAMMA=1\nPRIMARIES=0 0 0 0 0 0 0 0\n"), Rgb(1)) << "as Photoshop writes it";
  EXPECT_EQ(white("PRIMARIES=.640 .330 .290 .600 .150 .060 .333 .333\n"), Rgb(1));
  EXPECT_EQ(white("PRIMARIES=.64 .33 .3 .6 .15 .06 .3127 .329\n"), Rgb(1));
  EXPECT_EQ(white("EXPOSURE=2\r\nFORMAT=32-bit_rle_rgbe\r\n\r"), Rgb(0.5F)) << "CRLF";
}

TEST(ImageRead, OtherFilesAreRefused) {
  const TemporaryFolder folder;
  expect_contains(image_refusal(folder.write("image.exr", test::encode8(1, 1, 3, {1, 2, 3}))),
                  "image.exr: is neither OpenEXR nor Radiance HDR");
  expect_contains(image_refusal(folder.write("empty.exr", std::string())), "is neither");
  expect_contains(image_refusal(folder.path() / "nothing.exr"), "nothing.exr");
  expect_contains(image_refusal(folder.path()), "is not a regular file");
  ASSERT_EQ(::mkfifo((folder.path() / "pipe.exr").c_str(), 0600), 0);
  expect_contains(image_refusal(folder.path() / "pipe.exr"), "is not a regular file");
}

TEST(ImageRead, TruncatedFilesAreRefused) {
  const TemporaryFolder folder;
  std::vector<float> pixels(64 * 64 * 3);
  for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i] = static_cast<float>(i * 7919 % 1000);
  const auto bytes = test::read_bytes(write_channels(folder, {"R", "G", "B"}, pixels, 64, 64));
  for (const std::size_t length : {std::size_t{5}, std::size_t{200}, bytes.size() / 2}) {
    const test::Bytes part(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(length));
    expect_contains(image_refusal(folder.write("part.exr", part)), "part.exr: ");
  }
}

TEST(ImageRead, CropsAreRefused) {
  const TemporaryFolder folder;
  const auto file =
      test::write_exr_file(folder, "crop.exr", {"R", "G", "B"}, std::vector<float>(12, 1.0F), 2, 2,
                           {.display_width = 4, .display_height = 2});
  expect_contains(image_refusal(file), "is a crop");
}

TEST(ImageRead, RadianceMustBeFiniteAndNotNegative) {
  FloatImage image{3, 2, std::vector<float>(18, 1.0F), {}};
  EXPECT_NO_THROW(require_radiance(image, "sky"));
  for (const float bad :
       {-1.0F, std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()}) {
    image.rgb[3 * (1 * 3 + 2) + 1] = bad;
    try {
      require_radiance(image, "sky");
      FAIL() << bad;
    } catch (const SceneError& e) {
      expect_contains(e.what(), "sky: pixel (2, 1) channel G is ");
      expect_contains(e.what(), ", the first of 1 such values of 18; allowed: finite, at least 0");
    }
  }
}

TEST(ImageRead, WhatIsNotFiniteIsCounted) {
  FloatImage image{2, 2, std::vector<float>(12, -1.0F), {}};
  EXPECT_NO_THROW(require_finite(image, "a"));
  image.rgb[4] = std::numeric_limits<float>::quiet_NaN();
  image.rgb[6] = -std::numeric_limits<float>::infinity();
  expect_contains(
      test::refusal_of([&] { require_finite(image, "a"); }),
      "a: pixel (1, 0) channel G is nan, the first of 2 such values of 12; allowed: finite");
}

/// The first attribute of an EXR with another size, and what reading it says.
std::string refusal_of_attribute_size(std::uint32_t size) {
  const TemporaryFolder folder;
  test::Bytes bytes = test::read_bytes(write_channels(folder, {"R", "G", "B"}, {1, 2, 3}, 1, 1));
  std::size_t at = 8;
  for (int text = 0; text < 2; ++at) text += bytes[at] == 0 ? 1 : 0;  // its name, its type
  std::memcpy(bytes.data() + at, &size, sizeof size);
  return image_refusal(folder.write("lies.exr", bytes));
}

TEST(ImageRead, AnAttributeLargerThanItsFileIsRefused) {
  // The library would make room for it first.
  for (const std::uint32_t size : {1700000000U, 0x7fffffffU, 0xffffffffU}) {
    const std::string message = refusal_of_attribute_size(size);
    expect_contains(message, "lies.exr: OpenEXR header: attribute");
    expect_contains(message, std::to_string(size) + " bytes");
  }
}

TEST(ImageRead, AChannelOfAnUnknownTypeIsRefused) {
  // The library would end the process.
  const TemporaryFolder folder;
  test::Bytes bytes = test::read_bytes(write_channels(folder, {"R", "G", "B"}, {1, 2, 3}, 1, 1));
  const std::string list("chlist\0\x37\0\0\0B\0", 13);
  const auto found = std::search(bytes.begin(), bytes.end(), list.begin(), list.end());
  ASSERT_NE(found, bytes.end());
  found[13] = 3;
  expect_contains(image_refusal(folder.write("type.exr", bytes)),
                  "channel \"B\" has pixel type 3; allowed: 0 to 2");
}

TEST(ImageRead, AHeaderThatEndsEarlyIsRefused) {
  const TemporaryFolder folder;
  const auto bytes = test::read_bytes(write_channels(folder, {"R", "G", "B"}, {1, 2, 3}, 1, 1));
  for (std::size_t n = 4; n < 100; ++n) {
    const test::Bytes cut(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(n));
    expect_contains(image_refusal(folder.write("cut.exr", cut)), "cut.exr: OpenEXR header: ");
  }
}

TEST(ImageRead, AnExrThatSaysTooMuchIsRefused) {
  const TemporaryFolder folder;
  const std::vector<float> one{1, 2, 3};
  const auto refusal = [&](int width, int height, const test::ExrKind& kind) {
    const auto file = test::write_exr_file(folder, "a.exr", {"R", "G", "B"}, one, 1, 1, kind);
    test::Bytes bytes = test::read_bytes(file);
    const std::string name("dataWindow\0box2i\0\x10\0\0\0", 21);
    const auto at = std::search(bytes.begin(), bytes.end(), name.begin(), name.end()) + 21;
    const test::Bytes window = test::box(width, height);
    std::copy(window.begin(), window.end(), at);
    return image_refusal(folder.write("a.exr", bytes));
  };
  expect_contains(refusal(40000, 1, {}), "a.exr: is 40000 x 1 pixels; allowed: up to 32768 a side");
  expect_contains(refusal(1, 0, {}), "a.exr: is 1 x 0 pixels");
  const std::string tiles("\1\0\0\0\1\0\0\0\0", 9);
  expect_contains(
      refusal(32768, 32768, {.flags = 0x200, .attributes = {{{"tiles", "tiledesc", tiles}}}}),
      "a.exr: is corrupt: it states 1073741824 tiles");
  expect_contains(refusal(1, 1, {.flags = 0x800}), "a.exr: is a deep image; allowed: flat images");
  expect_contains(refusal(1, 1, {.attributes = {{{"type", "string", "deepscanline"}}}}),
                  "a deep image");
  expect_contains(refusal(2, 2, {.sampling = 2}),
                  "has channel \"B\" at less than full resolution, as luminance and chroma have");
  expect_contains(
      refusal(1, 1, {.attributes = {{{"Orientation", "int", std::string("\3\0\0\0", 4)}}}}),
      "is stored rotated or mirrored");
}

TEST(ImageRead, TheMagicDecidesAndNotTheName) {
  const TemporaryFolder folder;
  const auto exr = write_channels(folder, {"R", "G", "B"}, {1, 2, 3}, 1, 1);
  EXPECT_EQ(read_float_image(folder.write("sky.hdr", test::read_bytes(exr))).at(0, 0),
            Rgb(1, 2, 3));
  for (const std::string text : {"GIF89a", "8BPS", "RIFF    WEBP", "DDS ", "II*", "BM"}) {
    expect_contains(image_refusal(folder.write("video.exr", text)),
                    "video.exr: is neither OpenEXR nor Radiance HDR");
  }
}

TEST(ImageRead, NumbersThatAreNoneComeThrough) {
  const TemporaryFolder folder;
  constexpr float inf = std::numeric_limits<float>::infinity();
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  const FloatImage image = read_float_image(
      write_channels(folder, {"R", "G", "B"}, {nan, inf, -inf, 1, -2, 1e-42F}, 2, 1));
  EXPECT_TRUE(std::isnan(image.rgb[0]));
  EXPECT_EQ(image.rgb[1], inf);
  EXPECT_EQ(image.rgb[2], -inf);
  EXPECT_EQ(image.rgb[5], 1e-42F);
}

TEST(ImageRead, IntegersAreTheirValues) {
  const FloatImage image = read_float_image(std::filesystem::path(LACUNA_SOURCE_DIR) /
                                            "tests/fuzz/corpus/float_image/uint.exr");
  // oiiotool wrote 2^32 - 1 for 1 and more.
  EXPECT_EQ(image.at(6, 0).x, 4294967296.0F);
}

std::string tiff_refusal(const TemporaryFolder& folder, const test::Bytes& bytes) {
  return test::refusal_of([&] { read_reference_image(folder.write("a.tif", bytes)); });
}

TEST(ImageRead, TiffOfFloatsIsAReference) {
  const TemporaryFolder folder;
  const std::vector<float> pixels{1, 2, 3, 4e30F, -5, 6};
  const auto file = folder.write("a.tif", test::make_tiff(2, 1, 3, pixels));
  EXPECT_EQ(read_reference_image(file).rgb, pixels);
  expect_contains(image_refusal(file), "a.tif: is neither OpenEXR nor Radiance HDR");
  // Colours stay as they are beside an alpha that is not multiplied in.
  const test::Bytes alpha = test::make_tiff(1, 1, 4, {1, 2, 3, 0.5F}, {{338, {2}}});
  EXPECT_EQ(read_reference_image(folder.write("b.tif", alpha)).at(0, 0), Rgb(1, 2, 3));
  const test::Bytes grey = test::make_tiff(1, 2, 1, {7, 8});
  EXPECT_EQ(read_reference_image(folder.write("c.tif", grey)).at(0, 1), Rgb(8));
  for (const char* name : {"float.tif", "zip.tif", "planes.tif", "tiled.tif"}) {
    const FloatImage image = read_reference_image(std::filesystem::path(LACUNA_SOURCE_DIR) /
                                                  "tests/fuzz/corpus/float_image" / name);
    EXPECT_NEAR(image.at(0, 0).x, 0.1F, 1e-6F) << name;
    EXPECT_NEAR(image.at(0, 0).z, 0.3F, 1e-6F) << name;
  }
}

TEST(ImageRead, OtherTiffsAreRefused) {
  const TemporaryFolder folder;
  const auto refusal = [&](const std::vector<test::TiffEntry>& more) {
    return tiff_refusal(folder, test::make_tiff(2, 1, 3, {1, 2, 3, 4, 5, 6}, more));
  };
  expect_contains(refusal({{258, {8, 8, 8}}, {339, {1, 1, 1}}}),
                  "a.tif: has 8-bit integers; allowed");
  expect_contains(refusal({{258, {64, 64, 64}}}), "has 64-bit floats; allowed");
  expect_contains(refusal({{259, {7}}}), "has compression 7; allowed: 1 (none)");
  expect_contains(refusal({{262, {6}}}), "has photometric interpretation 6; allowed");
  expect_contains(refusal({{256, {40000}}}), "is 40000 x 1 pixels; allowed: up to 32768 a side");
  expect_contains(refusal({{257, {0}}}), "is 2 x 0 pixels");
  expect_contains(refusal({{277, {5}}}), "has 5 channels; allowed: 1, 3, 4");
  expect_contains(refusal({{278, {0}}}), "is corrupt: its blocks are");
  expect_contains(refusal({{273, {8, 8}}}), "is corrupt: it has 2 blocks, its size requires 1");
  expect_contains(refusal({{273, {4000}}}), "is corrupt: it ends early");
  expect_contains(refusal({{256, {2000}}}), "is corrupt: 24 bytes cannot hold its 2000 x 1 pixels");
  expect_contains(refusal({{256, {30000}}, {257, {30000}}, {259, {5}}, {278, {30000}}}),
                  "cannot hold");
  expect_contains(refusal({{274, {3}}}), "is stored rotated or mirrored");
  const test::Bytes whole = test::make_tiff(2, 1, 3, {1, 2, 3, 4, 5, 6});
  for (std::size_t n = 4; n < whole.size(); ++n) {
    const test::Bytes part(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(n));
    expect_contains(tiff_refusal(folder, part), "a.tif: is corrupt: it ends early");
  }
}

}  // namespace
}  // namespace lacuna
