// Glowing particles: where they are, how bright, and that they depend on their seed alone.

#include "renderer/scene/particles.h"

#include <gtest/gtest.h>

#include <set>

#include "renderer/core/sampling.h"
#include "tests/renderer/scene/scene_parts.h"

namespace lacuna {
namespace {

SceneData room() {
  test::SceneParts parts;
  parts.box({-1, -2, -3}, {1, 2, 5}, false, parts.material(test::diffuse(Rgb(0.5F))));
  SceneData data = std::move(parts.data);
  data.lights.emplace_back();
  return data;
}

TEST(Particles, LieEvenlyInTheirPartOfTheBox) {
  SceneData data = room();
  constexpr int n = 8000;
  add_particles(
      data,
      {.count = n, .power = 40, .color = {1, 0.5, 0}, .low = {0, 0.5, 0.25}, .high = {1, 1, 0.75}});
  ASSERT_EQ(data.lights.size(), n + 1U);
  V3d sum(0.0);
  std::array<int, 8> octants{};
  for (std::size_t i = 1; i < data.lights.size(); ++i) {
    const PunctualLight& l = data.lights[i];
    EXPECT_EQ(l.kind, PunctualLight::Kind::point);
    const V3f& x = l.position;
    EXPECT_TRUE(x.x >= -1 && x.x <= 1 && x.y >= 0 && x.y <= 2 && x.z >= -1 && x.z <= 3) << x;
    ++octants[static_cast<std::size_t>((x.x > 0) + 2 * (x.y > 1) + 4 * (x.z > 1))];
    sum += V3d(l.intensity);
  }
  double chi2 = 0;  // of seven degrees of freedom; 1e-6 above 40
  for (const int k : octants) chi2 += std::pow(k - n / 8.0, 2) / (n / 8.0);
  EXPECT_LT(chi2, 40);
  // 40 W in all directions.
  EXPECT_NEAR(sum.x * 4 * double(pi), 40, 1e-3);
  EXPECT_NEAR(sum.y * 4 * double(pi), 20, 1e-3);
  EXPECT_EQ(sum.z, 0);
}

TEST(Particles, DependOnTheirSeed) {
  const auto places = [](int seed) {
    SceneData data = room();
    add_particles(data, {.count = 50, .power = 1, .seed = seed, .alone = true});
    EXPECT_EQ(data.lights.size(), 50U);
    std::set<float> x;
    for (const PunctualLight& l : data.lights) x.insert(l.position.x);
    return x;
  };
  EXPECT_EQ(places(1), places(1));
  EXPECT_NE(places(1), places(2));
  EXPECT_EQ(places(1).size(), 50U);
}

TEST(Particles, OfASceneWithoutSurfacesLieInItsMiddle) {
  SceneData data;
  add_particles(data, {.count = 2, .power = 1});
  ASSERT_EQ(data.lights.size(), 2U);
  EXPECT_EQ(data.lights[1].position, V3f(0.0F));
}

}  // namespace
}  // namespace lacuna
