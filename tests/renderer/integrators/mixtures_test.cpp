// Mixtures of LACUNA_materials, as Mitsuba's mixturebsdf and blendbsdf become: the same picture by
// methods that meet them in different ways, and direct light that is linear in the weights.

#include <gtest/gtest.h>

#include "tests/renderer/integrators/methods.h"
#include "tests/renderer/integrators/same_picture.h"
#include "tests/renderer/scene/scene_parts.h"

namespace lacuna {
namespace {

using test::Method;
using test::Rendering;
using test::SceneParts;

using Weighted = std::pair<Material, Rgb>;

Material exact(LacunaMaterial lacuna, const Rgb& base = Rgb(1, 1, 1)) {
  Material m = test::diffuse(base);
  m.lacuna = std::move(lacuna);
  return m;
}
LacunaMaterial lobes_of(LacunaMaterial::Type type, float alpha) {
  LacunaMaterial l;
  l.type = type;
  l.alpha = {alpha, alpha};
  return l;
}
Material mixed(const std::vector<Weighted>& parts) {
  LacunaMaterial l = lobes_of(LacunaMaterial::Type::mixture, 0);
  for (const auto& [part, weight] : parts) {
    l.parts.push_back({std::make_shared<const Material>(part), weight});
  }
  return exact(std::move(l));
}
Material blended(const Material& first, const Material& second, float weight) {
  return mixed({{first, Rgb(1 - weight)}, {second, Rgb(weight)}});
}
Material conductor(float alpha) {
  LacunaMaterial l = lobes_of(LacunaMaterial::Type::conductor, alpha);
  l.eta = Rgb(0.2F, 0.9F, 1.1F);
  l.k = Rgb(3.9F, 2.5F, 2.1F);
  return exact(std::move(l));
}
Material glossy() {
  LacunaMaterial l = lobes_of(LacunaMaterial::Type::glossy, 0.3F);
  l.shape = FacetShape::phong;
  l.reflectance = Rgb(0.3F);
  return exact(std::move(l), Rgb(0.2F, 0.4F, 0.6F));
}
Material leaf() {
  Material m = test::diffuse(Rgb(0, 0, 0));
  m.extensions.diffuse_transmission.factor = 1;
  m.extensions.diffuse_transmission.color = Rgb(0.8F, 0.9F, 0.3F);
  return m;
}
Material coated(const Material& base) {
  LacunaMaterial l = lobes_of(LacunaMaterial::Type::coating, 0.4F);
  l.parts.push_back({std::make_shared<const Material>(base), Rgb(1)});
  return exact(std::move(l));
}

const Rgb orange(0.8F, 0.5F, 0.3F);

/// Weights that differ by colour and leave a share that absorbs; a mixture within a mixture.
std::vector<Weighted> three_parts() {
  return {{test::diffuse(orange), Rgb(0.5F, 0.3F, 0.1F)},
          {blended(glossy(), conductor(0.4F), 0.6F), Rgb(0.3F)},
          {leaf(), Rgb(0.1F, 0.2F, 0.4F)}};
}

/// Nothing is smooth, so that every method sees all.
SceneData room_of_mixtures() {
  SceneParts p;
  p.box({0, 0, 0}, {3, 2, 4}, false,
        p.material(blended(test::diffuse(orange), conductor(0.5F), 0.25F)));
  p.box({0.4F, 0.1F, 0.8F}, {1.2F, 1.1F, 1.8F}, true,
        p.material(coated(blended(glossy(), conductor(0.4F), 0.5F))));
  p.quad({1.7F, 0.2F, 1}, {0.7F, 0, 0.3F}, {0, 1, 0}, p.material(mixed(three_parts())));
  p.quad({1, 1.9F, 1}, {1, 0, 0}, {0, 0, 1}, p.material(test::lamp(Rgb(3, 4, 5))));
  p.eye({1.5, 0.9, 3.8}, {1.4, 0.7, 0}, 1.1);
  return std::move(p.data);
}

TEST(Mixtures, AreTheSameByAllMethods) {
  constexpr int max_depth = 6, iterations = 120;
  const auto settings = [](const IntegratorSettings& integrator, int n) {
    return test::RenderSettings{
        .integrator = integrator, .width = 16, .height = 10, .iterations = n};
  };
  test::RenderSettings reference = settings(test::path_tracing(max_depth), 6 * iterations);
  reference.seed = 2;
  const Rendering expected = test::render(room_of_mixtures(), reference);
  std::vector<Method> methods{{"light", test::light_tracing(max_depth)},
                              {"bdpt", test::joining(max_depth, PairedSettings{})}};
  for (const Method& m : test::merging(max_depth)) {
    if (m.name == "vcm") methods.push_back(m);
  }
  ASSERT_EQ(methods.size(), 3U);
  for (const Method& method : methods) {
    SCOPED_TRACE(method);
    test::expect_same_picture(
        test::render(room_of_mixtures(), settings(method.settings, iterations)), expected, 0.03);
  }
}

/// A wall of one material before a lamp, lit and seen from both sides of the wall's normal.
Rendering direct_light_on(const Material& wall, std::uint64_t seed, int iterations) {
  SceneParts p;
  p.quad({-2, -2, 0}, {4, 0, 0}, {0, 4, 0}, p.material(wall));
  p.quad({-1, 2, 1}, {2, 0, 0}, {0, 0, 2}, p.material(test::lamp(Rgb(3, 4, 5), true)));
  p.quad({-1, -2, -3}, {2, 0, 0}, {0, 0, 2}, p.material(test::lamp(Rgb(5, 4, 3), true)));
  p.eye({0, 0, 3}, {0, 0, 0}, 1);
  return test::render(std::move(p.data), {.integrator = test::path_tracing(2),
                                          .width = 8,
                                          .height = 8,
                                          .iterations = iterations,
                                          .seed = seed});
}

/// The direct light of a mixture is the weighted sum of that of its parts.
TEST(Mixtures, AreLinearInTheirWeights) {
  constexpr int iterations = 2000;
  const Rendering found = direct_light_on(mixed(three_parts()), 1, iterations);
  std::vector<Rendering> parts;
  std::vector<Rgb> weights;
  std::uint64_t seed = 2;
  for (const auto& [material, weight] : three_parts()) {
    parts.push_back(direct_light_on(material, seed++, iterations));
    weights.push_back(weight);
  }
  const double level = statistics::sidak(1e-5, test::all_tests);
  for (std::size_t i = 0; i < found.blocks[0].size(); ++i) {
    statistics::Moments sum;
    for (std::size_t n = 0; n < found.blocks.size(); ++n) {
      double value = 0;
      for (std::size_t k = 0; k < parts.size(); ++k) {
        value += double(weights[k][static_cast<int>(i % 3)]) * parts[k].blocks[n][i];
      }
      sum.add(value);
    }
    const statistics::Moments mixture = test::over_iterations(found, i);
    EXPECT_GT(test::same_p(mixture, sum), level)
        << "block " << i / 3 << ", channel " << i % 3 << ": " << mixture.mean() << ", not "
        << sum.mean();
    EXPECT_LT(std::hypot(mixture.standard_error(), sum.standard_error()), 0.05 * sum.mean())
        << "the test has no power";
  }
}

}  // namespace
}  // namespace lacuna
