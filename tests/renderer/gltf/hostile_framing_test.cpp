#include <gtest/gtest.h>

#include <functional>

#include "base/json/json_text.h"
#include "renderer/geometry/scene_data.h"
#include "renderer/gltf/gltf_guard.h"
#include "renderer/gltf/gltf_load.h"
#include "tests/renderer/gltf/glb_builder.h"

namespace lacuna {
namespace {

using test::Bytes;
using test::GlbBuilder;

struct FramingCase {
  std::string name;
  std::function<Bytes()> bytes;
  std::string message;  ///< must occur in the error
};

std::ostream& operator<<(std::ostream& out, const FramingCase& c) { return out << c.name; }

void put_u32(Bytes& bytes, std::size_t offset, std::uint32_t value) {
  std::memcpy(bytes.data() + offset, &value, sizeof value);
}

std::size_t bin_header(const Bytes& glb) {
  std::uint32_t json_bytes = 0;
  std::memcpy(&json_bytes, glb.data() + 12, sizeof json_bytes);
  return 20 + json_bytes;
}

Bytes patched(const std::function<void(Bytes&)>& patch) {
  Bytes glb = test::triangle_scene().glb();
  patch(glb);
  return glb;
}

std::string nested(std::size_t levels) {
  return R"({"asset": {"version": "2.0"}, "extras": )" + std::string(levels, '[') +
         std::string(levels, ']') + "}";
}

const std::vector<FramingCase> cases{
    {"Empty", [] { return Bytes{}; }, "JSON"},
    {"MagicOnly",
     [] {
       return Bytes{'g', 'l', 'T', 'F'};
     },
     "the file ends after 4 bytes"},
    {"NineteenBytes", [] { return patched([](Bytes& b) { b.resize(19); }); },
     "ends after 19 bytes"},
    {"OtherVersion", [] { return patched([](Bytes& b) { put_u32(b, 4, 1); }); },
     "version is 1; allowed: 2"},
    {"LengthTooLong", [] { return patched([](Bytes& b) { put_u32(b, 8, 0xFFFFFFFF); }); },
     "length is 4294967295"},
    {"LengthTooShort", [] { return patched([](Bytes& b) { put_u32(b, 8, 20); }); }, "length is 20"},
    {"JsonChunkLies", [] { return patched([](Bytes& b) { put_u32(b, 12, 0xFFFFFFF0); }); },
     "JSON chunk of 4294967280 bytes goes beyond"},
    {"JsonChunkLeavesHalfAHeader",
     [] {
       return patched([](Bytes& b) { put_u32(b, 12, static_cast<std::uint32_t>(b.size() - 24)); });
     },
     "second chunk has no complete header"},
    {"FirstChunkNotJson", [] { return patched([](Bytes& b) { put_u32(b, 16, 0x004E4942); }); },
     "first chunk is not JSON"},
    {"BinChunkLies",
     [] { return patched([](Bytes& b) { put_u32(b, bin_header(b), 0xFFFFFFFC); }); },
     "BIN chunk of 4294967292 bytes goes beyond"},
    {"SecondChunkNotBin",
     [] { return patched([](Bytes& b) { put_u32(b, bin_header(b) + 4, 0); }); },
     "second chunk is not BIN"},
    {"TruncatedBin",
     [] {
       return patched([](Bytes& b) {
         b.resize(b.size() - 8);
         put_u32(b, 8, static_cast<std::uint32_t>(b.size()));
       });
     },
     "BIN chunk"},
    {"ShorterBinThanBuffer",
     [] {
       const GlbBuilder builder = test::triangle_scene();
       GlbBuilder other = builder;
       other.json["buffers"] = {{{"byteLength", 48}}};
       other.bin.resize(40);
       return other.glb();
     },
     "buffers[0]: byteLength is 48; the BIN chunk has 40 bytes"},
    {"TenThousandLevels",
     [] {
       const std::string text = nested(10000);
       return Bytes(text.begin(), text.end());
     },
     "nested more than 64 levels deep"},
    {"TenThousandLevelsInGlb", [] { return GlbBuilder::frame(nested(10000), {}); },
     "nested more than 64 levels deep"},
    {"NotJson", [] { return GlbBuilder::frame("{\"asset\": ", {}); }, "JSON: "},
    {"RootIsAnArray", [] { return GlbBuilder::frame("[1, 2, 3]", {}); }, "allowed: an object"},
    {"NumberOverflows", [] { return GlbBuilder::frame(R"({"scene": 1e999})", {}); }, "JSON: "},
    {"BrokenUtf8", [] { return GlbBuilder::frame("{\"asset\": \"\xC3\x28\"}", {}); }, "JSON: "},
};

class HostileFraming : public testing::TestWithParam<FramingCase> {};

TEST_P(HostileFraming, IsRefused) {
  const TemporaryFolder folder;
  const auto file = folder.write("scene.glb", GetParam().bytes());
  try {
    load_gltf(file);
    FAIL() << "was accepted";
  } catch (const SceneError& e) {
    EXPECT_NE(std::string(e.what()).find(GetParam().message), std::string::npos) << e.what();
    EXPECT_NE(std::string(e.what()).find("scene.glb"), std::string::npos) << e.what();
  }
}

INSTANTIATE_TEST_SUITE_P(Table, HostileFraming, testing::ValuesIn(cases),
                         [](const auto& c) { return c.param.name; });

TEST(Framing, TheUnspoiltSceneLoads) {
  const TemporaryFolder folder;
  const SceneData scene = load_gltf(folder.write("scene.glb", test::triangle_scene().glb()));
  EXPECT_EQ(scene.triangle_count(), 1U);
  EXPECT_TRUE(scene.warnings.empty());
}

/// The last of two equal keys counts, for the guard and for tinygltf alike.
TEST(Framing, DuplicateKeysCannotSlipPastTheGuard) {
  const TemporaryFolder folder;
  const auto builder = test::triangle_scene();
  const auto with = [&](const std::string& counts) {
    GlbBuilder b = builder;
    b.json["accessors"][0]["count"] = "COUNTS";
    b.json["buffers"] = {{{"byteLength", b.bin.size()}}};
    std::string json = json_text(b.json);
    const std::string mark = "\"count\":\"COUNTS\"";
    json.replace(json.find(mark), mark.size(), counts);
    return folder.write("scene.glb", GlbBuilder::frame(json, b.bin));
  };
  EXPECT_EQ(load_gltf(with(R"("count":3000,"count":3)")).triangle_count(), 1U);
  EXPECT_THROW(load_gltf(with(R"("count":3,"count":3000)")), SceneError);
}

TEST(Framing, SixtyLevelsAreFine) {
  const TemporaryFolder folder;
  auto builder = test::triangle_scene();
  Json deep = 1;
  for (int i = 0; i < 60; ++i) deep = Json::array({deep});
  builder.json["extras"] = deep;
  EXPECT_EQ(load_gltf(folder.write("scene.glb", builder.glb())).triangle_count(), 1U);
}

/// A hang, were each looked at once for each that follows.
TEST(Framing, AMillionObjectsAreParsed) {
  std::string text = "[{}";
  for (int i = 1; i < 1'000'000; ++i) text += ",{}";
  text += "]";
  const auto json =
      gltf::parse_json(std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
  EXPECT_EQ(json.size(), 1'000'000U);
}

}  // namespace
}  // namespace lacuna
