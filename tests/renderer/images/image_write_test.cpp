#include <gtest/gtest.h>

#include "renderer/images/exr_write.h"
#include "renderer/images/image_read.h"
#include "renderer/images/png_write.h"
#include "renderer/images/texture_decode.h"
#include "tests/renderer/images/refusals.h"
#include "tests/renderer/images/test_images.h"

namespace lacuna {
namespace {

using test::Bytes;

/// The attributes of an EXR of one part: name, type and the bytes of the value.
std::vector<std::array<std::string, 3>> exr_attributes(const Bytes& file) {
  std::vector<std::array<std::string, 3>> attributes;
  std::size_t at = 8;
  const auto text = [&] {
    std::string value;
    while (file.at(at) != 0) value.push_back(static_cast<char>(file.at(at++)));
    ++at;
    return value;
  };
  while (file.at(at) != 0) {
    std::array<std::string, 3> attribute{text(), text(), ""};
    std::size_t size = 0;
    for (int i = 3; i >= 0; --i) size = size << 8 | file.at(at + static_cast<std::size_t>(i));
    at += 4;
    attribute[2].assign(file.begin() + static_cast<std::ptrdiff_t>(at),
                        file.begin() + static_cast<std::ptrdiff_t>(at + size));
    at += size;
    attributes.push_back(attribute);
  }
  return attributes;
}

TEST(ExrWrite, TheHeaderHoldsWhatItIsToldAndNothingElse) {
  const TemporaryFolder folder;
  const auto file = folder / "a.exr";
  const std::vector<ExrLayer> layers{{"", {"R", "G", "B"}, {1, 2, 3}}, {"depth", {"Z"}, {4}}};
  write_exr(file, {1,
                   1,
                   layers,
                   PixelType::half_float,
                   {{"seed", "18446744073709551615"}, {"job", "j-1"}, {"spec", "{\n}\n"}}});
  std::map<std::string, std::string> texts;
  std::set<std::string> others;
  for (const auto& [name, type, value] : exr_attributes(test::read_bytes(file))) {
    if (type == "string") {
      texts[name] = value;
    } else {
      others.insert(name);
    }
    if (name == "channels") {  // name, then type 1 (half), linearity, sampling 1 x 1
      const std::string half("\0\1\0\0\0\0\0\0\0\1\0\0\0\1\0\0\0", 17);
      std::string list;
      for (const char* channel : {"B", "G", "R", "depth.Z"}) list.append(channel).append(half);
      EXPECT_EQ(value, list.append(1, '\0'));
    }
    if (name == "compression") {
      EXPECT_EQ(value, "\3") << "ZIP, 16 lines";
    }
  }
  EXPECT_EQ(texts, (std::map<std::string, std::string>{{"Software", "lacuna"},
                                                       {"lacuna:job", "j-1"},
                                                       {"lacuna:seed", "18446744073709551615"},
                                                       {"lacuna:spec", "{\n}\n"}}));
  EXPECT_EQ(others, (std::set<std::string>{"channels", "compression", "dataWindow", "displayWindow",
                                           "lineOrder", "pixelAspectRatio", "screenWindowCenter",
                                           "screenWindowWidth"}));
}

TEST(ExrWrite, ManyLayersComeBackUnderTheirNames) {
  const TemporaryFolder folder;
  const auto file = folder / "a.exr";
  constexpr int count = 700;  // more channels than the library takes unless it is asked to
  std::vector<ExrLayer> layers{{"", {"R", "G", "B"}, {1, 2, 3}}};
  for (int i = 0; i < count; ++i) {
    layers.push_back({"strategies.s" + std::to_string(i), {"R", "G", "B"}, {1.0 * i, 2.0 * i, 0}});
  }
  write_exr(file, {1, 1, layers, PixelType::single_float, {}});
  for (const int i : {0, 1, 12, 699}) {
    const auto v = static_cast<float>(i);
    EXPECT_EQ(read_float_image(file, "strategies.s" + std::to_string(i)).at(0, 0),
              Rgb(v, 2 * v, 0));
  }
}

TEST(ExrWrite, HalfTellsWhatOverflows) {
  const TemporaryFolder folder;
  const auto write = [&](double v) {
    write_exr(folder / "a.exr",
              {1, 1, {{"", {"R", "G", "B"}, {1, v, 3}}}, PixelType::half_float, {}});
  };
  write(65504);
  try {
    write(-65505);
    FAIL();
  } catch (const std::runtime_error& e) {
    test::expect_contains(e.what(), "a.exr: a value of -65505 does not fit half precision");
  }
}

TEST(PngWrite, CodesComeBackAndEqualPicturesAreEqualFiles) {
  Bytes rgb(40 * 30 * 3);
  for (std::size_t i = 0; i < rgb.size(); ++i) rgb[i] = static_cast<std::uint8_t>(i * 7919 >> 4);
  const std::string png = encode_png(40, 30, rgb);
  EXPECT_EQ(png, encode_png(40, 30, rgb));
  for (const char* varies : {"tIME", "DateTime", "OpenImageIO"}) {
    EXPECT_EQ(png.find(varies), std::string::npos) << varies;
  }
  const Rgba8Image back = decode_texture(Bytes(png.begin(), png.end()), "back");
  ASSERT_EQ(back.rgba.size(), 40U * 30 * 4);
  for (std::size_t i = 0; i < rgb.size(); ++i) ASSERT_EQ(back.rgba[i / 3 * 4 + i % 3], rgb[i]) << i;
}

}  // namespace
}  // namespace lacuna
