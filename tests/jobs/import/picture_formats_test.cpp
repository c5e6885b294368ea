#include "jobs/import/picture_formats.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>

#include "jobs/import/linear_picture.h"
#include "renderer/core/scene_error.h"
#include "tests/temporary_folder.h"

namespace lacuna {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes tga(std::uint8_t kind, std::uint8_t width, std::uint8_t height, std::uint8_t depth,
          std::uint8_t flags, const Bytes& pixels) {
  Bytes out{2, 0, kind, 0, 0, 0, 0, 0, 0, 0, 0, 0, width, 0, height, 0, depth, flags, 'i', 'd'};
  out.insert(out.end(), pixels.begin(), pixels.end());
  return out;
}

TEST(PictureFormats, TgaOfColours) {
  // Blue, green, red; from the lower left unless the flags say otherwise.
  const Bytes pixels{3, 2, 1, 6, 5, 4, 9, 8, 7, 12, 11, 10};
  const CodePicture p = read_tga(tga(2, 2, 2, 24, 0, pixels), "a.tga");
  EXPECT_EQ(p.channels, 3);
  EXPECT_EQ(p.codes, (Bytes{7, 8, 9, 10, 11, 12, 1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(read_tga(tga(2, 2, 2, 24, 0x20, pixels), "a.tga").codes,
            (Bytes{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}));
  EXPECT_EQ(read_tga(tga(2, 2, 2, 24, 0x30, pixels), "a.tga").codes,
            (Bytes{4, 5, 6, 1, 2, 3, 10, 11, 12, 7, 8, 9}));
  const CodePicture a = read_tga(tga(2, 1, 1, 32, 0, {3, 2, 1, 99}), "a.tga");
  EXPECT_EQ(a.channels, 4);
  EXPECT_EQ(a.codes, (Bytes{1, 2, 3, 99}));
  EXPECT_EQ(read_tga(tga(3, 2, 1, 8, 0, {5, 6}), "a.tga").codes, (Bytes{5, 5, 5, 6, 6, 6}));
}

TEST(PictureFormats, TgaOfRuns) {
  // Three of one colour, then two of their own.
  const Bytes packets{0x82, 3, 2, 1, 0x01, 6, 5, 4, 9, 8, 7};
  EXPECT_EQ(read_tga(tga(10, 5, 1, 24, 0, packets), "a.tga").codes,
            (Bytes{1, 2, 3, 1, 2, 3, 1, 2, 3, 4, 5, 6, 7, 8, 9}));
  EXPECT_THROW(read_tga(tga(10, 6, 1, 24, 0, packets), "a.tga"), SceneError);
}

TEST(PictureFormats, DamagedTga) {
  const auto error = [](const Bytes& bytes) {
    try {
      read_tga(bytes, "a.tga");
    } catch (const SceneError& e) {
      return std::string(e.what());
    }
    return std::string("no error");
  };
  EXPECT_EQ(error({}), "a.tga: the file ends early");
  EXPECT_EQ(error(tga(2, 2, 2, 24, 0, Bytes(11))), "a.tga: the file ends early");
  EXPECT_EQ(error(tga(10, 255, 255, 24, 0, Bytes(40))), "a.tga: the file ends early");
  EXPECT_NE(error(tga(1, 2, 2, 8, 0, Bytes(4))).find("TGA of kind 1"), std::string::npos);
  EXPECT_NE(error(tga(2, 2, 2, 16, 0, Bytes(8))).find("with 16 bits"), std::string::npos);
  EXPECT_NE(error(tga(2, 0, 2, 24, 0, {})).find("0 x 2 pixels"), std::string::npos);
}

Bytes pfm(const std::string& header, const std::vector<float>& values, bool big_endian = false) {
  Bytes out(header.begin(), header.end());
  for (const float v : values) {
    auto b = std::bit_cast<std::array<std::uint8_t, 4>>(v);
    if (big_endian) std::reverse(b.begin(), b.end());
    out.insert(out.end(), b.begin(), b.end());
  }
  return out;
}

TEST(PictureFormats, Pfm) {
  const std::vector<float> values{1, 2, 3, 4, 5, 6};  // bottom row first
  const FloatImage p = read_pfm(pfm("PF\n1 2\n-1.0\n", values), "a.pfm");
  EXPECT_EQ(p.at(0, 0), Rgb(4, 5, 6));
  EXPECT_EQ(p.at(0, 1), Rgb(1, 2, 3));
  EXPECT_EQ(read_pfm(pfm("PF\n1 2\n2\n", values, true), "a.pfm").at(0, 1), Rgb(2, 4, 6));
  EXPECT_EQ(read_pfm(pfm("Pf\n3 2\n-1\n", values), "a.pfm").at(2, 0), Rgb(6, 6, 6));
  for (const char* header : {"P6\n1 2\n-1\n", "PF\n1 3\n-1\n", "PF\n0 2\n-1\n", "PF\n1 x\n-1\n",
                             "PF\n1 2\n0\n", "PF\n99999 99999\n-1\n", "PF"}) {
    EXPECT_THROW(read_pfm(pfm(header, values), "a.pfm"), SceneError) << header;
  }
}

TEST(PictureFormats, AreTexturesOfAnImport) {
  const TemporaryFolder folder;
  ImportedTexture t;
  t.file = folder.write("a.TGA", tga(2, 1, 1, 24, 0, {0, 128, 255}));
  LinearPicture p = linear_picture(t);
  EXPECT_NEAR(p.at(0, 0).x, 1, 1e-3);
  EXPECT_NEAR(p.at(0, 0).y, .2159, 1e-3);  // sRGB's 128
  t.file = folder.write("a.pfm", pfm("PF\n1 1\n-1\n", {1, 2, 3}));
  p = linear_picture(t);
  EXPECT_EQ(p.at(0, 0), Rgb(1, 2, 3));
}

}  // namespace
}  // namespace lacuna
