// LACUNA_materials: what is read of it, what is refused, and the choice between parts.

#include <gtest/gtest.h>

#include "renderer/scene/scene.h"
#include "tests/renderer/gltf/glb_builder.h"
#include "tests/renderer/images/test_images.h"

namespace lacuna {
namespace {

using test::GlbBuilder;
using test::load;

Json with_lacuna(const Json& extension) {
  return {{"extensions", {{"LACUNA_materials", extension}}}};
}

/// A unit quad of the first of `materials`, which faces +z.
GlbBuilder lacuna_quad(const std::vector<Json>& materials) {
  GlbBuilder b;
  b.add_texture(test::encode8(2, 1, 3, {0, 0, 0, 255, 255, 255}),
                {{"wrapS", 33071}, {"wrapT", 33071}});
  for (const Json& m : materials) b.add_material(m);
  b.add_node({{"mesh", b.add_quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0)}});
  return b;
}

std::string lacuna_error(const std::vector<Json>& materials) {
  try {
    load(lacuna_quad(materials));
  } catch (const SceneError& e) {
    return e.what();
  }
  return "";
}

/// The BSDF at a point of lacuna_quad().
std::optional<Bsdf> bsdf_at(const Scene& scene, float x, float y) {
  Hit hit;
  const Ray ray{{x, y, 1}, {0, 0, -1}};
  EXPECT_TRUE(scene.rays().intersect(ray, hit));
  std::optional<Bsdf> bsdf;
  scene.make_bsdf(scene.surface(ray, hit), bsdf);
  return bsdf;
}

Scene lacuna_scene(const std::vector<Json>& materials) {
  const ThreadPool pool(1);
  return {load(lacuna_quad(materials)), {.materials = true}, std::nullopt, pool};
}

TEST(LacunaMaterials, EveryMemberArrives) {
  const auto scene = load(lacuna_quad({with_lacuna({{"type", "conductor"},
                                                    {"distribution", "beckmann"},
                                                    {"alpha", {0.1, 0.4}},
                                                    {"alphaTexture", {{"index", 0}}},
                                                    {"eta", {1, 2, 3}},
                                                    {"k", {4, 5, 6}},
                                                    {"reflectance", {0.25, 0.5, 1}},
                                                    {"oneSided", true},
                                                    {"bump", {{"index", 0}, {"scale", 2}}}})}));
  const LacunaMaterial& m = scene.materials.at(0).lacuna.value();
  EXPECT_EQ(m.type, LacunaMaterial::Type::conductor);
  EXPECT_EQ(m.shape, FacetShape::beckmann);
  EXPECT_EQ(m.alpha, V2f(0.1F, 0.4F));
  EXPECT_TRUE(m.alpha_texture.used());
  EXPECT_EQ(m.eta, Rgb(1, 2, 3));
  EXPECT_EQ(m.k, Rgb(4, 5, 6));
  EXPECT_EQ(m.reflectance, Rgb(0.25F, 0.5F, 1));
  EXPECT_TRUE(m.one_sided);
  EXPECT_TRUE(m.bump.used());
  EXPECT_EQ(m.bump_scale, 2);
  EXPECT_TRUE(scene.warnings.empty());
}

TEST(LacunaMaterials, MaskingIsSeparableOrCorrelated) {
  const auto shape = [](const Json& masking) {
    Json glass{{"type", "dielectric"}, {"ior", 1.5}, {"alpha", 0.5}};
    glass.update(masking);
    return load(lacuna_quad({with_lacuna(glass)})).materials.at(0).lacuna->shape;
  };
  EXPECT_EQ(shape(Json::object()), FacetShape::ggx_separable);
  EXPECT_EQ(shape({{"masking", "separable"}}), FacetShape::ggx_separable);
  EXPECT_EQ(shape({{"masking", "correlated"}}), FacetShape::ggx);
}

TEST(LacunaMaterials, RefusesWhatIsNotAllowed) {
  const std::vector<std::pair<Json, std::string>> refusals{
      {{{"type", "plastik"}}, "found string \"plastik\"; allowed: \"diffuse\""},
      {{{"type", "phong"}, {"ior", 1.5}}, "unknown member \"ior\""},
      {{{"type", "conductor"}, {"eta", {1, 1, 1}}}, "k is missing"},
      {{{"type", "dielectric"}, {"ior", 0}}, "allowed: a number from 0.001 to 1000"},
      {{{"type", "plastic"}, {"ior", 1.5}, {"alpha", {0.1, 0.2, 0.3}}}, "a number, or two"},
      {{{"type", "plastic"}, {"ior", 1.5}, {"alpha", 1.5}}, "found number 1.5"},
      {{{"type", "ward"}, {"variant", "blinn"}}, "\"balanced\""},
      {{{"type", "plastic"}, {"ior", 1.5}, {"masking", "none"}}, "\"correlated\""},
      {{{"type", "plastic"}, {"ior", 1.5}, {"masking", "correlated"}, {"distribution", "beckmann"}},
       "\"separable\", with Beckmann's facets"},
      {{{"type", "coating"}, {"ior", 1.5}, {"base", 7}}, "materials"},
      {{{"type", "coating"}, {"ior", 1.5}, {"base", 1}}, "transmits no light"},
      {{{"type", "mixture"}, {"parts", {{{"material", 1}, {"weight", 1}}}}}, "two or more"},
      {{{"type", "mixture"}, {"parts", {{{"material", 1}}, {{"material", 1}}}}},
       "weight is missing"},
      {{{"type", "mixture"},
        {"parts", {{{"material", 1}, {"weight", 0.7}}, {{"material", 1}, {"weight", 0.7}}}}},
       "have the sum 1.4"},
      {{{"type", "mixture"},
        {"parts", {{{"material", 1}, {"weight", 0.5}}, {{"material", 0}, {"weight", 0.5}}}}},
       "a part of itself"},
      {{{"type", "coating"}, {"ior", 1.5}, {"base", 0}}, "a part of itself"},
  };
  const Json glass = with_lacuna({{"type", "dielectric"}, {"ior", 1.5}});
  for (const auto& [extension, expected] : refusals) {
    const std::string error = lacuna_error({with_lacuna(extension), glass});
    EXPECT_NE(error.find(expected), std::string::npos) << extension << "\n" << error;
    EXPECT_NE(error.find("materials[0]"), std::string::npos) << error;
  }
}

TEST(LacunaMaterials, PartsOfPartsEnd) {
  // Of each material the next two: 2^n leaves, n deep.
  const auto chain = [](int n, int width) {
    std::vector<Json> all;
    for (int i = 0; i < n; ++i) {
      Json parts = Json::array();
      for (int k = 0; k < width; ++k) parts.push_back({{"material", i + 1}, {"weight", 0.1}});
      all.push_back(with_lacuna({{"type", "mixture"}, {"parts", parts}}));
    }
    all.push_back(Json::object());
    return all;
  };
  EXPECT_EQ(lacuna_error(chain(7, 2)), "");
  EXPECT_NE(lacuna_error(chain(9, 2)).find("parts"), std::string::npos);
  EXPECT_NE(lacuna_error(chain(4, 8)).find("more than 256"), std::string::npos);
  EXPECT_NE(lacuna_error(chain(1000, 2)).find("depth of more than 8"), std::string::npos);
}

Json lambert_of(double r, double g, double b) {
  return {{"pbrMetallicRoughness", {{"baseColorFactor", {r, g, b, 1}}}},
          {"extensions", {{"LACUNA_materials", {{"type", "diffuse"}}}}}};
}

/// The mean over points is the weighted sum of the parts, each point has the same part again, and
/// what the weights leave is black.
TEST(LacunaMaterials, MixturesChooseByTheirWeights) {
  const Scene scene = lacuna_scene({with_lacuna({{"type", "mixture"},
                                                 {"parts",
                                                  {{{"material", 1}, {"weight", {0.5, 0.25, 0.5}}},
                                                   {{"material", 2}, {"weight", 0.3}}}}}),
                                    lambert_of(1, 1, 0), lambert_of(0, 0, 1)});
  constexpr int n = 150;
  V3d sum(0, 0, 0);
  int black = 0;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const float x = (static_cast<float>(i) + 0.4F) / n, y = (static_cast<float>(j) + 0.3F) / n;
      const Rgb albedo = bsdf_at(scene, x, y)->albedo();
      ASSERT_EQ(albedo, bsdf_at(scene, x, y)->albedo());
      sum += V3d(albedo);
      black += is_black(albedo) ? 1 : 0;
    }
  }
  const V3d mean = sum / (n * n);
  const double error = 4 * 0.5 / n;  // of a share, at most
  EXPECT_NEAR(mean.x, 0.5, error);
  EXPECT_NEAR(mean.y, 0.25, error);
  EXPECT_NEAR(mean.z, 0.3, error);
  EXPECT_NEAR(static_cast<double>(black) / (n * n), 0.2, error);
}

