// What the textures of one scene may take together: bytes as they are in the file, and texels.

#include "renderer/gltf/gltf_materials.h"
#include "renderer/scene/scene.h"
#include "tests/renderer/gltf/glb_builder.h"
#include "tests/renderer/images/refusals.h"
#include "tests/renderer/images/test_images.h"

namespace lacuna {
namespace {

/// A triangle for each image, which is read as `ways` of colour, roughness and normals say.
test::GlbBuilder textured(const std::vector<test::Bytes>& images, int ways) {
  test::GlbBuilder builder;
  for (const test::Bytes& image : images) {
    const Json texture{{"index", builder.add_texture(image)}};
    Json material;
    material["pbrMetallicRoughness"]["baseColorTexture"] = texture;
    if (ways > 1) material["pbrMetallicRoughness"]["metallicRoughnessTexture"] = texture;
    const auto index = static_cast<int>(builder.add_material(material));
    const auto mesh = builder.add_quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, index);
    builder.add_node({{"mesh", mesh}});
  }
  return builder;
}

/// What the textures of a file are refused for where `most_bytes` are allowed.
std::string texture_refusal(const test::GlbBuilder& builder, std::uint64_t most_bytes) {
  const TemporaryFolder temp;
  SceneFolder folder(temp.write("scene.glb", builder.glb()));
  const Bytes bytes = folder.read_main();
  const gltf::Framing framing = gltf::check_framing(bytes);
  const Json json = gltf::parse_json(framing.json);
  gltf::Warnings warnings;
  gltf::GltfProblems problems(json, warnings);
  const gltf::GltfObject root(json, problems);
  gltf::TextureTable textures(root, warnings);
  gltf::read_materials(root, textures, warnings);
  Hasher content;
  const gltf::file::Model model = gltf::read_model(bytes, framing, json, root, folder, content);
  return test::refusal_of([&] { textures.build(model, folder, content, most_bytes); });
}

TEST(TextureLimits, EncodedBytesCountOnceForEachWayOfReading) {
  static_assert(max_encoded_bytes == 2'147'483'648);
  const test::Bytes image = test::encode8(2, 2, 3, std::vector<std::uint8_t>(12, 100));
  const std::uint64_t size = image.size();
  const auto two = textured({image, image}, 1), both_ways = textured({image}, 2);
  EXPECT_EQ(texture_refusal(two, 2 * size), "accepted");
  test::expect_contains(texture_refusal(two, 2 * size - 1),
                        "images[1]: is one too many: the textures have more than " +
                            std::to_string(2 * size - 1) + " bytes together");
  EXPECT_EQ(texture_refusal(both_ways, 2 * size), "accepted");
  test::expect_contains(texture_refusal(both_ways, 2 * size - 1), "images[0]: is one too many");
}

/// A PNG that says it has so many texels a side, in a few bytes.
test::Bytes large_png(std::uint32_t side) {
  test::Bytes png = test::encode8(1, 1, 3, {0, 0, 0});
  test::Bytes size;
  test::put_big(size, side, 4);
  test::put_big(size, side, 4);
  std::copy(size.begin(), size.end(), png.begin() + 16);  // in the header's chunk
  return png;
}

/// A JPEG likewise.
test::Bytes large_jpeg(std::uint16_t side) {
  test::Bytes jpeg = test::jpeg_seed("rgb.jpg");
  const test::Bytes frame{0xFF, 0xC0, 0, 17, 8};
  const auto at = std::search(jpeg.begin(), jpeg.end(), frame.begin(), frame.end());
  for (const int k : {5, 7}) {
    at[k] = static_cast<std::uint8_t>(side >> 8);
    at[k + 1] = static_cast<std::uint8_t>(side);
  }
  return jpeg;
}

// A file of a few kilobytes loads; memory for its texels is refused before any is taken.
TEST(TextureLimits, ManyTexelsInFewBytesAreRefusedBeforeTheyAreDecoded) {
  for (const test::Bytes& image : {large_png(16384), large_jpeg(16384)}) {
    const auto three = textured({image, image, image}, 1);
    ASSERT_LT(three.glb().size(), 10000U);
    SceneData data = test::load(three);
    const ThreadPool pool(1);
    test::expect_contains(
        test::refusal_of([&] { Scene(std::move(data), {.materials = true}, std::nullopt, pool); }),
        "805306368 texels together; allowed: up to 536870912");
  }
}

}  // namespace
}  // namespace lacuna
