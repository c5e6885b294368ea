#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>

#include "renderer/core/scene_error.h"
#include "renderer/images/image_read.h"
#include "tests/temporary_folder.h"

namespace lacuna {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes pfm(const std::string& header, const std::vector<float>& values, bool big_endian = false) {
  Bytes out(header.begin(), header.end());
  for (const float v : values) {
    auto b = std::bit_cast<std::array<std::uint8_t, 4>>(v);
    if (big_endian) std::reverse(b.begin(), b.end());
    out.insert(out.end(), b.begin(), b.end());
  }
  return out;
}

TEST(PfmRead, EitherByteOrderAndGrey) {
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

TEST(PfmRead, IsAFloatImage) {
  const TemporaryFolder folder;
  const auto file = folder.write("a.exr", pfm("PF\n1 1\n-1\n", {1, 2, 3}));  // by its magic bytes
  EXPECT_EQ(read_float_image(file).at(0, 0), Rgb(1, 2, 3));
  EXPECT_EQ(read_float_image(file).file.bytes, 22u);
  EXPECT_THROW(read_float_image(file, "half_a"), SceneError);
}

}  // namespace
}  // namespace lacuna
