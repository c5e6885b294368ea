#include "jobs/import/tga_picture.h"

#include <gtest/gtest.h>

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

TEST(TgaPicture, TgaOfColours) {
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

TEST(TgaPicture, TgaOfRuns) {
  // Three of one colour, then two of their own.
  const Bytes packets{0x82, 3, 2, 1, 0x01, 6, 5, 4, 9, 8, 7};
  EXPECT_EQ(read_tga(tga(10, 5, 1, 24, 0, packets), "a.tga").codes,
            (Bytes{1, 2, 3, 1, 2, 3, 1, 2, 3, 4, 5, 6, 7, 8, 9}));
  EXPECT_THROW(read_tga(tga(10, 6, 1, 24, 0, packets), "a.tga"), SceneError);
}

TEST(TgaPicture, DamagedTga) {
  const auto error = [](const Bytes& bytes) {
    try {
      read_tga(bytes, "a.tga");
    } catch (const SceneError& e) {
      return std::string(e.what());
    }
    return std::string("no error");
  };
  EXPECT_EQ(error({}), "a.tga: is corrupt: it ends early");
  EXPECT_EQ(error(tga(2, 2, 2, 24, 0, Bytes(11))), "a.tga: is corrupt: it ends early");
  EXPECT_EQ(error(tga(10, 255, 255, 24, 0, Bytes(40))), "a.tga: is corrupt: it ends early");
  EXPECT_NE(error(tga(1, 2, 2, 8, 0, Bytes(4))).find("TGA of kind 1"), std::string::npos);
  EXPECT_NE(error(tga(2, 2, 2, 16, 0, Bytes(8))).find("with 16 bits"), std::string::npos);
  EXPECT_NE(error(tga(2, 0, 2, 24, 0, {})).find("0 x 2 pixels"), std::string::npos);
}

TEST(TgaPicture, IsATextureOfAnImport) {
  const TemporaryFolder folder;
  ImportedTexture t;
  t.file = folder.write("a.TGA", tga(2, 1, 1, 24, 0, {0, 128, 255}));
  const LinearPicture p = linear_picture(t);
  EXPECT_NEAR(p.at(0, 0).x, 1, 1e-3);
  EXPECT_NEAR(p.at(0, 0).y, .2159, 1e-3);  // sRGB's 128
}

}  // namespace
}  // namespace lacuna
