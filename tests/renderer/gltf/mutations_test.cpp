#include <gtest/gtest.h>

#include <random>

#include "renderer/geometry/scene_data.h"
#include "renderer/gltf/gltf_load.h"
#include "tests/renderer/gltf/glb_builder.h"
#include "tests/renderer/gltf/scene_promises.h"
#include "tests/renderer/images/test_images.h"

namespace lacuna {
namespace {

using test::Bytes;
using test::GlbBuilder;

/// Small, but with every kind of thing that the loader reads.
Bytes seed_scene() {
  GlbBuilder b;
  const auto texture = b.add_texture(
      test::encode8(2, 2, 4, {255, 0, 0, 255, 0, 255, 0, 128, 0, 0, 255, 0, 9, 9, 9, 9}),
      {{"wrapS", 33071}, {"wrapT", 33648}});
  const auto material =
      b.add_material({{"name", "m"},
                      {"alphaMode", "MASK"},
                      {"pbrMetallicRoughness",
                       {{"baseColorTexture", {{"index", texture}}}, {"metallicFactor", 0.5}}},
                      {"emissiveFactor", {1, 0.5, 0}},
                      {"extensions",
                       {{"KHR_materials_emissive_strength", {{"emissiveStrength", 5}}},
                        {"KHR_materials_ior", {{"ior", 1.4}}}}}});
  const auto quad = b.add_quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, static_cast<int>(material));
  const auto mesh = b.add_mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}, -1,
                               {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}});
  const auto node = b.add_node({{"mesh", quad}, {"rotation", {0, 0, 0, 1}}, {"scale", {1, -2, 1}}});
  b.json["nodes"].push_back({{"mesh", mesh}, {"translation", {1, 2, 3}}});
  b.json["nodes"][node]["children"] = {1};
  b.add_camera("eye", {0, 0, 3}, 0.7);
  b.add_light({{"type", "spot"}, {"intensity", 3}, {"spot", {{"outerConeAngle", 0.5}}}});
  return b.glb();
}

Bytes mutate(Bytes glb, std::mt19937& rng) {
  const auto below = [&rng](std::size_t n) { return rng() % n; };
  const std::size_t edits = 1 + below(6);
  for (std::size_t e = 0; e < edits && !glb.empty(); ++e) {
    const std::size_t at = below(glb.size());
    switch (below(5)) {
      case 0:
        glb[at] ^= static_cast<std::uint8_t>(1U << below(8));
        break;
      case 1:
        glb[at] = static_cast<std::uint8_t>(rng());
        break;
      case 2:  // a digit where a digit may stand: keeps the JSON valid more often
        if (glb[at] >= '0' && glb[at] <= '9') glb[at] = static_cast<std::uint8_t>('0' + below(10));
        break;
      case 3: {  // copy a stretch over another
        const std::size_t from = below(glb.size());
        const std::size_t length =
            std::min<std::size_t>(below(24), glb.size() - std::max(at, from));
        std::memmove(glb.data() + at, glb.data() + from, length);
        break;
      }
      default:
        if (below(4) == 0) glb.resize(at);
        break;
    }
  }
  return glb;
}

/// Either a scene that keeps every promise of SceneData, or a SceneError; anything else (another
/// exception, a crash, a sanitizer's report) fails.
TEST(Mutations, LoadOrRefuse) {
  const TemporaryFolder folder;
  const Bytes seed = seed_scene();
  ASSERT_EQ(load_gltf(folder.write("seed.glb", seed)).triangle_count(), 3U);
  std::mt19937 rng(20240607);
  int loaded = 0;
  int refused = 0;
  for (int i = 0; i < 1500; ++i) {
    const auto file = folder.write("mutant.glb", mutate(seed, rng));
    try {
      const SceneData scene = load_gltf(file);
      ++loaded;
      ASSERT_EQ(test::broken_promise(scene), "") << i;
      for (const auto& texture : scene.textures) {
        texture->decode();
        texture->lookup({0.3F, 0.7F});
      }
    } catch (const SceneError&) {
      ++refused;
    } catch (const std::exception& e) {
      FAIL() << "mutant " << i << ": " << e.what();
    }
  }
  // The mutations must reach both sides of the guard to mean anything.
  EXPECT_GT(loaded, 100);
  EXPECT_GT(refused, 100);
}

}  // namespace
}  // namespace lacuna