/// At the left of the texture only the first, at the right only the second.
TEST(LacunaMaterials, AWeightTextureBlendsTwoParts) {
  const Scene scene =
      lacuna_scene({with_lacuna({{"type", "mixture"},
                                 {"weightTexture", {{"index", 0}}},
                                 {"parts", {{{"material", 1}}, {{"material", 2}}}}}),
                    lambert_of(1, 0, 0), lambert_of(0, 1, 0)});
  int right = 0;
  constexpr int n = 200;
  for (int i = 0; i < n; ++i) {
    const float y = (static_cast<float>(i) + 0.5F) / n;
    EXPECT_EQ(bsdf_at(scene, 0.1F, y)->albedo(), Rgb(1, 0, 0));
    EXPECT_EQ(bsdf_at(scene, 0.9F, y)->albedo(), Rgb(0, 1, 0));
    right += bsdf_at(scene, 0.5F, y)->albedo().y > 0 ? 1 : 0;
  }
  EXPECT_NEAR(right, n / 2, 4 * std::sqrt(n) / 2);
}

/// The height rises by the scale over half of the texture, between the centres of its two texels:
/// its slope is 2 there, and 0 beside.
TEST(LacunaMaterials, BumpsTurnTheShadingNormal) {
  const Scene scene =
      lacuna_scene({with_lacuna({{"type", "diffuse"}, {"bump", {{"index", 0}, {"scale", 1}}}})});
  const auto normal = [&](float x) {
    Hit hit;
    const Ray ray{{x, 0.5F, 1}, {0, 0, -1}};
    EXPECT_TRUE(scene.rays().intersect(ray, hit));
    return scene.surface(ray, hit).ns;
  };
  const V3f slope = V3f(-2, 0, 1).normalized();
  EXPECT_LT((normal(0.5F) - slope).length(), 1e-4F);
  EXPECT_LT((normal(0.01F) - V3f(0, 0, 1)).length(), 0.1F);
}

}  // namespace
}  // namespace lacuna
