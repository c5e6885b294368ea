#include <gtest/gtest.h>
#include <sys/stat.h>

#include "renderer/geometry/scene_data.h"
#include "renderer/gltf/gltf_load.h"
#include "tests/renderer/gltf/glb_builder.h"
#include "tests/renderer/images/test_images.h"

namespace lacuna {
namespace {

using test::Bytes;
using test::GlbBuilder;

std::string refusal(const std::filesystem::path& file) {
  try {
    load_gltf(file);
  } catch (const SceneError& e) {
    return e.what();
  }
  return "accepted";
}

void expect_refusal(const std::filesystem::path& file, const std::vector<std::string>& parts) {
  const std::string message = refusal(file);
  for (const auto& part : parts) {
    EXPECT_NE(message.find(part), std::string::npos) << message;
  }
}

/// A scene in a folder of its own below `folder`, with its buffer under `uri`.
std::filesystem::path scene_with_buffer(const TemporaryFolder& folder, const std::string& uri) {
  std::filesystem::create_directory(folder.path() / "scene");
  return folder.write("scene/scene.gltf", test::triangle_scene().gltf(uri));
}

TEST(HostileFiles, ABufferInTheFolderIsRead) {
  const TemporaryFolder folder;
  const auto file = scene_with_buffer(folder, "with%20space.bin");
  folder.write("scene/with space.bin", test::triangle_scene().bin);
  EXPECT_EQ(load_gltf(file).triangle_count(), 1U);
}

TEST(HostileFiles, ALongerBufferIsLegalAShorterOneNot) {
  const TemporaryFolder folder;
  const auto file = scene_with_buffer(folder, "a.bin");
  Bytes bin = test::triangle_scene().bin;
  bin.push_back(0);
  folder.write("scene/a.bin", bin);
  EXPECT_EQ(load_gltf(file).triangle_count(), 1U);
  bin.resize(bin.size() - 2);
  folder.write("scene/a.bin", bin);
  expect_refusal(file, {"buffers[0]", "\"a.bin\" has 47 bytes; byteLength is 48"});
}

TEST(HostileFiles, ADataUriIsRead) {
  const TemporaryFolder folder;
  GlbBuilder builder = test::triangle_scene();
  builder.json["accessors"].erase(1);
  builder.json["bufferViews"].erase(1);
  builder.json["meshes"][0]["primitives"][0].erase("indices");
  builder.json["buffers"] = {{{"byteLength", 36},
                              {"uri",
                               "data:application/octet-stream;base64,"
                               "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}}};
  const SceneData scene = load_gltf(folder.write("scene.gltf", builder.gltf("")));
  ASSERT_EQ(scene.meshes.size(), 1U);
  EXPECT_EQ(scene.meshes[0].positions[1], V3f(1, 0, 0));
  builder.json["buffers"][0]["uri"] = "data:application/x-evil;base64,AAAA";
  expect_refusal(folder.write("scene.gltf", builder.gltf("")),
                 {"buffers[0]", "application/x-evil"});
}

TEST(HostileFiles, PathsOutOfTheFolderAreRefused) {
  const TemporaryFolder folder;
  folder.write("outside.bin", test::triangle_scene().bin);
  for (const std::string uri :
       {"../../etc/hostname", "../outside.bin", "sub/../../outside.bin", "/etc/hostname",
        "%2e%2e/outside.bin", "..%2Foutside.bin", "file:///etc/hostname", "C:outside.bin"}) {
    expect_refusal(scene_with_buffer(folder, uri),
                   {"buffers[0]", uri, "inside the scene's folder"});
  }
  expect_refusal(scene_with_buffer(folder, std::string(100000, 'a')),
                 {"buffers[0]", "a path of 100000 bytes; allowed: 4096"});
  expect_refusal(scene_with_buffer(folder, "a%00.bin"), {"buffers[0]", "broken escape"});
  expect_refusal(scene_with_buffer(folder, "missing.bin"),
                 {"buffers[0]", "missing.bin", "No such file"});
}

TEST(HostileFiles, SymbolicLinks) {
  const TemporaryFolder folder;
  folder.write("outside.bin", test::triangle_scene().bin);
  const auto file = scene_with_buffer(folder, "link.bin");
  std::filesystem::create_symlink("../outside.bin", folder.path() / "scene/link.bin");
  expect_refusal(file, {"buffers[0]", "link.bin", "leaves the scene's folder by a symbolic link"});
  std::filesystem::remove(folder.path() / "scene/link.bin");
  folder.write("scene/inside.bin", test::triangle_scene().bin);
  std::filesystem::create_symlink("inside.bin", folder.path() / "scene/link.bin");
  EXPECT_EQ(load_gltf(file).triangle_count(), 1U);
}

TEST(HostileFiles, FifosAndFoldersNeverHang) {
  const TemporaryFolder folder;
  const auto file = scene_with_buffer(folder, "pipe.bin");
  ASSERT_EQ(::mkfifo((folder.path() / "scene/pipe.bin").c_str(), 0600), 0);
  expect_refusal(file, {"buffers[0]", "pipe.bin", "not a regular file"});
  ASSERT_EQ(::mkfifo((folder.path() / "scene.glb").c_str(), 0600), 0);
  expect_refusal(folder.path() / "scene.glb", {"scene.glb", "not a regular file"});
  expect_refusal(scene_with_buffer(folder, "."), {"buffers[0]", "not a regular file"});
  expect_refusal(folder.path() / "nothing.glb", {"nothing.glb", "No such file"});
  expect_refusal(folder.path() / "no/such/folder.glb", {"folder cannot be opened"});
}

GlbBuilder textured_scene(const Bytes& image) {
  GlbBuilder builder;
  const auto texture = builder.add_texture(image);
  const auto material = builder.add_material(
      {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", texture}}}}}});
  builder.add_node(
      {{"mesh", builder.add_quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, static_cast<int>(material))}});
  return builder;
}

TEST(HostileFiles, AMissingImageIsNamedAtLoad) {
  const TemporaryFolder folder;
  GlbBuilder builder = textured_scene({1, 2, 3, 4});
  builder.json["images"][0] = {{"uri", "wood.png"}, {"name", "wood"}};
  const auto file = folder.write("scene.glb", builder.glb());
  expect_refusal(file, {"images[0] \"wood\"", "wood.png", "No such file"});
  folder.write("wood.png", test::encode8(1, 1, 3, {255, 0, 0}));
  SceneData scene = load_gltf(file);
  ASSERT_EQ(scene.textures.size(), 1U);
  scene.textures[0]->decode();
  EXPECT_EQ(scene.textures[0]->lookup({0, 0}).rgb, Rgb(1, 0, 0));
}

TEST(HostileFiles, AnImageThatNobodyUsesIsNotOpened) {
  const TemporaryFolder folder;
  GlbBuilder builder = textured_scene({1, 2, 3, 4});
  builder.json["images"][0] = {{"uri", "wood.png"}};
  builder.json["materials"][0] = Json::object();
  EXPECT_TRUE(load_gltf(folder.write("scene.glb", builder.glb())).textures.empty());
}

TEST(HostileFiles, ImagesThatCannotBeDecodedAreNamed) {
  const TemporaryFolder folder;
  const std::vector<std::uint8_t> noise = [] {
    std::vector<std::uint8_t> out(64 * 64 * 3);
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = static_cast<std::uint8_t>(i * i >> 3);
    return out;
  }();
  const Bytes png = test::encode8(64, 64, 3, noise);
  const Bytes jpeg = test::jpeg_seed("rgb_large.jpg");
  Bytes flipped = png;
  flipped[png.size() / 2] ^= 0xFF;
  Bytes huge = png;  // width 2^24 in IHDR
  huge[16] = 1;
  const std::vector<std::pair<Bytes, std::string>> images{
      {Bytes{'B', 'M', 0, 0}, "neither a PNG nor a JPEG, WebP or TIFF"},
      {Bytes(png.begin(), png.begin() + 8), ""},
      {Bytes(png.begin(), png.begin() + static_cast<std::ptrdiff_t>(png.size() / 2)), ""},
      {flipped, ""},
      {huge, ""},
      {Bytes(jpeg.begin(), jpeg.begin() + 3), ""},
      {Bytes(jpeg.begin(), jpeg.begin() + static_cast<std::ptrdiff_t>(jpeg.size() / 2)), ""}};
  for (std::size_t i = 0; i < images.size(); ++i) {
    SCOPED_TRACE(i);
    SceneData scene = load_gltf(folder.write("scene.glb", textured_scene(images[i].first).glb()));
    ASSERT_EQ(scene.textures.size(), 1U);
    try {
      scene.textures[0]->decode();
      ADD_FAILURE() << "was decoded";
    } catch (const SceneError& e) {
      EXPECT_NE(std::string(e.what()).find("images[0]"), std::string::npos) << e.what();
      EXPECT_NE(std::string(e.what()).find(images[i].second), std::string::npos) << e.what();
    }
  }
}

TEST(HostileFiles, ContentHashCoversEveryFile) {
  const TemporaryFolder folder;
  const auto file = scene_with_buffer(folder, "a.bin");
  Bytes bin = test::triangle_scene().bin;
  folder.write("scene/a.bin", bin);
  const SceneData before = load_gltf(file);
  bin.push_back(1);  // behind byteLength: geometry is the same, content is not
  folder.write("scene/a.bin", bin);
  const SceneData after = load_gltf(file);
  EXPECT_NE(before.content_hash, after.content_hash);
  EXPECT_EQ(before.geometry_hash, after.geometry_hash);
}

}  // namespace
}  // namespace lacuna
