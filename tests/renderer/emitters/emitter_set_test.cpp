#include "renderer/emitters/emitter_set.h"
#include "renderer/gltf/gltf_load.h"

#include <gtest/gtest.h>

#include <numbers>

#include "renderer/scene/scene.h"
#include "tests/renderer/images/test_images.h"
#include "tests/renderer/scene/scene_parts.h"
#include "tests/statistics.h"

namespace lacuna {
namespace {

using test::SceneParts;

Scene load(const char* name) {
  const ThreadPool pool(1);
  return {load_gltf(std::filesystem::path(LACUNA_SOURCE_DIR) / "jobs/scenes" / name),
          {.materials = false, .emission = true},
          std::nullopt,
          pool};
}

EmitterPoint draw(const Scene& scene, Rng& rng) {
  return scene.emitters().sample(scene.emitters().choose(rng));
}

// E 1/pdf over draws is the measure of all that can be drawn: the emitters' area. It fails if a
// density is not the one that draws are made with.
TEST(EmitterSet, DensityBelongsToItsDraws) {
  const Scene scene = load("sides.glb");
  double area = 0;
  for (std::uint32_t m = 0; m < scene.data().meshes.size(); ++m) {
    const Mesh& mesh = scene.data().meshes[m];
    if (!scene.data().materials[mesh.material].emits()) continue;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      area += double(TriangleShape(mesh, t).area());
    }
  }
  Rng rng(1, 0, 0, Rng::Purpose::test);
  statistics::Moments inverse;
  for (int i = 0; i < 200000; ++i) {
    inverse.add(1 / double(draw(scene, rng).pdf.value));
  }
  EXPECT_GT(statistics::z_test(inverse, area), 1e-5);
}

// Within a mesh by power; an eighth of all selections is uniform over meshes and lights.
TEST(EmitterSet, ChoosesByPower) {
  const Scene scene = load("many_lights.glb");
  const SceneData& data = scene.data();
  struct Sum {
    double power = 0, probability = 0;
  };
  std::vector<Sum> meshes;
  double all = 0;
  for (std::uint32_t m = 0; m < data.meshes.size(); ++m) {
    const Material& material = data.materials[data.meshes[m].material];
    if (!material.emits()) continue;
    Sum& sum = meshes.emplace_back();
    double lowest = std::numeric_limits<double>::infinity(), highest = 0;
    for (std::uint32_t t = 0; t < data.meshes[m].triangles.size(); ++t) {
      const double area = TriangleShape(data.meshes[m], t).area();
      const double power = std::numbers::pi * double(luminance(material.emission)) * area *
                           (material.double_sided ? 2 : 1);
      const double p = double(scene.emitters().pdf(m, t).value) * area;
      lowest = std::min(lowest, p / power);
      highest = std::max(highest, p / power);
      sum.power += power;
      sum.probability += p;
    }
    EXPECT_NEAR(highest / lowest, 1, 1e-4);
    all += sum.power;
  }
  for (const PunctualLight& l : data.lights) {
    all += double(luminance(l.intensity)) * (l.kind == PunctualLight::Kind::spot
                                                 ? SpotCones::power(l.inner_cone, l.outer_cone)
                                                 : 4 * std::numbers::pi);
  }
  const auto sources = static_cast<double>(meshes.size() + data.lights.size());
  ASSERT_GT(sources, 20);
  for (const Sum& sum : meshes) {
    EXPECT_NEAR(sum.probability / (0.875 * sum.power / all + 0.125 / sources), 1, 1e-4);
  }
}

/// Meshes of `triangles` each that share one texture of emission, of which one texel is lit. The
/// texture coordinates of the first mesh's first triangle lie on it, those of all others far away.
SceneData with_texture(std::size_t meshes, std::size_t triangles) {
  SceneParts p;
  constexpr int side = 128;
  std::vector<std::uint8_t> texels(side * side, 0);
  texels[side * 40 + 30] = 255;
  p.data.textures.push_back(std::make_unique<Texture>(
      "glow", test::encode8(side, side, 1, texels), Texture::Encoding::srgb, Texture::Wrap::repeat,
      Texture::Wrap::repeat));
  Material glow = test::lamp(Rgb(1, 2, 3));
  glow.emission_texture.texture = 0;
  const auto material = p.material(glow);
  for (std::size_t m = 0; m < meshes; ++m) {
    Mesh mesh;
    mesh.material = material;
    for (std::uint32_t t = 0; t < triangles; ++t) {
      const V3f o(static_cast<float>(t), static_cast<float>(m), 0);
      const V2f uv = (m + t == 0 ? V2f(29.9F, 39.9F) : V2f(90, 80)) / side;
      for (const V2f& corner : {V2f(0, 0), V2f(1, 0), V2f(0, 1)}) {
        mesh.positions.push_back(o + V3f(corner.x, corner.y, 0));
        mesh.uvs[0].push_back(uv + corner / side);
      }
      mesh.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
    }
    p.data.meshes.push_back(std::move(mesh));
  }
  return std::move(p.data);
}

TEST(EmitterSet, TexturesThatEmitAreReadOnce) {
  const Scene scene = test::lit_scene(with_texture(20, 100));
  const EmitterSet& emitters = scene.emitters();
  // The whole texture once, and a few texels for each triangle.
  EXPECT_LE(emitters.texels_read(), 128U * 128 + 2000 * 64);
  for (std::uint32_t m = 0; m < 20; ++m) {
    for (std::uint32_t t = 0; t < 100; ++t) {
      EXPECT_EQ(emitters.pdf(m, t).positive(), m + t == 0) << m << ", " << t;
    }
  }
  EXPECT_NEAR(emitters.pdf(0, 0).value, 2, 1e-5F);  // always the one of area 1/2
}

TEST(EmitterSet, BackOfASingleSidedEmitterIsDark) {
  const Scene scene = load("area.glb");  // faces down at height 2
  Rng rng(1, 0, 0, Rng::Purpose::test);
  for (int i = 0; i < 100; ++i) {
    const EmitterPoint e = draw(scene, rng);
    EXPECT_FALSE(is_black(e.towards((V3f(0.3F, 0, 0.2F) - e.x).normalized())));
    EXPECT_TRUE(is_black(e.towards((V3f(0.3F, 3, 0.2F) - e.x).normalized())));
  }
}

TEST(EmitterSet, NoLightAtAll) { EXPECT_TRUE(load("open.glb").emitters().empty()); }

/// A sky with one bright texel, dark ones, and a gradient.
Environment sky(float rotation) {
  constexpr int w = 16;
  constexpr int h = 8;
  std::vector<float> rgb(3 * w * h);
  for (int y = 0; y < h; ++y) {
    for (int x = 0; x < w; ++x) {
      const float v = y > 5 ? 0.0F : 0.1F + 0.05F * static_cast<float>(x);
      for (int c = 0; c < 3; ++c) rgb[static_cast<std::size_t>(3 * (y * w + x) + c)] = v;
    }
  }
  for (std::size_t c = 0; c < 3; ++c) rgb[3 * (2 * w + 5) + c] = 100;
  return {w, h, std::move(rgb), 2, rotation};
}

V3f direction(double cos_theta, double phi) {
  const double sin_theta = std::sqrt(1 - cos_theta * cos_theta);
  return V3f(V3d(sin_theta * std::cos(phi), cos_theta, sin_theta * std::sin(phi)));
}

TEST(Environment, DensityIsThatOfItsDraws) {
  for (const float rotation : {0.0F, 1.1F}) {
    const Environment e = sky(rotation);
    constexpr int across = 24;
    constexpr int down = 16;
    constexpr int draws = 400000;
    std::vector<double> observed(across * down), expected(across * down);
    Rng rng(2, 0, 0, Rng::Purpose::test);
    const auto cell = [&](const V3f& w) {
      const double phi = std::atan2(double(w.z), double(w.x)) / (2 * std::numbers::pi) + 0.5;
      const int i = std::min(static_cast<int>(phi * across), across - 1);
      const int j = std::min(static_cast<int>((double(w.y) + 1) / 2 * down), down - 1);
      return static_cast<std::size_t>(j * across + i);
    };
    for (int k = 0; k < draws; ++k) {
      const Environment::Sample s = e.sample(rng.next_fine_point());
      ASSERT_NEAR(s.pdf / e.pdf(s.w), 1, 0.02) << "at a texel's border the two may round apart";
      observed[cell(s.w)] += 1;
    }
    constexpr int sub = 48;
    for (int j = 0; j < down * sub; ++j) {
      for (int i = 0; i < across * sub; ++i) {
        const double cos_theta = -1 + 2 * (j + 0.5) / (down * sub);
        const double phi = 2 * std::numbers::pi * ((i + 0.5) / (across * sub) - 0.5);
        const V3f w = direction(cos_theta, phi);
        expected[cell(w)] +=
            draws * double(e.pdf(w)) * 4 * std::numbers::pi / (across * down * sub * sub);
      }
    }
    // The grid's quadrature is not exact where texels end inside a cell: compare within its error
    // too.
    double chi2 = 0;
    int cells = 0;
    for (std::size_t k = 0; k < observed.size(); ++k) {
      if (expected[k] < 10) continue;
      const double d = observed[k] - expected[k];
      chi2 += d * d / (expected[k] + 0.0004 * expected[k] * expected[k]);
      ++cells;
    }
    EXPECT_GT(cells, 100);
    EXPECT_GT(chi_square_beyond(chi2, cells - 1), 1e-5) << "chi2 " << chi2 << " of " << cells;
  }
}

TEST(Environment, EveryDirectionThatShinesCanBeDrawn) {
  const Environment e = sky(0.3F);
  Rng rng(3, 0, 0, Rng::Purpose::test);
  for (int k = 0; k < 20000; ++k) {
    const V3f w = direction(2 * double(rng.next()) - 1, 6.283 * double(rng.next()));
    if (luminance(e.radiance(w)) > 0) {
      EXPECT_GT(e.pdf(w), 0);
    }
  }
}

TEST(Environment, CentreLiesAlongMinusZAndTurnsCounterClockwise) {
  constexpr int w = 8;
  std::vector<float> rgb(3 * w * 4, 0.0F);
  for (int y = 0; y < 4; ++y) {
    for (const int x : {3, 4}) rgb[static_cast<std::size_t>(3 * (y * w + x))] = 1;
  }
  const Environment straight(w, 4, rgb, 1, 0);
  EXPECT_EQ(straight.radiance(V3f(0, 0, -1)).x, 1);
  EXPECT_EQ(straight.radiance(V3f(1, 0, 0)).x, 0);
  // A quarter turn counter-clockwise seen from above (+y) takes -z to -x.
  const Environment turned(w, 4, rgb, 1, std::numbers::pi_v<float> / 2);
  EXPECT_NEAR(turned.radiance(V3f(-1, 0, 0)).x, 1, 1e-5);
  EXPECT_NEAR(turned.radiance(V3f(0, 0, -1)).x, 0, 1e-5);
}

}  // namespace
}  // namespace lacuna
